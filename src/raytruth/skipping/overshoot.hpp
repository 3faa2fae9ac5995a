#pragma once

#include "raytruth/signals/tricubic.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

/// How far virtual samples leave the data that a min-max block holds (Lee 2010, section 3.2). Virtual samples are
/// linear in the data, so the largest is found at a corner of the box of allowed data: data with positive weight at
/// their upper end, data with negative weight at their lower end.
namespace raytruth {

/// The largest value of the Catmull-Rom cubic between its two middle samples, all samples varying in their ranges:
/// exact. With all four in [m, M] it is M + (M - m) / 8, at samples m, M, M, m (eq. 8); with inner samples in [m, M]
/// and outer ones in [g, G] it is at least M + (M - g) / 8, whatever m is.
double largest_virtual_sample(std::pair<double, double> inner, std::pair<double, double> outer);

/// The largest value on the first interval of a ray, where a ghost stands for the sample before it; the other three lie
/// in `range`.
double largest_first_virtual_sample(std::pair<double, double> range);

/// What the samples along a ray are made from.
enum class SampleWeights {
  bspline,      ///< tricubic B-spline: over the voxels, or over the coefficients where they are prefiltered
  cardinal,     ///< prefiltered tricubic B-spline over the voxels; cut off 8 voxels away, which hides 0.0002 at most
  catmull_rom,  ///< tricubic Catmull-Rom over the voxels
};

/// The largest overshoot found over rays in all directions, with true samples `step` voxels apart: voxels vary in [m,
/// M], the result is in units of M - m. For each ray the true samples, virtual samples at the 16 points u = 0, 1/16,
/// ... between them, and the worst voxels for each: the sum of the negative weights.
struct Overshoot {
  double of_true_samples = 0;
  double of_virtual_samples = 0;
};
Overshoot search_overshoot(SampleWeights weights, double step, std::int64_t rays, std::uint64_t seed);

/// The part of space where a block of voxels a ... b on every axis is asked for its range.
enum class BlockRegion {
  cells,   ///< [a, b]: the cells between its voxels; neighbouring blocks share a layer of voxels
  voxels,  ///< [a - 1/2, b + 1/2]: what is nearest to its voxels; blocks are disjoint
};

/// How many voxels a block has to grow on every side until its range holds for the true samples that its virtual
/// samples are made of: ceil(2 h) + 1 for cells and ceil(2 h + 1/2) + 1 for voxels, at steps of h voxels and tricubic
/// samples.
///
/// A virtual sample at x lies between the samples at x - u h and x + (1 - u) h, 0 <= u < 1; the outer ones are less
/// than 2h away on every axis. The cubic kernel at y asks the voxels from floor(y) - 1 on, so below a block that begins
/// at a the first voxel asked is ceil(2h) + 1 away from a; above it likewise. From a - 1/2 it is half a voxel more.
std::int64_t proven_growth(BlockRegion region, double step);

inline constexpr std::size_t growths = 9;  ///< 0 ... 8 voxels are searched

/// What reaches virtual samples in a block from beyond it, by growth of the block.
struct BlockLeak {
  std::int64_t samples = 0;                     ///< virtual samples in the block, of all rays
  std::array<std::int64_t, growths> leaking{};  ///< those whose weights beyond the grown block exceed 10^-12
  std::array<double, growths> leak{};           ///< largest sum of the weights' magnitudes beyond the grown block
};

/// Rays in all directions through points in a block of size^3 voxels, with tricubic B-spline samples `step` apart from
/// a random phase on, and virtual samples at u = 0, 1/16, ... between them. A leak w means: a grown block of one value
/// v, whose bound is v, has a virtual sample of v + w |g - v| where the voxels beyond are v +- |g - v|.
BlockLeak search_block(BlockRegion region, std::int64_t size, double step, std::int64_t rays, std::uint64_t seed);

}  // namespace raytruth
