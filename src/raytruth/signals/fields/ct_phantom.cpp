#include "raytruth/signals/fields/ct_phantom.hpp"

#include "raytruth/core/random.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace raytruth {

namespace {

constexpr double air = 0;
constexpr double foam = 0.08;
constexpr double fluid = 0.36;
constexpr double tissue = 0.4;
constexpr double brain = 0.45;
constexpr double contrast = 0.65;
constexpr double bone = 0.85;

const std::array<PhantomPart, 14> parts{{
    PhantomEllipsoid{{0, 0, 0}, {0.8, 0.9, 0.85}, tissue},
    PhantomEllipsoid{{0, 0, 0}, {0.72, 0.82, 0.77}, bone},
    PhantomEllipsoid{{0, 0, 0}, {0.65, 0.75, 0.7}, brain},
    // Ventricles and vessels.
    PhantomEllipsoid{{-0.18, 0.1, 0.1}, {0.08, 0.3, 0.13}, fluid},
    PhantomEllipsoid{{0.18, 0.1, 0.1}, {0.08, 0.3, 0.13}, fluid},
    PhantomCylinder{{-0.32, -0.2, 0}, 0.035, 0.45, contrast},
    PhantomCylinder{{0.32, -0.2, 0}, 0.035, 0.45, contrast},
    // A sinus, which two walls divide.
    PhantomEllipsoid{{0, -0.66, -0.25}, {0.22, 0.16, 0.2}, air},
    PhantomBox{{0, -0.66, -0.25}, {0.01, 0.15, 0.18}, bone},
    PhantomBox{{0, -0.66, -0.25}, {0.2, 0.13, 0.01}, bone},
    // A vertebra and its canal.
    PhantomCylinder{{0, 0.42, -0.45}, 0.14, 0.2, bone},
    PhantomCylinder{{0, 0.42, -0.45}, 0.06, 0.2, fluid},
    // The bed: foam in a thin shell.
    PhantomBox{{0, 0.955, 0}, {0.95, 0.025, 0.98}, contrast},
    PhantomBox{{0, 0.955, 0}, {0.94, 0.015, 0.97}, foam},
}};

/// How much of a voxel of side `side` a border leaves inside that is `distance` away from the voxel's middle, negative
/// inside, where the border is taken for a plane across an axis.
double coverage(double distance, double side) { return std::clamp(0.5 - distance / side, 0.0, 1.0); }

/// How much of an interval of length `side` around `place` lies within `half` of 0.
double overlap(double place, double half, double side) {
  const double low = std::max(place - side / 2, -half);
  const double high = std::min(place + side / 2, half);
  return std::max(0.0, high - low) / side;
}

double filled(const PhantomEllipsoid& part, const std::array<double, 3>& place, double side) {
  // The distance from the border to first order: the implicit function over its gradient.
  double square = 0;
  double gradient = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double relative = (place[axis] - part.middle[axis]) / part.half[axis];
    square += relative * relative;
    gradient += relative * relative / (part.half[axis] * part.half[axis]);
  }
  if (!(gradient > 0)) return 1;
  return coverage((square - 1) / (2 * std::sqrt(gradient)), side);
}

double filled(const PhantomCylinder& part, const std::array<double, 3>& place, double side) {
  const double across = std::hypot(place[0] - part.middle[0], place[1] - part.middle[1]);
  return coverage(across - part.radius, side) * overlap(place[2] - part.middle[2], part.half_length, side);
}

double filled(const PhantomBox& part, const std::array<double, 3>& place, double side) {
  double share = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) share *= overlap(place[axis] - part.middle[axis], part.half[axis], side);
  return share;
}

std::array<double, 3> half_sides(const PhantomEllipsoid& part) { return part.half; }
std::array<double, 3> half_sides(const PhantomCylinder& part) { return {part.radius, part.radius, part.half_length}; }
std::array<double, 3> half_sides(const PhantomBox& part) { return part.half; }

/// Fills a part of the slice z = k.
template <class Part>
void fill(const Part& part, std::int64_t k, Grid& grid) {
  const std::int64_t size = grid.size[0];
  const double side = 2 / static_cast<double>(size);
  const auto middle_of = [side](std::int64_t i) { return (static_cast<double>(i) + 0.5) * side - 1; };
  // Voxels that the part may reach, one more on each side.
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> last{};
  const std::array<double, 3> half = half_sides(part);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = std::max<std::int64_t>(
        0, static_cast<std::int64_t>(std::floor((part.middle[axis] - half[axis] + 1) / side)) - 1);
    last[axis] =
        std::min(size - 1, static_cast<std::int64_t>(std::floor((part.middle[axis] + half[axis] + 1) / side)) + 1);
  }
  if (k < first[2] || k > last[2]) return;
  for (std::int64_t j = first[1]; j <= last[1]; ++j)
    for (std::int64_t i = first[0]; i <= last[0]; ++i) {
      double& value = grid.values[grid.index(i, j, k)];
      value += filled(part, {middle_of(i), middle_of(j), middle_of(k)}, side) * (part.value - value);
    }
}

