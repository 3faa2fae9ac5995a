#include "raytruth/cells/projected_tetrahedra.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/tables/cell_table.hpp"

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
    const CellTable table = exact_cell_table(transfer, axes, Emission::associated, axis, distances);
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
