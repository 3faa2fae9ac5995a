#include "raytruth/signals/fields/molecule.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace raytruth {
namespace {

TEST(Molecule, AtomsAreWhereTheyShouldBe) {
  const auto atoms = atoms_of(Molecule{.atoms = 300});
  ASSERT_EQ(atoms.size(), 300U);
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const auto& [place, width, amplitude] = atoms[i];
    EXPECT_LE(std::hypot(place[0] - 0.5, place[1] - 0.5, place[2] - 0.5), 0.3 + 1e-15);
    EXPECT_TRUE(width >= 0.03 && width <= 0.08);
    EXPECT_TRUE(std::abs(amplitude) >= 0.5 && std::abs(amplitude) <= 1);
    EXPECT_EQ(amplitude < 0, i % 3 == 2);
  }
  EXPECT_NE(atoms_of(Molecule{.seed = 2}).front().place, atoms_of(Molecule{}).front().place);
}

TEST(Molecule, OneAtomIsItsGaussian) {
  // The integral of a Gaussian over space: amplitude (2 pi)^(3/2) width^3, for it ends before the cube does.
  const Molecule molecule{.size = 65, .atoms = 1};
  const GaussianAtom atom = atoms_of(molecule).front();
  const Grid grid = make_grid(molecule);
  const double sum = std::accumulate(grid.values.begin(), grid.values.end(), 0.0) / (64.0 * 64 * 64);
  EXPECT_NEAR(sum * (atom.amplitude / grid.range().second),
              atom.amplitude * std::pow(2 * std::numbers::pi, 1.5) * std::pow(atom.width, 3), 0.02 * sum);
}

TEST(Molecule, GridIsThePotentialStretched) {
  const Molecule molecule{.size = 33};
  const auto atoms = atoms_of(molecule);
  const Grid grid = make_grid(molecule);
  EXPECT_EQ(grid.range(), (std::pair{0.0, 1.0}));
  const auto at = [&atoms](double i, double j, double k) { return potential(atoms, i / 32, j / 32, k / 32); };
  // Stretching keeps ratios of differences.
  const double scale = (grid.at(16, 16, 16) - grid.at(12, 20, 17)) / (at(16, 16, 16) - at(12, 20, 17));
  for (std::int64_t i = 0; i < 33; ++i)
    EXPECT_NEAR(grid.at(i, 14, 18) - grid.at(0, 0, 0), scale * (at(static_cast<double>(i), 14, 18) - at(0, 0, 0)),
                1e-13);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(make_grid(molecule).values, grid.values);
}

TEST(Molecule, RefusesOptionsOutOfRange) {
  EXPECT_THROW(make_grid(Molecule{.size = 1}), FieldOptionError);
  EXPECT_THROW(make_grid(Molecule{.atoms = 0}), FieldOptionError);
}

}  // namespace
}  // namespace raytruth
