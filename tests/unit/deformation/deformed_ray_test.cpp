#include "raytruth/deformation/deformed_ray.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/deformation/deformed_light.hpp"
#include "raytruth/deformation/displacement.hpp"
#include "raytruth/deformation/lattice_proof.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/signals/trilinear_value.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {
namespace {

constexpr std::int64_t size = 24;
constexpr std::int64_t lattice_cells = 3;  // a spacing of 8 voxels

Grid noise() {
  Grid grid{.size = {size, size, size}, .values = {}};
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(size * size * size); ++i)
    grid.values.push_back(random_numbers(5, RandomStream::field, i)[0]);
  return grid;
}

LatticeBox box() { return {.origin = Eigen::Vector3d::Constant(-0.5), .edges = Eigen::Matrix3d::Identity() * size}; }

Lattice lattice_of(const std::vector<Displacement>& displacements) {
  const std::array<std::int64_t, 3> cells{lattice_cells, lattice_cells, lattice_cells};
  auto points = undisplaced_points(box(), cells, Placement::greville);
  displace(box(), cells, displacements, points);
  return {box(), cells, points};
}

/// A ray from afar through the middle part of the box.
Ray ray_of(std::uint64_t i) {
  const auto through = random_numbers(11, RandomStream::rays, i);
  const auto along = random_numbers(12, RandomStream::rays, i);
  Ray ray;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    ray.direction[axis] = along[axis] - 0.5;
    ray.origin[axis] = static_cast<double>(size) * (0.2 + 0.6 * through[axis]) - 100 * ray.direction[axis];
  }
  return ray;
}

const PiecewiseLinear& transfer() {
  static const PiecewiseLinear result({{0, {0.0, {0, 0, 0}}}, {1, {0.3, {1, 0.5, 0.2}}}});
  return result;
}

Certified light_of(const DeformedSignal& signal) { return DeformedLight(transfer(), Emission::associated)(signal); }

/// The depth along a ray in the world, by Gauss quadrature between all borders that Newton's inverse passes; nothing of
/// it knows of arcs.
class DepthByInverse {
 public:
  DepthByInverse(const Grid& grid, const Lattice& lattice, const Ray& ray)
      : grid_(grid), lattice_(lattice), origin_(ray.origin.data()), direction_(unit_direction(ray.direction).data()) {}

  double operator()() {
    const FaceCrossings crossings = LatticeFaces(lattice_)(RayEquations(origin_, direction_, false));
    double depth = 0;
    for (std::size_t i = 0; i + 1 < crossings.found.size(); i += 2)
      depth += between(crossings.found[i], crossings.found[i + 1]);
    return depth;
  }

 private:
  Eigen::Vector3d inverse(double t, Eigen::Vector3d object) const {
    for (int i = 0; i < 30; ++i) {
      const Eigen::Vector3d step = lattice_.jacobian(object).inverse() * (lattice_(object) - origin_ - t * direction_);
      object -= step;
      if (step.norm() < 1e-14) break;
    }
    return object;
  }

  static std::array<double, 6> cells_of(const Eigen::Vector3d& object) {
    std::array<double, 6> cells{};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      cells[static_cast<std::size_t>(axis)] = std::floor(object[axis]);
      cells[static_cast<std::size_t>(axis) + 3] = std::floor((object[axis] + 0.5) * lattice_cells / size);
    }
    return cells;
  }

  double between(const FaceCrossing& entry, const FaceCrossing& exit) {
    constexpr int steps = 1500;
    std::vector<double> breaks{entry.t, exit.t};
    const Eigen::Vector3d first = lattice_.object_of(entry.place);
    Eigen::Vector3d before = first;
    double t_before = entry.t;
    for (int i = 1; i <= steps; ++i) {
      const double t = entry.t + (exit.t - entry.t) * i / steps;
      const Eigen::Vector3d here = inverse(t, before);
      const auto cells_before = cells_of(before);
      const auto cells_here = cells_of(here);
      for (std::size_t k = 0; k < 6; ++k) {
        if (cells_before[k] == cells_here[k]) continue;
        double low = t_before;
        double high = t;
        for (int halving = 0; halving < 50; ++halving) {
          const double middle = (low + high) / 2;
          (cells_of(inverse(middle, before))[k] == cells_before[k] ? low : high) = middle;
        }
        breaks.push_back(low);
      }
      before = here;
      t_before = t;
    }
    std::sort(breaks.begin(), breaks.end());
    Eigen::Vector3d object = first;
    double depth = 0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      if (breaks[i] == breaks[i + 1]) continue;
      depth += boost::math::quadrature::gauss<double, 10>::integrate(
          [&](double t) {
            object = inverse(t, object);
            const double s = trilinear_value<double>(grid_, {object[0], object[1], object[2]});
            return 0.3 * s / lattice_.jacobian(object).determinant();
          },
          breaks[i], breaks[i + 1]);
    }
    return depth;
  }

  const Grid& grid_;
  const Lattice& lattice_;
  Eigen::Vector3d origin_;
  Eigen::Vector3d direction_;
};

DeformedSignal trace(const Grid& grid, const Lattice& lattice, const Ray& ray) {
  const DeformedVolume volume(grid, Border::half_voxel, {1, 1, 1}, lattice, proof_of(lattice).least_determinant);
  DeformedSignal signal;
  volume.trace(ray, signal);
  EXPECT_TRUE(signal.is_certified);
  return signal;
}

