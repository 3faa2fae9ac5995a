#pragma once

#include "raytruth/core/random.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace raytruth {

// Lit slabs at random: functions of their arguments alone.

inline constexpr std::array both_conventions{Emission::associated, Emission::plain};
inline constexpr std::array treatments{Negative::clamp, Negative::mirror, Negative::none};

inline Vector3<double> random_direction(std::uint64_t seed, std::uint64_t index) {
  const auto u = random_numbers(seed, RandomStream::points, index);
  const double z = 2 * u[0] - 1;
  const double angle = 2 * std::numbers::pi * u[1];
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

struct LitSlab {
  ShadedSlab slab;
  Lighting lighting;
};

/// A slab of any depth and direction; every highlight with every treatment of what faces away, in turn.
inline LitSlab random_slab(std::uint64_t seed, std::uint64_t index) {
  const auto u = random_numbers(seed, RandomStream::points, index);
  LitSlab result;
  result.slab = {u[0], u[1], 0.1 + 4 * u[2], random_direction(1, index), random_direction(2, index)};
  result.lighting.light = random_direction(3, index);
  result.lighting.half = random_direction(4, index);
  result.lighting.ambient = 0.25;
  result.lighting.specular = 0.5;
  constexpr std::array shininesses{1.0, 2.0, 10.0, 33.5, 80.0};
  result.lighting.shininess = shininesses[index % shininesses.size()];
  const auto& highlights = catalogue::highlights();
  result.lighting.highlight = &highlights[index % highlights.size()];
  result.lighting.negative = treatments[index / highlights.size() % treatments.size()];
  if (result.lighting.negative == Negative::none) result.lighting.shininess = std::ceil(result.lighting.shininess);
  return result;
}

/// A ramp, a tent, a step, an isoslab, a random table, in turn.
inline const PiecewiseLinear& transfer_of(std::uint64_t index) {
  static const std::array transfers{ramp_transfer(3), tent_transfer(8), step_transfer(2), isoslab_transfer(400),
                                    random_transfer(5, 3)};
  return transfers[index % transfers.size()];
}

}  // namespace raytruth
