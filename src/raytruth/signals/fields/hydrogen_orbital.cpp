#include "raytruth/signals/fields/hydrogen_orbital.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace raytruth {

namespace {

/// The associated Laguerre polynomial of Abramowitz and Stegun, by its recurrence in the degree.
double laguerre(std::int64_t degree, double order, double x) {
  double before = 0;
  double value = 1;
  for (std::int64_t k = 0; k < degree; ++k) {
    const auto index = static_cast<double>(k);
    const double next = ((2 * index + 1 + order - x) * value - (index + order) * before) / (index + 1);
    before = value;
    value = next;
  }
  return value;
}

/// The associated Legendre function but for its sign, by its recurrence in the degree.
double legendre(std::int64_t degree, std::int64_t order, double x) {
  double value = 1;
  const double root = std::sqrt(std::max(0.0, (1 - x) * (1 + x)));
  for (std::int64_t k = 1; k <= order; ++k) value *= static_cast<double>(2 * k - 1) * root;
  double before = 0;
  for (std::int64_t k = order; k < degree; ++k) {
    const double next = (static_cast<double>(2 * k + 1) * x * value - static_cast<double>(k + order) * before) /
                        static_cast<double>(k + 1 - order);
    before = value;
    value = next;
  }
  return value;
}

/// first! / last!, for first <= last.
double factorial_ratio(std::int64_t first, std::int64_t last) {
  double product = 1;
  for (std::int64_t k = first + 1; k <= last; ++k) product /= static_cast<double>(k);
  return product;
}

}  // namespace

double hydrogen_density(const HydrogenOrbital& orbital, double x, double y, double z) {
  const auto [n, l] = std::pair{orbital.n, orbital.l};
  const std::int64_t m = std::abs(orbital.m);
  const double r = std::hypot(x, y, z);
  const double rho = 2 * r / static_cast<double>(n);
  const double cosine = r > 0 ? z / r : 0;
  const double radial =
      std::pow(rho, static_cast<double>(l)) * laguerre(n - l - 1, static_cast<double>(2 * l + 1), rho);
  const double angular = legendre(l, m, cosine);
  const double norm = 8 / static_cast<double>(n * n * n) * factorial_ratio(n - l - 1, n + l) /
                      static_cast<double>(2 * n) * static_cast<double>(2 * l + 1) / (4 * std::numbers::pi) *
                      factorial_ratio(l - m, l + m);
  return norm * std::exp(-rho) * radial * radial * angular * angular;
}

void check(const HydrogenOrbital& orbital) {
  check_options(orbital);
  if (orbital.l >= orbital.n) throw FieldOptionError("l", orbital.l, std::int64_t{0}, orbital.n - 1);
  if (std::abs(orbital.m) > orbital.l) throw FieldOptionError("m", orbital.m, -orbital.l, orbital.l);
}

Grid make_grid(const HydrogenOrbital& orbital) {
  check(orbital);
  const std::int64_t size = orbital.size;
  Grid grid{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  grid.values.resize(static_cast<std::size_t>(size * size * size));
  const auto node = [&orbital](std::int64_t i) {
    return orbital.extent * (2 * static_cast<double>(i) / static_cast<double>(orbital.size - 1) - 1);
  };
  tbb::parallel_for(std::int64_t{0}, size, [&](std::int64_t k) {
    for (std::int64_t j = 0; j < size; ++j)
      for (std::int64_t i = 0; i < size; ++i)
        grid.values[grid.index(i, j, k)] = hydrogen_density(orbital, node(i), node(j), node(k));
  });
  const double largest = grid.range().second;
  if (largest > 0)
    for (double& value : grid.values) value /= largest;
  return grid;
}

}  // namespace raytruth
