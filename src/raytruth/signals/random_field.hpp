#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/field_option.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>
#include <tuple>

namespace raytruth {

/// Noise on a periodic grid of size^3 voxels, in [0, 1], from a counter-based generator (Philox 4x32-10 of
/// J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, 2011): the same bytes for the same seed on any
/// number of threads.
///
/// smoothing = 0: white noise, uniform in [0, 1). smoothing > 0: white noise convolved on each axis with
/// exp(-k^2 / (2 smoothing^2)), |k| <= ceil(6 smoothing), weights summing to 1, then scaled to [0, 1] by its extremes.
struct RandomField {
  static constexpr Named kind{
      "random_field", "white noise in [0, 1], or white noise smoothed by a Gaussian; 64^3, periodic, from a seed"};

  std::int64_t size = 64;
  double smoothing = 0;  ///< standard deviation in voxels, at most `size`
  std::uint64_t seed = 1;

  static constexpr auto options() {
    return std::tuple{
        FieldOption<RandomField, std::int64_t>{"size", &RandomField::size, 1, largest_generated_size},
        FieldOption<RandomField, double>{"smoothing", &RandomField::smoothing, 0, largest_generated_size}};
  }
};

/// Throws FieldOptionError.
void check(const RandomField& field);
Grid make_grid(const RandomField& field);

inline Grid random_field(std::int64_t size, double smoothing, std::uint64_t seed) {
  return make_grid(RandomField{.size = size, .smoothing = smoothing, .seed = seed});
}

}  // namespace raytruth
