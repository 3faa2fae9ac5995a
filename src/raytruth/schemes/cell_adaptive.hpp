#pragma once

#include "raytruth/core/chain.hpp"

#include <cstdint>
#include <vector>

namespace raytruth {

/// How many samples each cell of a ray gets between its borders, 0, 1 or 2, if at most `budget` samples are to be
/// taken, borders included; only the lengths of the chords are used.
///
/// With u = 0 ... 1 along a chord l in a cell, a trilinear ray is a line, plus u (u - 1) l^2 sum_{i<j} d_i d_j V_ij,
/// plus u (u - 1/2) (u - 1) l^3 d_x d_y d_z V_xyz, d being the direction and V the mixed differences of the cell's
/// voxels. A line through its ends misses the middle term, an area l^3/6 |...|; a parabola through its midpoint the
/// last one, an area l^4/32 |...|; a cubic nothing. Where voxels are independent and of one variance, V_ij has 8/3 of
/// it on the mean and V_xyz eight times it; the mean over directions then makes the second area about l / (24 m) of the
/// first, m the mean chord. So the first inner sample of a cell is worth l^3 (1 - l / (24 m)), the second l^4 / (24 m);
/// each cell's gains fall, and taking the largest ones first makes the expected sum of areas smallest.
std::vector<int> inner_samples(const std::vector<double>& chords, std::int64_t budget);

/// The approximate signal from such samples: a line, a parabola (rules/order2.glsl) or a cubic (rules/order3.glsl) in
/// each cell. It has no order in a step: its kinks are the signal's own, and it is exact for trilinear rays from three
/// samples per cell and one for the end on, when no more are taken. It needs a sample on every border: a smaller budget
/// is exceeded, and below about 1.2 samples per cell virtual_catmull_rom is better. Returns the number of samples
/// taken.
template <int Degree>
std::int64_t approximate_cells(const Chain<Degree>& signal, std::int64_t budget, Chain<3>& approximation);

}  // namespace raytruth
