#include "raytruth/signals/fields/molecule.hpp"

#include "raytruth/core/random.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace raytruth {

namespace {

double node(std::int64_t i, std::int64_t size) { return static_cast<double>(i) / static_cast<double>(size - 1); }

/// exp(-d^2 / (2 width^2)) at the nodes of an axis, atom after atom: a Gaussian is the product of three of them.
std::vector<double> factors(const std::vector<GaussianAtom>& atoms, std::size_t axis, std::int64_t size) {
  std::vector<double> values;
  values.reserve(atoms.size() * static_cast<std::size_t>(size));
  for (const GaussianAtom& atom : atoms)
    for (std::int64_t i = 0; i < size; ++i) {
      const double distance = (node(i, size) - atom.place[axis]) / atom.width;
      values.push_back(std::exp(-distance * distance / 2));
    }
  return values;
}

}  // namespace

std::vector<GaussianAtom> atoms_of(const Molecule& molecule) {
  std::vector<GaussianAtom> atoms;
  for (std::int64_t i = 0; i < molecule.atoms; ++i) {
    const auto where = random_numbers(molecule.seed, RandomStream::molecules, static_cast<std::uint64_t>(2 * i));
    const auto how = random_numbers(molecule.seed, RandomStream::molecules, static_cast<std::uint64_t>(2 * i + 1));
    const double radius = 0.3 * std::cbrt(where[0]);
    const double height = 2 * where[1] - 1;
    const double across = std::sqrt(1 - height * height);
    const double angle = 2 * std::numbers::pi * where[2];
    const double magnitude = 0.5 + 0.5 * how[1];
    atoms.push_back({.place = {0.5 + radius * across * std::cos(angle), 0.5 + radius * across * std::sin(angle),
                               0.5 + radius * height},
                     .width = 0.03 + 0.05 * how[0],
                     .amplitude = i % 3 == 2 ? -magnitude : magnitude});
  }
  return atoms;
}

double potential(std::span<const GaussianAtom> atoms, double x, double y, double z) {
  double sum = 0;
  for (const GaussianAtom& atom : atoms) {
    const double distance = std::hypot(x - atom.place[0], y - atom.place[1], z - atom.place[2]) / atom.width;
    sum += atom.amplitude * std::exp(-distance * distance / 2);
  }
  return sum;
}

void check(const Molecule& molecule) { check_options(molecule); }

Grid make_grid(const Molecule& molecule) {
  check(molecule);
  const std::vector<GaussianAtom> atoms = atoms_of(molecule);
  const std::int64_t size = molecule.size;
  const std::array along{factors(atoms, 0, size), factors(atoms, 1, size), factors(atoms, 2, size)};
  Grid grid{.size = {size, size, size}, .spacing = {1, 1, 1}, .values = {}};
  grid.values.resize(static_cast<std::size_t>(size * size * size));
  tbb::parallel_for(std::int64_t{0}, size, [&](std::int64_t k) {
    for (std::int64_t j = 0; j < size; ++j)
      for (std::size_t atom = 0; atom < atoms.size(); ++atom) {
        const auto first = atom * static_cast<std::size_t>(size);
        const double weight = atoms[atom].amplitude * along[1][first + static_cast<std::size_t>(j)] *
                              along[2][first + static_cast<std::size_t>(k)];
        double* const line = grid.values.data() + grid.index(0, j, k);
        for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) line[i] += weight * along[0][first + i];
      }
  });
  const auto [low, high] = grid.range();
  if (low < high)
    for (double& value : grid.values) value = (value - low) / (high - low);
  return grid;
}

}  // namespace raytruth
