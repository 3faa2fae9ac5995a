#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/textures/texel_format.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace raytruth {

/// Where a scalar lies along an axis of a table, in units of entries: a texture unit's way through normalised
/// coordinates, texel i having its centre at (i + 1/2) / n (rules/table_look_up.glsl, rules/texture_filter.glsl).
template <class Real>
struct TablePlace {
  std::size_t first = 0;   ///< the entry before, or at it
  std::size_t second = 0;  ///< the next one, the same at the end
  Real weight = Real(0);   ///< of `second`

  /// Scalars beyond the ends are those of the ends. `weight_bits`: as TextureUnit's.
  static TablePlace of(const TableAxes& axes, const Real& scalar, int weight_bits) {
    Rules<Real> rules;
    const Real low(axes.low);
    const Real size(static_cast<double>(axes.size));
    const Real levels(weight_bits > 0 ? std::ldexp(1.0, weight_bits) : 0.0);
    const Real share = rules.min(rules.max((scalar - low) / (Real(axes.high) - low), Real(0)), Real(1));
    const Real position = rules.texel_position(rules.table_coordinate(share, size), size);
    const Real first = rules.floor(position);
    const auto index = [&](const Real& i) {
      return static_cast<std::size_t>(to_double(rules.texel_clamped_to_edge(i, size)));
    };
    return {index(first), index(first + Real(1)), rules.filter_weight(position, levels)};
  }

  /// The entry that is nearer; the second one half-way.
  [[nodiscard]] std::size_t nearest() const { return weight < Real(0.5) ? first : second; }
};

// Look-ups of a table whose entries texel(front, back) gives, so that it need not exist as a whole. Weights are
// multiples of 2^-weight_bits, as texture units have them; 0: as exact as Real.

/// The entry next to both scalars: an error of O(1 / n).
template <class Real, class Texel>
typename Rules<Real>::vec4 nearest(const TableAxes& axes, const Texel& texel, const std::array<Real, 2>& scalars) {
  return texel(TablePlace<Real>::of(axes, scalars[0], 0).nearest(),
               TablePlace<Real>::of(axes, scalars[1], 0).nearest());
}

/// Bilinear between the four entries around.
template <class Real, class Texel>
typename Rules<Real>::vec4 bilinear(const TableAxes& axes, const Texel& texel, const std::array<Real, 2>& scalars,
                                    int weight_bits = 0) {
  const auto front = TablePlace<Real>::of(axes, scalars[0], weight_bits);
  const auto back = TablePlace<Real>::of(axes, scalars[1], weight_bits);
  return Rules<Real>{}.table_bilinear(texel(front.first, back.first), texel(front.second, back.first),
                                      texel(front.first, back.second), texel(front.second, back.second), front.weight,
                                      back.weight);
}

/// The look-up of slabs of second order, texel(front, middle, back): trilinear between the eight entries around.
template <class Real, class Texel>
typename Rules<Real>::vec4 trilinear(const TableAxes& axes, const Texel& texel, const std::array<Real, 3>& scalars,
                                     int weight_bits = 0) {
  const auto back = TablePlace<Real>::of(axes, scalars[2], weight_bits);
  const auto slice = [&](std::size_t b) {
    return bilinear<Real>(
        axes, [&](std::size_t front, std::size_t middle) { return texel(front, middle, b); }, {scalars[0], scalars[1]},
        weight_bits);
  };
  return Rules<Real>{}.filter_linear(slice(back.first), slice(back.second), back.weight);
}

/// How a table's numbers are stored: as binary64, or as texels.
struct TableFormat {
  std::string_view name = "float64";
  bool is_texel = false;
  TexelType type = TexelType::float32;  ///< of texels
  std::size_t bytes = 8;                ///< of a number
};

/// All formats, from the most exact one to the smallest.
inline constexpr std::array table_formats{TableFormat{}, TableFormat{"float32", true, TexelType::float32, 4},
                                          TableFormat{"float16", true, TexelType::float16, 2},
                                          TableFormat{"unorm16", true, TexelType::unorm16, 2},
                                          TableFormat{"unorm8", true, TexelType::unorm8, 1}};

/// A number as this format keeps it: fixed-point ones clamp to [0, 1].
inline double stored(const TableFormat& format, double value) {
  return format.is_texel ? static_cast<double>(stored_texel(format.type, static_cast<float>(value))) : value;
}

/// A table as this format keeps it.
inline Table<double> stored(const TableFormat& format, Table<double> table) {
  for (double& value : table.values) value = stored(format, value);
  return table;
}

}  // namespace raytruth
