#include "raytruth/cells/cell_table.hpp"
#include "raytruth/cells/projected_tetrahedra.hpp"
#include "raytruth/reference/ray_integral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace raytruth {
namespace {

PiecewiseLinear jumping_transfer() {
  return PiecewiseLinear({{.s = 0, .optics = {1, {1, 0, 0}}},
                          {.s = 0.5, .optics = {3, {0, 1, 0.5}}},
                          {.s = 0.5, .optics = {0.5, {0, 1, 1}}},
                          {.s = 1, .optics = {1.5, {0, 0, 1}}}});
}

TEST(CellTable, MeanExtinctionsAreClosedForms) {
  const PiecewiseLinear transfer = jumping_transfer();
  EXPECT_DOUBLE_EQ(mean_extinction(transfer, 0, 1), (0.5 * 2 + 0.5 * 1));
  EXPECT_DOUBLE_EQ(mean_extinction(transfer, 1, 0), mean_extinction(transfer, 0, 1));
  EXPECT_DOUBLE_EQ(mean_extinction(transfer, 0.25, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(mean_extinction(transfer, 0.5, 1), 1);
  EXPECT_DOUBLE_EQ(mean_extinction(transfer, 0.5, 0.5), 0.5);
  EXPECT_DOUBLE_EQ(mean_extinction(transfer, -1, 0.25), (1 * 1 + 0.25 * 1.5) / 1.25);
}

TEST(CellTable, EntriesAndOpacitiesWithoutAnAxisAreExact) {
  const PiecewiseLinear transfer = jumping_transfer();
  RayIntegral integrate(transfer, Emission::associated);
  const TableAxes axes{.size = 9, .low = 0, .high = 1, .length = 1};
  for (const auto axis : {CellTableAxis::uniform, CellTableAxis::powers_of_two_log, CellTableAxis::mean_depth}) {
    const auto distances = cell_table_distances(axis, 5, 2);
    const CellTable table = cell_table(transfer, axes, Emission::associated, axis, distances);
    for (const double front : {0.125, 0.25, 0.75})
      for (const double back : {0.125, 0.625, 1.0})
        for (const double length : {0.25, 0.5, 1.0, 2.0, 1.5}) {
          const bool is_node = std::find(distances.begin(), distances.end(), length) != distances.end();
          if (!is_node && axis != CellTableAxis::mean_depth) continue;
          Chain<3> chain;
          const double step = (back - front) / 3;
          chain.pieces = {{0.0, length, {{front, front + step, back - step, back}}}};
          chain.end = length;
          const Certified truth = integrate(chain);
          const auto found = look_up(table, front, back, length);
          EXPECT_NEAR(found[3], truth.opacity, 1e-14);
          if (!is_node) continue;
          EXPECT_LT((found.head<3>() - truth.color).abs().maxCoeff(), 1e-13);
        }
  }
}

/// The largest difference of a table's slabs from exact ones, at scalars that are entries.
double largest_error(const CellTable& table, const PiecewiseLinear& transfer, const std::vector<double>& lengths) {
  RayIntegral integrate(transfer, Emission::associated);
  double largest = 0;
  for (const double front : {0.125, 0.25, 0.75})
    for (const double back : {0.375, 0.625, 1.0})
      for (const double length : lengths) {
        Chain<3> chain;
        const double step = (back - front) / 3;
        chain.pieces = {{0.0, length, {{front, front + step, back - step, back}}}};
        chain.end = length;
        const Certified truth = integrate(chain);
        const auto found = look_up(table, front, back, length);
        largest =
            std::max({largest, std::abs(found[3] - truth.opacity), (found.head<3>() - truth.color).abs().maxCoeff()});
      }
  return largest;
}

TEST(CellTable, AppendedSlabsOfOneSlopeAreExactAtTheirDistances) {
  const PiecewiseLinear transfer = jumping_transfer();
  const TableAxes axes{.size = 9, .low = 0, .high = 1, .length = 1};
  const auto distances = cell_table_distances(CellTableAxis::slope, 33, 2);
  const CellTable table = cell_table(transfer, axes, Emission::associated, CellTableAxis::slope, distances);
  RayIntegral integrate(transfer, Emission::associated);
  for (const std::size_t k : {std::size_t{5}, std::size_t{15}, std::size_t{20}}) {
    const double length = distances[k] * 0.5;  // from 0.125 to 0.625
    Chain<3> chain;
    chain.pieces = {{0.0, length, {{0.125, 0.125 + 0.5 / 3, 0.625 - 0.5 / 3, 0.625}}}};
    chain.end = length;
    const Certified truth = integrate(chain);
    const auto found = look_up(table, 0.125, 0.625, length);
    EXPECT_NEAR(found[3], truth.opacity, 1e-13);
    EXPECT_LT((found.head<3>() - truth.color).abs().maxCoeff(), 1e-12);
  }
  // In between, colour over opacity is a line; more distances bring it nearer, twice as many four times.
  const std::vector<double> lengths{0.3, 0.7, 1.1};
  const auto error = [&](std::size_t count) {
    return largest_error(cell_table(transfer, axes, Emission::associated, CellTableAxis::slope,
                                    cell_table_distances(CellTableAxis::slope, count, 2)),
                         transfer, lengths);
  };
  EXPECT_LT(error(129), error(33) / 4);
  EXPECT_LT(error(33), 0.01);
  // A slab of one scalar is homogeneous.
  const auto flat = look_up(table, 0.25, 0.25, 1);
  EXPECT_NEAR(flat[3], -std::expm1(-2.0), 1e-12);
  EXPECT_NEAR(flat[0], -0.5 * std::expm1(-2.0), 1e-5);
}

TEST(CellTable, EntriesOfOtherRules) {
  const PiecewiseLinear transfer = jumping_transfer();
  const TableAxes axes{.size = 65, .low = 0, .high = 1, .length = 1};
  const auto distances = cell_table_distances(CellTableAxis::uniform, 8, 2);
  const auto made = [&](CellTableEntries entries) {
    return cell_table(transfer, axes, Emission::associated, CellTableAxis::uniform, distances, entries);
  };
  const CellTable brute_force = made(CellTableEntries::brute_force);
  const CellTable subrange = made(CellTableEntries::subrange);
  for (std::size_t k = 0; k < distances.size(); ++k)
    for (std::size_t i = 0; i < brute_force.slices[k].values.size(); ++i)
      EXPECT_NEAR(brute_force.slices[k].values[i], subrange.slices[k].values[i], 1e-13);
  const std::vector<double> nodes{distances[1], distances[4], distances[7]};
  EXPECT_LT(largest_error(brute_force, transfer, nodes), 0.01);
  // Step by step from nearest entries errors add up; from two steps on nothing is exact.
  const CellTable incremental = made(CellTableEntries::incremental);
  EXPECT_LT(largest_error(incremental, transfer, {distances[1]}), 1e-13);
  EXPECT_GT(largest_error(incremental, transfer, {2.0}), 1e-4);
  EXPECT_LT(largest_error(incremental, transfer, nodes), 0.05);
  // Where the scalar does not matter, steps are exact.
  const PiecewiseLinear constant({{.s = 0, .optics = {2, {1, 0.5, 0.25}}}, {.s = 1, .optics = {2, {1, 0.5, 0.25}}}});
  const CellTable steps = cell_table(constant, axes, Emission::associated, CellTableAxis::uniform, distances,
                                     CellTableEntries::incremental);
  EXPECT_LT(largest_error(steps, constant, nodes), 1e-13);
  EXPECT_THROW(cell_table(transfer, axes, Emission::associated, CellTableAxis::mean_depth, distances,
                          CellTableEntries::incremental),
               InputError);
}

/// A cell whose vertices stand in any order.
TetrahedralField field_of(std::vector<std::array<double, 3>> points, const std::array<std::uint32_t, 4>& order) {
  TetrahedralMesh mesh{.points = std::move(points),
                       .tetrahedra = {order},
                       .scalars = {0, 0.25, 0.75, 1},
                       .cell_scalars = {},
                       .places = {}};
  complete(mesh);
  return TetrahedralField(std::move(mesh));
}

TEST(ProjectedTetrahedra, ParallelLengthsAndScalarsAreTheRaysWhateverTheOrderOfVertices) {
  struct Case {
    std::vector<std::array<double, 3>> points;
    int kind;
  };
  for (const auto& [points, kind] :
       std::vector<Case>{{{{-1, 0, 0.5}, {1, 0, 0.5}, {0, -1, -0.5}, {0, 1, -0.5}}, 2},
                         {{{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, 1},
                         {{{0, -1, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, 3},
                         {{{-1, -1, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, 4},
                         {{{0.3, -0.9, 0.25}, {0.8, 0.2, -0.5}, {-0.7, 0.1, 0.125}, {0.1, 0.9, 0.75}}, 2}}) {
    std::array<std::uint32_t, 4> order{0, 1, 2, 3};
    do {
      const TetrahedralField field = field_of(points, order);
      const ProjectedView view{.size = 24};
      const ProjectedCell cell = project(field.mesh(), 0, view);
      EXPECT_EQ(cell.kind, kind);
      int met = 0;
      for (std::int64_t i = 0; i < view.size * view.size; ++i) {
        const Ray ray = view.ray(i % view.size, i / view.size);
        const MeshRay truth = field.trace(ray);
        if (truth.signal.pieces.empty()) continue;
        ++met;
        std::array<double, 5> weights{};
        const ProjectedCorner here = cell.at({ray.origin[0], ray.origin[1]}, weights);
        const auto& piece = truth.signal.pieces[0];
        EXPECT_NEAR(here.length, piece.length, 1e-13);
        EXPECT_NEAR(here.front, static_cast<double>(piece.polynomial.coefficients[0]), 1e-13);
        EXPECT_NEAR(here.back, static_cast<double>(piece.polynomial.coefficients[3]), 1e-13);
      }
      EXPECT_GT(met, 100);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(ProjectedTetrahedra, InPerspectiveTheLengthIsOff) {
  const TetrahedralField field = field_of({{-1, 0, 0.5}, {1, 0, 0.5}, {0, -1, -0.5}, {0, 1, -0.5}}, {0, 1, 2, 3});
  const ProjectedView view{.is_perspective = true, .size = 32};
  const ProjectedCell cell = project(field.mesh(), 0, view);
  double worst = 0;
  for (std::int64_t i = 0; i < view.size * view.size; ++i) {
    const Ray ray = view.ray(i % view.size, i / view.size);
    const MeshRay truth = field.trace(ray);
    if (truth.signal.pieces.empty()) continue;
    std::array<double, 5> weights{};
    worst = std::max(
        worst, std::abs(cell.at({ray.direction[0], ray.direction[1]}, weights).length - truth.signal.pieces[0].length));
  }
  EXPECT_GT(worst, 1e-3);
  EXPECT_LT(worst, 0.2);
}

}  // namespace
}  // namespace raytruth
