#pragma once

#include <array>
#include <string_view>

namespace raytruth {

/// How voxels become a field (signals/trilinear.hpp, signals/tricubic.hpp).
enum class FieldKind { trilinear, bspline, bspline_prefiltered, catmull_rom };

inline constexpr std::array<std::string_view, 4> field_kind_names{"trilinear", "bspline", "bspline_prefiltered",
                                                                  "catmull_rom"};

}  // namespace raytruth
