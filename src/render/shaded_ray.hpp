#pragma once

#include "core/vector3.hpp"
#include "reference/certified.hpp"
#include "schemes/omissions.hpp"
#include "schemes/samples.hpp"
#include "shading/lighting.hpp"
#include "shading/slab_shading.hpp"
#include "transfer/clear_scalars.hpp"
#include "transfer/piecewise_linear.hpp"
#include "volume/camera.hpp"
#include "volume/grid.hpp"

#include <Eigen/Core>

#include <array>

namespace raytruth {

/// How a scene is lit.
struct SceneShading {
  const Shading* method = nullptr;  ///< of catalogue::shadings(): the normals inside a slab from those at its ends
  Lighting lighting;  ///< `light` points to the light, in world coordinates; `half` is made for every pixel
  bool is_along_gradient = false;  ///< whether normals are +grad s / |grad s|, not -grad s / |grad s|
};

/// A ray of first-order slabs, lit: the scalar linear between samples, the normals at samples from the gradient there
/// (central differences at the voxels, trilinearly interpolated, per world length), and between them as the method has
/// it. A slab with a zero gradient at either end, or with antiparallel normals, has ambient light only.
class ShadedRay {
 public:
  /// What it is given must outlive it.
  ShadedRay(const Grid& grid, const PiecewiseLinear& transfer, Emission emission, const SceneShading& shading);

  /// Light in the first three numbers, opacity in the fourth; samples in smallest spacings behind the ray's entry.
  [[nodiscard]] Eigen::Array4d operator()(const PixelRay& pixel, const Samples<double>& samples,
                                          const Omissions& omissions) const;

 private:
  [[nodiscard]] Vector3<double> normal_at(const std::array<double, 3>& position) const;

  const Grid& grid_;
  const PiecewiseLinear& transfer_;
  Emission emission_;
  const SceneShading& shading_;
  ClearScalars clear_;
};

}  // namespace raytruth
