#pragma once

#include "raytruth/volume/grid.hpp"

#include <cstdint>

namespace raytruth {

/// Noise on a periodic grid of size^3 voxels, in [0, 1], from a counter-based generator (Philox 4x32-10 of
/// J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, 2011): the same bytes for the same seed on any
/// number of threads.
///
/// smoothing = 0: white noise, uniform in [0, 1). smoothing > 0: white noise convolved on each axis with
/// exp(-k^2 / (2 smoothing^2)), |k| <= ceil(6 smoothing), weights summing to 1, then scaled to [0, 1] by its extremes;
/// `smoothing` is the standard deviation in voxels. Throws InputError unless 1 <= size <= 2048, 0 <= smoothing <= size.
Grid random_field(std::int64_t size, double smoothing, std::uint64_t seed);

}  // namespace raytruth
