#pragma once

#include "raytruth/volume/grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace raytruth {

/// Where a volume ends, which is a convention. Programs that draw boxes of voxels end it half a voxel beyond the
/// centres of its outermost voxels, where values are clamped (GL_CLAMP_TO_EDGE): an axis of n voxels is n long. Others,
/// such as VTK's mappers and Teem, end it at these centres: it is n - 1 long, and nothing is clamped.
enum class Border { half_voxel, voxel_centres };

inline constexpr std::array<std::string_view, 2> border_names{"half_voxel", "voxel_centres"};

constexpr std::string_view name_of(Border border) { return border_names[static_cast<std::size_t>(border)]; }

/// How far beyond the centres of its outermost voxels a volume ends, in voxels.
constexpr double margin_of(Border border) { return border == Border::half_voxel ? 0.5 : 0; }

/// Whether it ends where it begins along an axis, so that only rays across this axis are inside of it.
inline bool has_no_extent(const Grid& grid, Border border) {
  return border == Border::voxel_centres && std::find(grid.size.begin(), grid.size.end(), 1) != grid.size.end();
}

/// What to tell a user of such a volume.
inline constexpr std::string_view why_no_extent =
    "an axis of one voxel has no extent with the border voxel_centres; with half_voxel it is one voxel long";

}  // namespace raytruth
