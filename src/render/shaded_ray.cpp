#include "render/shaded_ray.hpp"

#include "rules/rules.hpp"
#include "shading/slab_optics.hpp"
#include "signals/cell_walk.hpp"
#include "volume/gradient.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace raytruth {

namespace {

const GradientFilter& central_differences() {
  const auto& filters = catalogue::gradient_filters();
  return *std::find_if(filters.begin(), filters.end(),
                       [](const GradientFilter& filter) { return filter.name == "central_difference"; });
}

/// The lighting as a pixel sees it.
Lighting lighting_of(const Lighting& scene, const Vector3<double>& towards_viewer) {
  Lighting lighting = scene;
  const Vector3<double> half = scene.light + towards_viewer;
  const double norm = half.matrix().norm();
  // Light from straight behind has no highlight.
  if (norm < 1e-6)
    lighting.specular = 0;
  else
    lighting.half = half / norm;
  return lighting;
}

}  // namespace

ShadedRay::ShadedRay(const Grid& grid, const PiecewiseLinear& transfer, Emission emission, const SceneShading& shading)
    : grid_(grid), transfer_(transfer), emission_(emission), shading_(shading), clear_(transfer, emission) {}

/// A unit vector, or zero.
Vector3<double> ShadedRay::normal_at(const std::array<double, 3>& position) const {
  static const GradientFilter& filter = central_differences();
  const Vector3<double> spacing(grid_.spacing[0], grid_.spacing[1], grid_.spacing[2]);
  const Vector3<double> gradient = gradient_at(grid_, filter, position).raw / spacing;
  const double norm = gradient.matrix().norm();
  if (norm == 0) return gradient;
  return (shading_.is_along_gradient ? 1 : -1) * gradient / norm;
}

Eigen::Array4d ShadedRay::operator()(const PixelRay& pixel, const Samples<double>& samples,
                                     const Omissions& omissions) const {
  const auto& [origin, direction, length] = pixel.ray;
  const Vector3<double> forward(direction[0] * grid_.spacing[0], direction[1] * grid_.spacing[1],
                                direction[2] * grid_.spacing[2]);
  const Lighting lit = lighting_of(shading_.lighting, -forward / forward.matrix().norm());
  Lighting ambient = lit;
  ambient.diffuse = ambient.specular = 0;
  const auto entry = static_cast<double>(clip(grid_.size, origin, direction).begin);
  const auto normal_of = [&](std::size_t sample) {
    const double t = entry + static_cast<double>(samples.positions[sample]) / pixel.length_unit;
    return normal_at({origin[0] + t * direction[0], origin[1] + t * direction[1], origin[2] + t * direction[2]});
  };

  Eigen::Array4d sum = Eigen::Array4d::Zero();
  for (std::size_t k = 0; k < samples.interval_count() && sum[3] < std::min(1.0, omissions.opaque); ++k) {
    const double front = samples.values[k];
    const double back = samples.values[k + 1];
    if (omissions.omit(static_cast<double>(samples.positions[k]), static_cast<double>(samples.positions[k + 1])) ||
        clear_.contain(std::min(front, back), std::max(front, back)))
      continue;
    ShadedSlab slab{.front = front,
                    .back = back,
                    .length = samples.length_of(k),
                    .front_normal = normal_of(k),
                    .back_normal = normal_of(k + 1)};
    const bool has_normals =
        !(slab.front_normal == 0).all() && !(slab.back_normal == 0).all() && slab.cosine() >= smallest_normal_cosine;
    if (!has_normals) slab.front_normal = slab.back_normal = {0, 0, 1};
    const Lighting& lighting = has_normals ? lit : ambient;
    const ShadedRadiance light = shade(*shading_.method, cosines_of(slab, lighting),
                                       SlabOptics(transfer_, front, back, slab.length), emission_, lighting);
    const Vector3<double> color = light.color();
    sum = Rules<double>{}.over(sum, {color[0], color[1], color[2], light.opacity});
  }
  return sum;
}

}  // namespace raytruth
