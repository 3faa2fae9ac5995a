#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/transfer/isoslab.hpp"

#include <string>
#include <vector>

namespace raytruth {

/// What schemes of isosurfaces need stated.
struct SurfaceNumbers {
  double tolerance = 0;  ///< of `threshold`, in scalars
  Isoslab isoslab = {};
};

/// Reads the members "surface_tolerance" and "isoslab" of a case or a scene, which stand there if one of these schemes
/// needs them, and only then. Throws InputError.
SurfaceNumbers read_surface_numbers(const JsonReader& json, const std::vector<std::string>& schemes);

}  // namespace raytruth
