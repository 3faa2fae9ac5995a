#pragma once

#include <array>
#include <cstdint>

namespace raytruth {

/// What a stream of random numbers is for; streams of one seed are independent.
enum class RandomStream : std::uint32_t {
  field = 0,
  rays = 1,
  points = 2,
  transfers = 3,
  vectors = 4,
  cases = 5,
  molecules = 6,
  noise = 7,
  pixels = 8,
  lattice = 9
};

/// Four numbers uniform in [0, 1), multiples of 2^-32, that depend on the arguments alone: Philox 4x32-10
/// (J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, 2011).
std::array<double, 4> random_numbers(std::uint64_t seed, RandomStream stream, std::uint64_t index,
                                     std::uint32_t repetition = 0);

}  // namespace raytruth
