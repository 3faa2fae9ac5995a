#include "raytruth/skipping/block_refinement.hpp"

#include "raytruth/skipping/overshoot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raytruth {

namespace {

constexpr double of_virtual_samples = 1.0 / 8;  // Lee 2010, eq. 8
constexpr double longest_chord = std::numbers::sqrt3;

}  // namespace

BlockRefinement block_refinement(FieldKind field, const std::optional<double>& step, BlockBounds bounds) {
  switch (bounds) {
    case BlockBounds::unrefined:
      return {};
    case BlockBounds::printed:
      return {.overshoot = of_virtual_samples};
    default:
      const double of_field = field_overshoot(field);
      return {.growth = proven_growth(BlockRegion::cells, step.value_or(longest_chord)),
              .overshoot = of_field + of_virtual_samples * (1 + 2 * of_field)};
  }
}

double margin_of(const Grid& grid) {
  const auto [low, high] = grid.range();
  return 1e-7 * std::max({high - low, std::abs(low), std::abs(high)});
}

}  // namespace raytruth
