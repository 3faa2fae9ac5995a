#include "raytruth/deformation/inverse.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/deformation/displacement.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace raytruth {
namespace {

const LatticeBox box{.origin = Eigen::Vector3d::Constant(-0.5), .edges = Eigen::Matrix3d::Identity() * 32};

Lattice random_lattice(double amplitude) {
  const std::array<std::int64_t, 3> cells{4, 4, 4};
  auto points = undisplaced_points(box, cells, Placement::greville);
  displace(box, cells, {RandomDisplacement{.amplitude = amplitude, .seed = 3}}, points);
  return {box, cells, points};
}

Eigen::Vector3d object_of(std::uint64_t i) {
  const auto chance = random_numbers(3, RandomStream::points, i);
  return Eigen::Vector3d(4 + 24 * chance[0], 4 + 24 * chance[1], 4 + 24 * chance[2]);
}

/// The largest distance from the object's point over some of them.
template <class Inverse>
double worst(const Lattice& lattice, const Inverse& inverse) {
  double result = 0;
  for (std::uint64_t i = 0; i < 50; ++i)
    result = std::max(result, (inverse(lattice(object_of(i))) - object_of(i)).norm());
  return result;
}

TEST(Inverse, NewtonsIsWithinItsRadius) {
  const Lattice lattice = random_lattice(0.3);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Eigen::Vector3d object = object_of(i);
    const CertifiedInverse found = newton_inverse(lattice, lattice(object), lattice(object));
    EXPECT_LE((found.object - object).norm(), found.radius);
    EXPECT_LT(found.radius, 1e-11);
  }
  EXPECT_FALSE(std::isfinite(newton_inverse(lattice, {1e9, 0, 0}, {std::nan(""), 0, 0}).radius));
}

TEST(Inverse, ThePrintedOneIsOfSecondOrderInTheDisplacement) {
  const auto error = [](double amplitude) {
    const Lattice lattice = random_lattice(amplitude);
    return worst(lattice, [&](const Eigen::Vector3d& world) { return printed_inverse(lattice, world); });
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 2, 0.1);
}

TEST(Inverse, EachFixedPointStepGainsAnOrder) {
  for (const int steps : {1, 2, 3}) {
    const auto error = [steps](double amplitude) {
      const Lattice lattice = random_lattice(amplitude);
      return worst(lattice, [&](const Eigen::Vector3d& world) { return fixed_point_inverse(lattice, world, steps); });
    };
    EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), steps + 1, 0.15);
  }
  const Lattice lattice = random_lattice(0.1);
  for (std::uint64_t i = 0; i < 5; ++i) {
    const Eigen::Vector3d world = object_of(i);
    EXPECT_LT((fixed_point_inverse(lattice, world, 1) - printed_inverse(lattice, world)).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace raytruth
