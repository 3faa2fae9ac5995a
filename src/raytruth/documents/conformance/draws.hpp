#pragma once

#include "raytruth/core/random.hpp"

#include <cstdint>

namespace raytruth {

/// The random numbers of one vector, one after the other.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t vector) : seed_(seed), vector_(vector) {}

  /// One of low, low + 1, ..., high.
  int whole(int low, int high) { return low + static_cast<int>(next() * (high - low + 1)); }

 private:
  double next() {
    const std::uint32_t number = drawn_++;
    return random_numbers(seed_, RandomStream::vectors, vector_, number / 4)[number % 4];
  }

  std::uint64_t seed_;
  std::uint64_t vector_;
  std::uint32_t drawn_ = 0;
};

}  // namespace raytruth