/// Weights of the point spread at k = 0 ... reach; those of both sides sum to 1.
std::vector<double> spread_weights(double spread) {
  std::vector<double> weights{1};
  const auto reach = static_cast<std::int64_t>(std::ceil(4 * spread));
  double sum = 1;
  for (std::int64_t k = 1; k <= reach; ++k) {
    const double distance = static_cast<double>(k) / spread;
    weights.push_back(std::exp(-distance * distance / 2));
    sum += 2 * weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Convolution along an axis, in place, line by line.
void convolve(Grid& grid, const std::vector<double>& weights, std::size_t axis) {
  const std::int64_t size = grid.size[0];
  const std::size_t stride = axis == 0 ? 1 : static_cast<std::size_t>(axis == 1 ? size : size * size);
  tbb::parallel_for(std::int64_t{0}, size, [&](std::int64_t outer) {
    std::vector<double> line(static_cast<std::size_t>(size));
    for (std::int64_t inner = 0; inner < size; ++inner) {
      const std::size_t begin = axis == 0   ? grid.index(0, inner, outer)
                                : axis == 1 ? grid.index(inner, 0, outer)
                                            : grid.index(inner, outer, 0);
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = grid.values[begin + i * stride];
      const auto at = [&line, size](std::int64_t i) {
        return line[static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, size - 1))];
      };
      for (std::int64_t i = 0; i < size; ++i) {
        double sum = weights[0] * at(i);
        for (std::size_t k = 1; k < weights.size(); ++k)
          sum += weights[k] * (at(i - static_cast<std::int64_t>(k)) + at(i + static_cast<std::int64_t>(k)));
        grid.values[begin + static_cast<std::size_t>(i) * stride] = sum;
      }
    }
  });
}

/// Four normal numbers (G. E. P. Box and M. E. Muller, 1958).
std::array<double, 4> normal_numbers(std::uint64_t seed, std::uint64_t index) {
  const auto uniform = random_numbers(seed, RandomStream::noise, index);
  std::array<double, 4> normal{};
  for (std::size_t pair = 0; pair < 4; pair += 2) {
    const double radius = std::sqrt(-2 * std::log1p(-uniform[pair]));
    const double angle = 2 * std::numbers::pi * uniform[pair + 1];
    normal[pair] = radius * std::cos(angle);
    normal[pair + 1] = radius * std::sin(angle);
  }
  return normal;
}

/// Adds noise to the voxels from `begin` on, and rounds them to 8 bits.
void store(const CtPhantom& phantom, Grid& grid, std::size_t begin, std::size_t end) {
  std::array<double, 4> noise{};
  for (std::size_t i = begin; i < end; ++i) {
    if (phantom.noise > 0 && (i == begin || i % 4 == 0)) noise = normal_numbers(phantom.seed, i / 4);
    const double value = grid.values[i] + phantom.noise * noise[i % 4];
    grid.values[i] = std::round(255 * std::clamp(value, 0.0, 1.0)) / 255;
  }
}

}  // namespace

std::span<const PhantomPart> phantom_parts() { return parts; }

void check(const CtPhantom& phantom) { check_options(phantom); }

Grid make_grid(const CtPhantom& phantom) {
  check(phantom);
  const std::int64_t size = phantom.size;
  Grid grid{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  const auto slice = static_cast<std::size_t>(size * size);
  grid.values.resize(slice * static_cast<std::size_t>(size), air);
  tbb::parallel_for(std::int64_t{0}, size, [&](std::int64_t k) {
    for (const PhantomPart& any : parts) std::visit([&](const auto& part) { fill(part, k, grid); }, any);
  });
  if (phantom.spread > 0) {
    const std::vector<double> weights = spread_weights(phantom.spread);
    for (std::size_t axis = 0; axis < 3; ++axis) convolve(grid, weights, axis);
  }
  tbb::parallel_for(std::size_t{0}, static_cast<std::size_t>(size),
                    [&](std::size_t k) { store(phantom, grid, k * slice, (k + 1) * slice); });
  return grid;
}

}  // namespace raytruth
