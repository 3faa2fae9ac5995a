#pragma once

#include <array>
#include <string_view>

namespace raytruth {

/// How voxels become a field (signals/trilinear.hpp, signals/tricubic.hpp).
enum class FieldKind { trilinear, bspline, bspline_prefiltered, catmull_rom };

inline constexpr std::array<std::string_view, 4> field_kind_names{"trilinear", "bspline", "bspline_prefiltered",
                                                                  "catmull_rom"};

/// How far a field leaves the range of its voxels, in units of that: the tensor product of Catmull-Rom cubics does.
constexpr double field_overshoot(FieldKind field) {
  return field == FieldKind::catmull_rom ? (1.25 * 1.25 * 1.25 - 1) / 2 : 0;
}

}  // namespace raytruth
