#include "raytruth/signals/tracing_error.hpp"

namespace raytruth {

ExactLine::ExactLine(const std::array<std::int64_t, 3>& grid_size, Border border, const Ray& ray)
    : size(grid_size), origin(ray.origin), direction(ray.direction), cut(ray.length) {
  static_cast<void>(unit_direction(direction));  // for what it refuses
  int exponent = 0;
  static_cast<void>(
      std::frexp(std::max({std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])}), &exponent));
  DoubleDouble square;
  for (double& x : direction) {
    x = std::ldexp(x, -exponent);
    square += two_product(x, x);
  }
  // One Newton step each from the rounded root and its rounded inverse.
  const double root = std::sqrt(square.high);
  norm = DoubleDouble(root) + (square - two_product(root, root)) / (2 * root);
  const double inverse = 1 / norm.high;
  inverse_norm = DoubleDouble(inverse) + (DoubleDouble(1) - norm * inverse) * inverse;
  inside = clip(size, border, origin, direction);
}

double ExactLine::length_error(const DoubleDouble& chain_end) const {
  const DoubleDouble available = (inside.end - inside.begin) * norm;
  const double uncertainty = noise * (std::abs(inside.begin.high) + std::abs(inside.end.high));
  const auto distance = [&](double change) {
    const DoubleDouble length = std::min(std::max(available + change, DoubleDouble(0)), DoubleDouble(cut));
    return std::abs(static_cast<double>(length - chain_end));
  };
  return (1 + 0x1p-46) * std::max(distance(-uncertainty), distance(uncertainty));
}

}  // namespace raytruth
