#include "raytruth/schemes/radius_axis.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace raytruth {

double RadiusAxis::radius(std::size_t i) const {
  if (count == 1) return low;
  const double share = static_cast<double>(i) / static_cast<double>(count - 1);
  if (steps == RadiusSteps::equal_steps) return low + share * (high - low);
  if (steps == RadiusSteps::powers_of_two) return std::ldexp(low, static_cast<int>(i));
  return low * std::pow(high / low, share);
}

double RadiusAxis::curvature(std::size_t node) const {
  if (node == linear_node()) return 0;
  const bool is_upward = node > linear_node();
  const double r = radius(count - (is_upward ? node - linear_node() : linear_node() - node));
  return (is_upward ? 1 : -1) / (r * r);
}

RadiusNodes::RadiusNodes(const RadiusAxis& axis)
    : axis_(axis), sizes_{0}, radii_{std::numeric_limits<double>::infinity()} {
  check(axis);
  for (std::size_t distance = 1; distance <= axis.count; ++distance) {
    radii_.push_back(axis.radius(axis.count - distance));
    sizes_.push_back(1 / (radii_.back() * radii_.back()));
  }
}

bool RadiusNodes::clamps(double curvature) const {
  if (axis_.is_one_sided && curvature < 0) return false;
  return std::abs(curvature) > sizes_.back() * (1 + 1e-12);
}

RadiusNodes::Place RadiusNodes::place_of_size(double size) const {
  std::size_t inner = 0;
  while (inner + 2 < sizes_.size() && sizes_[inner + 1] <= size) ++inner;
  const double weight = (size - sizes_[inner]) / (sizes_[inner + 1] - sizes_[inner]);
  return {inner, inner + 1, std::min(weight, 1.0)};
}

RadiusNodes::Place RadiusNodes::place_of_radius(double radius) const {
  if (radius > axis_.high) return {0, 0, 0};
  const std::size_t last = axis_.count;
  if (radius <= axis_.low || last == 1) return {last, last, 0};
  std::size_t outer = last;  // the radius that is not above
  if (axis_.look_up == RadiusLookUp::natural_logarithm) {
    const double exponent = std::floor(std::log(radius) * std::numbers::ln2) - std::log2(axis_.low);
    outer = last - static_cast<std::size_t>(std::clamp(exponent, 0.0, static_cast<double>(last - 2)));
  } else {
    while (outer > 2 && radii_[outer - 1] <= radius) --outer;
  }
  const double weight = std::clamp((radius - radii_[outer]) / (radii_[outer - 1] - radii_[outer]), 0.0, 1.0);
  if (axis_.look_up != RadiusLookUp::nearest) return {outer, outer - 1, weight};
  const std::size_t nearer = weight < 0.5 ? outer : outer - 1;
  return {nearer, nearer, 0};
}

RadiusNodes::Place RadiusNodes::place(double curvature) const {
  const std::size_t linear = axis_.linear_node();
  if (curvature == 0 || (axis_.is_one_sided && curvature < 0)) return {linear, linear, 0};
  const double size = std::abs(curvature);
  const Place distance =
      axis_.look_up == RadiusLookUp::linear_in_curvature ? place_of_size(size) : place_of_radius(1 / std::sqrt(size));
  if (curvature > 0) return {linear + distance.first, linear + distance.second, distance.weight};
  return {linear - distance.first, linear - distance.second, distance.weight};
}

void check(const RadiusAxis& axis) {
  if (!(axis.low > 0) || !(axis.high >= axis.low) || !std::isfinite(axis.high) ||
      !std::isfinite(1 / (axis.low * axis.low)) || (axis.low == axis.high) != (axis.count == 1))
    throw InputError(
        fmt::format("found radii from {} to {}, {} of them; 0 < low < high is allowed, or low = high and one radius",
                    axis.low, axis.high, axis.count));
  if (axis.count < 1 || axis.count > most_radii)
    throw InputError(fmt::format("found {} radii; 1 to {} are allowed", axis.count, most_radii));
  if (axis.steps != RadiusSteps::powers_of_two) return;
  int exponent = 0;
  if (std::frexp(axis.low, &exponent) != 0.5 || std::ldexp(axis.low, static_cast<int>(axis.count) - 1) != axis.high)
    throw InputError(
        fmt::format("found {} radii by powers of two from {} to {}; low = 2^k and high = 2^(k + count - 1) are allowed",
                    axis.count, axis.low, axis.high));
}

}  // namespace raytruth
