#pragma once

#include "raytruth/documents/conformance/vectors.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace raytruth {

/// A vector as a renderer of voxels can be asked it: the ray's samples, in binary32, as a volume of 3 x 3 equal columns
/// of voxels along z, a voxel's spacing apart, the first one next to the eye.
struct VectorVolume {
  std::string nrrd;              ///< the file, of sizes 3 3 samples
  nlohmann::ordered_json scene;  ///< its document; every pixel sees the ray, which ends at the centres of voxels
  ConformanceVector asked;       ///< what every pixel shows: lengths in voxels, linear between the samples
};

/// Its scene names the volume `id`.nrrd.
VectorVolume vector_volume(const ConformanceVector& vector, std::int64_t intervals);

}  // namespace raytruth
