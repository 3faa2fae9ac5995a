#pragma once

#include "raytruth/render/camera.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/ray_displacement.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace raytruth {

/// How far the rays of CameraView, which are rounded to binary64, are from those that the camera's numbers mean: by the
/// same formulas in ball arithmetic of 128 bits. Both are followed from where they enter a grid; a ray's length unit is
/// taken for that of the rounded one, so that what it is off by is a displacement too. Zero where nothing was rounded,
/// as along an axis through the middle of an image.
class CameraRounding {
 public:
  /// Takes a camera and spacing that CameraView does not refuse, the size of the grid, and where it ends.
  CameraRounding(const Camera& camera, const std::array<double, 3>& spacing, const std::array<std::int64_t, 3>& size,
                 Border border = Border::half_voxel);
  ~CameraRounding();
  CameraRounding(const CameraRounding&) = delete;
  CameraRounding& operator=(const CameraRounding&) = delete;
  CameraRounding(CameraRounding&&) = delete;
  CameraRounding& operator=(CameraRounding&&) = delete;

  /// `rounded` is what CameraView makes of this pixel.
  [[nodiscard]] RayDisplacement operator()(std::int64_t column, std::int64_t row, const PixelRay& rounded) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace raytruth
