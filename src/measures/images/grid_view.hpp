#pragma once

#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace raytruth {

/// A camera for grids of any size: lengths are in units of the grid's diagonal, places relative to its middle.
struct GridView {
  std::string kind;  ///< orthographic or perspective
  Camera camera;     ///< `eye` from the middle of the grid, `height` in diagonals
};

/// Reads "view" of experiments/schemas/experiment.json. Throws InputError.
GridView read_grid_view(const JsonReader& json, const std::array<std::int64_t, 2>& size);

/// Reads the width and height of a study's images.
std::array<std::int64_t, 2> read_image_size(const JsonReader& json);

/// The view of a grid.
Camera aimed(const GridView& view, const Grid& grid);

}  // namespace raytruth
