#include "raytruth/deformation/lattice.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/deformation/displacement.hpp"
#include "raytruth/deformation/lattice_proof.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace raytruth {
namespace {

using Size = std::array<std::int64_t, 3>;

LatticeBox box_of(double x, double y, double z) {
  return {.origin = {-0.5, -0.5, -0.5}, .edges = Eigen::Vector3d(x, y, z).asDiagonal()};
}

Lattice lattice_of(const LatticeBox& box, const Size& cells, const std::vector<Displacement>& displacements) {
  auto points = undisplaced_points(box, cells, Placement::greville);
  displace(box, cells, displacements, points);
  return {box, cells, points};
}

Eigen::Vector3d place(const LatticeBox& box, std::uint64_t i) {
  const auto chance = random_numbers(3, RandomStream::points, i);
  return box.origin + box.edges * Eigen::Vector3d(chance[0], chance[1], chance[2]);
}

TEST(Lattice, AnUndisplacedOneMovesNothing) {
  LatticeBox box = box_of(20, 14, 9);
  box.edges(0, 1) = 3;
  const Lattice lattice = lattice_of(box, {4, 3, 1}, {});
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Eigen::Vector3d object = place(box, i);
    EXPECT_LT((lattice(object) - object).norm(), 1e-13);
    EXPECT_LT((lattice.jacobian(object) - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    EXPECT_LT((lattice.object_of(lattice.place_of(object)) - object).norm(), 1e-13);
  }
  EXPECT_NEAR(proof_of(lattice).least_determinant, 1, 1e-9);
  EXPECT_EQ(proof_of(lattice).refusal, "");
}

TEST(Lattice, ThePrintedPlacementShrinks) {
  const LatticeBox box = box_of(8, 8, 8);
  const Size cells{4, 4, 4};
  const Lattice lattice(box, cells, undisplaced_points(box, cells, Placement::printed));
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Eigen::Vector3d object = place(box, i);
    // F(u) = ((l - 1) u + 1/2) / l with l = 5.
    const Eigen::Vector3d u = (object - box.origin) / 8;
    const Eigen::Vector3d expected = box.origin + 8 * (4 * u + Eigen::Vector3d::Constant(0.5)) / 5;
    EXPECT_LT((lattice(object) - expected).norm(), 1e-13);
  }
}

TEST(Lattice, AffineDisplacementsAreReproduced) {
  const LatticeBox box = box_of(10, 12, 6);
  Affine affine;
  affine.matrix << 1.2, 0.1, 0, -0.2, 0.9, 0.3, 0, 0.1, 1;
  affine.offset = {1, 2, -3};
  const Lattice lattice = lattice_of(box, {3, 4, 2}, {affine});
  const Eigen::Vector3d centre = box.origin + Eigen::Vector3d(5, 6, 3);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Eigen::Vector3d object = place(box, i);
    EXPECT_LT((lattice(object) - (centre + affine.matrix * (object - centre) + affine.offset)).norm(), 1e-13);
    EXPECT_LT((lattice.jacobian(object) - affine.matrix).norm(), 1e-13);
  }
}

TEST(Lattice, TheJacobianIsTheDerivative) {
  const LatticeBox box = box_of(16, 16, 16);
  const Lattice lattice = lattice_of(box, {4, 4, 4}, {RandomDisplacement{.amplitude = 0.3, .seed = 7}});
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Eigen::Vector3d object = place(box, i);
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double step = 1e-5;
      const Eigen::Vector3d difference = (lattice(object + step * Eigen::Vector3d::Unit(axis)) -
                                          lattice(object - step * Eigen::Vector3d::Unit(axis))) /
                                         (2 * step);
      EXPECT_LT((lattice.jacobian(object).col(axis) - difference).norm(), 1e-5);
    }
  }
}

