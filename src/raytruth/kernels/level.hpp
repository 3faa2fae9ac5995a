#pragma once

#include <array>
#include <cstddef>

// The files of this folder that hold inner loops are compiled once for every level of x86-64, each in a namespace of
// its own, so that no function of a higher level is linked where a lower one is meant; kernels.hpp takes the best
// version that the processor has. Levels with fused products round less, so their last bits differ, within the radii.
#ifndef RAYTRUTH_LEVEL
#define RAYTRUTH_LEVEL baseline
#endif

namespace raytruth {

inline constexpr std::size_t lane_count = 8;

/// Eight numbers side by side, one for each lane, as they lie in memory.
using Eight = std::array<double, lane_count>;

}  // namespace raytruth
