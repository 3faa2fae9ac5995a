#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/textures/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace raytruth {

/// What a texture unit does, computed in Real: reads a texture at normalised coordinates, clamped to its edge. The
/// arithmetic stands in rules/texture_filter.glsl.
template <class Real>
class TextureUnit {
 public:
  using vec4 = typename Rules<Real>::vec4;
  using Coordinate = std::array<Real, 3>;  ///< those of axes that the texture does not have are not read

  /// The weights of linear filtering are multiples of 2^-weight_bits; 0: as exact as Real. The texture must outlive the
  /// unit.
  explicit TextureUnit(const Texture& texture, int weight_bits = 0)
      : texture_(texture), levels_(weight_bits > 0 ? std::ldexp(1.0, weight_bits) : 0.0) {}

  [[nodiscard]] const Texture& texture() const { return texture_; }

  /// The texel whose centre is nearest (GL_NEAREST). Channels that the texture does not have are (0, 0, 1), here and
  /// below.
  [[nodiscard]] vec4 nearest(const Coordinate& coordinate) const {
    std::array<std::int64_t, 3> index{};
    for (std::size_t axis = 0; axis < texture_.dimensions; ++axis)
      index[axis] = clamped(Rules<Real>{}.floor(coordinate[axis] * size(axis)), axis);
    return texel(index);
  }

  /// The 2, 4 or 8 texels around, weighted (GL_LINEAR).
  [[nodiscard]] vec4 linear(const Coordinate& coordinate) const {
    std::array<std::array<std::int64_t, 2>, 3> index{};
    std::array<Real, 3> weight{};
    for (std::size_t axis = 0; axis < texture_.dimensions; ++axis) {
      const Real position = Rules<Real>{}.texel_position(coordinate[axis], size(axis));
      const Real first = Rules<Real>{}.floor(position);
      index[axis] = {clamped(first, axis), clamped(first + Real(1), axis)};
      weight[axis] = Rules<Real>{}.filter_weight(position, levels_);
    }
    switch (texture_.dimensions) {
      case 1:
        return filtered<1>(index, weight, {});
      case 2:
        return filtered<2>(index, weight, {});
      default:
        return filtered<3>(index, weight, {});
    }
  }

 private:
  [[nodiscard]] Real size(std::size_t axis) const { return Real(static_cast<double>(texture_.size[axis])); }

  [[nodiscard]] std::int64_t clamped(const Real& index, std::size_t axis) const {
    return static_cast<std::int64_t>(to_double(Rules<Real>{}.texel_clamped_to_edge(index, size(axis))));
  }

  /// The first `axes` axes filtered, with the texels `at` on the others.
  template <std::size_t axes>
  [[nodiscard]] vec4 filtered(const std::array<std::array<std::int64_t, 2>, 3>& index,
                              const std::array<Real, 3>& weight, std::array<std::int64_t, 3> at) const {
    if constexpr (axes == 0) {
      return texel(at);
    } else {
      constexpr std::size_t axis = axes - 1;
      at[axis] = index[axis][0];
      const vec4 first = filtered<axis>(index, weight, at);
      at[axis] = index[axis][1];
      return Rules<Real>{}.filter_linear(first, filtered<axis>(index, weight, at), weight[axis]);
    }
  }

  [[nodiscard]] vec4 texel(const std::array<std::int64_t, 3>& index) const {
    const auto& size = texture_.size;
    const float* const found =
        &texture_.texels[static_cast<std::size_t>((index[2] * size[1] + index[1]) * size[0] + index[0]) *
                         texture_.channels];
    vec4 result(Real(0), Real(0), Real(0), Real(1));
    for (std::size_t channel = 0; channel < texture_.channels; ++channel)
      result[static_cast<Eigen::Index>(channel)] = Real(static_cast<double>(found[channel]));
    return result;
  }

  const Texture& texture_;
  Real levels_;
};

}  // namespace raytruth