TEST(Lattice, DisplacementsAreWhatTheySay) {
  const LatticeBox box = box_of(8, 8, 16);
  const Size cells{2, 2, 4};
  const auto original = undisplaced_points(box, cells, Placement::greville);
  const Eigen::Vector3d centre(3.5, 3.5, 7.5);
  const auto moved = [&](const Displacement& displacement) {
    auto points = original;
    displace(box, cells, {displacement}, points);
    return points;
  };
  // The last point: x = y = 9.5, z = 17.5, so w = 9/8.
  const Eigen::Vector3d last = original.back();
  ASSERT_LT((last - Eigen::Vector3d(9.5, 9.5, 17.5)).norm(), 1e-14);
  const double turn = 90 * std::numbers::pi / 180 * 5 / 8;
  EXPECT_LT(
      (moved(Twist{.axis = 2, .degrees = 90}).back() -
       (centre + Eigen::Vector3d(6 * std::cos(turn) - 6 * std::sin(turn), 6 * std::sin(turn) + 6 * std::cos(turn), 10)))
          .norm(),
      1e-13);
  const double curvature = 90 * std::numbers::pi / 180 / 16;
  const double angle = 10 * curvature;
  EXPECT_LT((moved(Bend{.degrees = 90}).back() -
             (centre + Eigen::Vector3d((1 - std::cos(angle)) / curvature + 6 * std::cos(angle), 6,
                                       std::sin(angle) / curvature - 6 * std::sin(angle))))
                .norm(),
            1e-13);
  EXPECT_LT((moved(Taper{.axis = 2, .scale = {1, 0.5}}).back() -
             (centre + Eigen::Vector3d(6 * (1 - 0.5 * 9 / 8), 6 * (1 - 0.5 * 9 / 8), 10)))
                .norm(),
            1e-13);
  // The spline of a bulge is 1 + m (1 - (2 w - 1)^2 - 1 / n^2) wide.
  const Lattice bulged(box, cells, moved(Bulge{.axis = 2, .amount = 0.2}));
  const double width = 1 + 0.2 * (1 - 0.25 - 1.0 / 16);
  EXPECT_LT((bulged({5.5, 3.5, 3.5}) - Eigen::Vector3d(3.5 + 2 * width, 3.5, 3.5)).norm(), 1e-13);
}

TEST(Lattice, FoldsAndOverlapsAreRefused) {
  const LatticeBox box = box_of(16, 16, 16);
  EXPECT_NE(
      proof_of(lattice_of(box, {4, 4, 4}, {RandomDisplacement{.amplitude = 2, .seed = 1}})).refusal.find("folds in"),
      std::string::npos);
  // A long bar, bent until its ends lie in each other: its determinant is positive everywhere.
  const LatticeBox bar = box_of(2, 2, 60);
  const auto bent = [&](double degrees) { return proof_of(lattice_of(bar, {1, 1, 60}, {Bend{.degrees = degrees}})); };
  EXPECT_EQ(bent(300).refusal, "");
  EXPECT_GT(bent(400).least_determinant, 0);
  EXPECT_NE(bent(400).refusal.find("over each other"), std::string::npos);
}

TEST(Lattice, TheLeastDeterminantIsABound) {
  const LatticeBox box = box_of(16, 16, 16);
  const Lattice lattice = lattice_of(box, {4, 4, 4}, {RandomDisplacement{.amplitude = 0.3, .seed = 5}});
  const LatticeProof proof = proof_of(lattice);
  ASSERT_EQ(proof.refusal, "");
  double least = std::numeric_limits<double>::infinity();
  for (std::uint64_t i = 0; i < 20000; ++i) least = std::min(least, lattice.jacobian(place(box, i)).determinant());
  EXPECT_LE(proof.least_determinant, least);
  EXPECT_GT(proof.least_determinant, 0.4 * least);
}

TEST(Lattice, WhatIsNoLatticeIsRefused) {
  const LatticeBox box = box_of(4, 4, 4);
  auto points = undisplaced_points(box, {2, 2, 2}, Placement::greville);
  EXPECT_THROW(Lattice(box, {0, 2, 2}, points), InputError);
  EXPECT_THROW(Lattice(box, {2, 2, 3}, points), InputError);
  LatticeBox flat = box;
  flat.edges.col(2) = flat.edges.col(1);
  EXPECT_THROW(Lattice(flat, {2, 2, 2}, points), InputError);
  points[3][1] = std::nan("");
  EXPECT_THROW(Lattice(box, {2, 2, 2}, points), InputError);
}

}  // namespace
}  // namespace raytruth
