#include "raytruth/signals/random_field.hpp"

#include "raytruth/core/random.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace raytruth {

namespace {

/// Weights of the Gaussian at k = -reach ... reach, summing to 1.
std::vector<double> gaussian_weights(double smoothing) {
  const auto reach = static_cast<std::int64_t>(std::ceil(6 * smoothing));
  std::vector<double> weights;
  double sum = 0;
  for (std::int64_t k = -reach; k <= reach; ++k) {
    const auto distance = static_cast<double>(k);
    weights.push_back(std::exp(-distance * distance / (2 * smoothing * smoothing)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Periodic convolution along one axis. Each voxel's sum runs in the same order whatever thread takes it.
Grid convolve(const Grid& grid, const std::vector<double>& weights, std::size_t axis) {
  Grid result = grid;
  const std::int64_t size = grid.size[axis];
  const auto reach = static_cast<std::int64_t>(weights.size() / 2);
  tbb::parallel_for(std::int64_t{0}, grid.size[2], [&](std::int64_t z) {
    for (std::int64_t y = 0; y < grid.size[1]; ++y)
      for (std::int64_t x = 0; x < grid.size[0]; ++x) {
        std::array voxel{x, y, z};
        const std::int64_t centre = voxel[axis];
        double sum = 0;
        for (std::int64_t k = -reach; k <= reach; ++k) {
          voxel[axis] = ((centre + k) % size + size) % size;
          sum += weights[static_cast<std::size_t>(k + reach)] * grid.at(voxel[0], voxel[1], voxel[2]);
        }
        result.values[grid.index(x, y, z)] = sum;
      }
  });
  return result;
}

}  // namespace

void check(const RandomField& field) {
  check_options(field);
  const auto size = static_cast<double>(field.size);
  if (!(field.smoothing <= size)) throw FieldOptionError("smoothing", field.smoothing, 0.0, size);
}

Grid make_grid(const RandomField& field) {
  check(field);
  const auto& [size, smoothing, seed] = field;
  Grid grid{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  grid.values.resize(static_cast<std::size_t>(size * size * size));
  for (std::size_t i = 0; i < grid.values.size(); ++i)
    grid.values[i] = random_numbers(seed, RandomStream::field, i / 4)[i % 4];
  if (smoothing == 0) return grid;

  const auto weights = gaussian_weights(smoothing);
  for (std::size_t axis = 0; axis < 3; ++axis) grid = convolve(grid, weights, axis);
  const auto [low, high] = grid.range();
  if (low < high)
    for (double& value : grid.values) value = (value - low) / (high - low);
  return grid;
}

}  // namespace raytruth
