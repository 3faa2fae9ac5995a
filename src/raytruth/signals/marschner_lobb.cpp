#include "raytruth/signals/marschner_lobb.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/signals/analytic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace raytruth {

double marschner_lobb(double x, double y, double z) {
  using std::numbers::pi;
  constexpr double frequency = 6;
  constexpr double alpha = 0.25;
  const double ripple = std::cos(2 * pi * frequency * std::cos(pi * std::hypot(x, y) / 2));
  return (1 - std::sin(pi * z / 2) + alpha * (1 + ripple)) / (2 * (1 + alpha));
}

void check(const SampledMarschnerLobb& field) { check_options(field); }

Grid make_grid(const SampledMarschnerLobb& field) {
  check(field);
  const std::int64_t samples = field.samples;
  Grid grid{.size = {samples, samples, samples}, .spacing = {1, 1, 1}, .values = {}};
  grid.values.reserve(static_cast<std::size_t>(samples * samples * samples));
  const auto node = [samples](std::int64_t i) {
    return 2 * static_cast<double>(i) / static_cast<double>(samples - 1) - 1;
  };
  for (std::int64_t k = 0; k < samples; ++k)
    for (std::int64_t j = 0; j < samples; ++j)
      for (std::int64_t i = 0; i < samples; ++i) grid.values.push_back(marschner_lobb(node(i), node(j), node(k)));
  return grid;
}

Chain<9> trace_marschner_lobb(const Ray& ray) {
  const auto direction = unit_direction(ray.direction);
  if (!(ray.length >= 0)) throw InputError(fmt::format("length {}; numbers >= 0 are allowed", ray.length));
  double begin = 0;
  double end = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (!(std::abs(ray.origin[axis]) <= 1)) return {};
      continue;
    }
    const double a = (-1 - ray.origin[axis]) / direction[axis];
    const double b = (1 - ray.origin[axis]) / direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  const double length = std::min(end - begin, ray.length);
  if (!(length > 0)) return {};
  const auto at = [&](std::size_t axis, double t) { return ray.origin[axis] + (begin + t) * direction[axis]; };
  return expand([&](double t) { return marschner_lobb(at(0, t), at(1, t), at(2, t)); }, {}, length);
}

}  // namespace raytruth