TEST(DeformedRay, AnUndisplacedLatticeIsTheStraightRay) {
  const Grid grid = noise();
  const Lattice lattice = lattice_of({});
  for (std::uint64_t i = 0; i < 30; ++i) {
    const DeformedSignal signal = trace(grid, lattice, ray_of(i));
    const Chain<3> straight = trace_trilinear(grid, ray_of(i));
    EXPECT_NEAR(signal.chain.length(), straight.length(), 1e-12);
    const Certified deformed = light_of(signal);
    const Certified truth = RayIntegral(transfer(), Emission::associated)(straight);
    EXPECT_LT(std::abs(deformed.opacity - truth.opacity), deformed.radius + truth.radius);
    EXPECT_LT((deformed.color - truth.color).abs().maxCoeff(), deformed.radius + truth.radius);
    EXPECT_LT(deformed.radius, 1e-9);
  }
}

TEST(DeformedRay, AnAffineLatticeIsTheRayThatIsMappedBack) {
  const Grid grid = noise();
  Affine affine;
  affine.matrix << 1.2, 0.2, 0, -0.3, 0.9, 0.2, 0.1, 0, 1.1;
  affine.offset = {2, -1, 0.5};
  const Lattice lattice = lattice_of({affine});
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant((size - 1) / 2.0);
  const Eigen::Matrix3d back = affine.matrix.inverse();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Ray ray = ray_of(i);
    const auto unit = unit_direction(ray.direction);
    const Eigen::Vector3d origin = centre + back * (Eigen::Vector3d(ray.origin.data()) - centre - affine.offset);
    const Eigen::Vector3d direction = back * Eigen::Vector3d(unit.data());
    Chain<3> straight =
        trace_trilinear(grid, {{origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]}});
    // d sigma = dt / J, and the object is passed |back d| times as fast as the world.
    for (auto& piece : straight.pieces) {
      const double factor = 1 / (direction.norm() * affine.matrix.determinant());
      piece.start = piece.start * factor;
      piece.length *= factor;
    }
    straight.end = straight.end * (1 / (direction.norm() * affine.matrix.determinant()));
    const DeformedSignal signal = trace(grid, lattice, ray);
    const Certified deformed = light_of(signal);
    const Certified truth = RayIntegral(transfer(), Emission::associated)(straight);
    EXPECT_LT(std::abs(deformed.opacity - truth.opacity), deformed.radius + 1e-13);
    EXPECT_LT((deformed.color - truth.color).abs().maxCoeff(), deformed.radius + 1e-13);
  }
}

TEST(DeformedRay, BoundsHoldAgainstTheInverse) {
  const Grid grid = noise();
  for (const double amplitude : {0.1, 0.4}) {
    const Lattice lattice = lattice_of({RandomDisplacement{.amplitude = amplitude, .seed = 9}});
    int met = 0;
    for (std::uint64_t i = 0; i < 10; ++i) {
      const Ray ray = ray_of(i);
      const DeformedSignal signal = trace(grid, lattice, ray);
      const double truth = -std::expm1(-DepthByInverse(grid, lattice, ray)());
      const Certified light = light_of(signal);
      EXPECT_LT(std::abs(light.opacity - truth), light.radius + 1e-13) << amplitude << " " << i;
      EXPECT_LT(light.radius, 1e-9);
      met += truth > 0.5 ? 1 : 0;
    }
    EXPECT_GE(met, 8);
  }
}

TEST(DeformedRay, ARayBesideTheObjectMeetsNothing) {
  const Grid grid = noise();
  const Lattice lattice = lattice_of({RandomDisplacement{.amplitude = 0.3, .seed = 9}});
  const DeformedSignal signal = trace(grid, lattice, {.origin = {-100, 60, 12}, .direction = {1, 0, 0}});
  EXPECT_TRUE(signal.chain.pieces.empty());
  EXPECT_EQ(signal.error.unclaimed, 0);
}

TEST(DeformedRay, ARayMayBeginInside) {
  const Grid grid = noise();
  const Lattice lattice = lattice_of({RandomDisplacement{.amplitude = 0.3, .seed = 9}});
  for (std::uint64_t i = 0; i < 5; ++i) {
    Ray ray = ray_of(i);
    const double whole = 1 - light_of(trace(grid, lattice, ray)).opacity;
    for (std::size_t axis = 0; axis < 3; ++axis) ray.origin[axis] += 100 * ray.direction[axis];
    const double onwards = 1 - light_of(trace(grid, lattice, ray)).opacity;
    for (double& component : ray.direction) component = -component;
    const double back = 1 - light_of(trace(grid, lattice, ray)).opacity;
    EXPECT_LT(onwards, 0.9);
    EXPECT_LT(back, 0.9);
    EXPECT_NEAR(onwards * back, whole, 1e-11);
  }
}

TEST(DeformedRay, ALargerLatticeShowsTheVolumeAlone) {
  const Grid grid = noise();
  const LatticeBox large{.origin = Eigen::Vector3d::Constant(-4.5), .edges = Eigen::Matrix3d::Identity() * (size + 10)};
  const std::array<std::int64_t, 3> cells{3, 4, 5};
  const Lattice lattice(large, cells, undisplaced_points(large, cells, Placement::greville));
  for (std::uint64_t i = 0; i < 10; ++i) {
    const DeformedSignal signal = trace(grid, lattice, ray_of(i));
    const Certified deformed = light_of(signal);
    const Certified truth = RayIntegral(transfer(), Emission::associated)(trace_trilinear(grid, ray_of(i)));
    EXPECT_LT(std::abs(deformed.opacity - truth.opacity), deformed.radius + truth.radius);
  }
}

}  // namespace
}  // namespace raytruth
