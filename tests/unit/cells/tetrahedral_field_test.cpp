#include "raytruth/cells/tetrahedral_field.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "unit/support/degenerate_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace raytruth {
namespace {

constexpr std::array<std::int64_t, 3> size{5, 6, 7};

Grid grid_of(double (*value)(std::int64_t, std::int64_t, std::int64_t)) {
  Grid grid{.size = size, .spacing = {1, 1, 1}, .values = {}};
  for (std::int64_t k = 0; k < size[2]; ++k)
    for (std::int64_t j = 0; j < size[1]; ++j)
      for (std::int64_t i = 0; i < size[0]; ++i) grid.values.push_back(value(i, j, k));
  return grid;
}

Grid linear_grid() {
  return grid_of([](std::int64_t i, std::int64_t j, std::int64_t k) {
    return (static_cast<double>(i) + 2 * static_cast<double>(j) + 3 * static_cast<double>(k)) / 64;
  });
}

Grid noisy_grid() {
  return grid_of([](std::int64_t i, std::int64_t j, std::int64_t k) {
    return random_numbers(3, RandomStream::field, static_cast<std::uint64_t>((k * 8 + j) * 8 + i))[0];
  });
}

struct Split {
  GridSplit split;
  SplitParity parity;
};

constexpr std::array splits{Split{GridSplit::five, SplitParity::even}, Split{GridSplit::five, SplitParity::odd},
                            Split{GridSplit::six, SplitParity::even}};

/// Rays in general directions, and such as run in faces, along edges, through points and on the mesh's border.
std::vector<Ray> rays() {
  std::vector<Ray> result = testing_support::degenerate_rays();
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto a = random_numbers(7, RandomStream::field, 2 * i);
    const auto b = random_numbers(7, RandomStream::field, 2 * i + 1);
    result.push_back({{9 * a[0] - 3, 9 * a[1] - 3, -2}, {b[0] - 0.5, b[1] - 0.5, 0.2 + a[2]}});
  }
  for (const std::array<double, 3>& direction : std::vector<std::array<double, 3>>{{1, 0, 0},
                                                                                   {0, -1, 0},
                                                                                   {0, 0, 1},
                                                                                   {1, 1, 0},
                                                                                   {1, 0, -1},
                                                                                   {0, 1, 1},
                                                                                   {1, 1, 1},
                                                                                   {1, -1, 1},
                                                                                   {-1, 1, 1},
                                                                                   {2, 1, 1},
                                                                                   {1, 2, 0}})
    for (const std::array<double, 3>& through : std::vector<std::array<double, 3>>{
             {2, 1, 3}, {2.5, 1.5, 2.5}, {2.5, 1, 3}, {0, 1, 2}, {0, 0, 2}, {4, 3, 5}, {2.25, 1.25, 3}})
      result.push_back(
          {{through[0] - 8 * direction[0], through[1] - 8 * direction[1], through[2] - 8 * direction[2]}, direction});
  return result;
}

PiecewiseLinear steep_transfer() {
  return PiecewiseLinear({{.s = 0, .optics = {0, {1, 0, 0}}},
                          {.s = 0.3, .optics = {4, {0, 1, 0.5}}},
                          {.s = 0.6, .optics = {0.5, {0, 0, 1}}}});
}

TEST(TetrahedralField, LinearDataMakeTheTrilinearFieldsRays) {
  const Grid grid = linear_grid();
  RayIntegral integrate(steep_transfer(), Emission::associated);
  for (const auto& [split, parity] : splits) {
    const TetrahedralField field(split_grid(grid, split, parity));
    std::size_t hits = 0;
    for (const Ray& ray : rays()) {
      const auto truth = trace_trilinear_precisely(grid, ray, {}, Border::voxel_centres);
      const MeshRay found = field.trace(ray);
      ASSERT_LE(found.parts.size(), 1U);
      const double gap = std::abs(static_cast<double>(found.signal.length - truth.length));
      EXPECT_LE(gap, found.signal.of_length + truth.of_length + 0x1p-95 * truth.length.high);
      // From afar sides of edges are differences of large products; where they hide a face they are exact.
      const double origin = std::hypot(ray.origin[0], ray.origin[1], ray.origin[2]);
      EXPECT_LT(found.signal.of_length, origin < 100 ? 1e-24 : 1e-15);
      if (found.signal.pieces.empty()) continue;
      ++hits;
      const auto [chain, error] = found.chain();
      const Certified of_mesh = integrate(chain, error);
      const Certified of_grid = integrate(truth);
      EXPECT_LE((of_mesh.color - of_grid.color).abs().maxCoeff(), of_mesh.radius + of_grid.radius);
      EXPECT_LE(std::abs(of_mesh.opacity - of_grid.opacity), of_mesh.radius + of_grid.radius);
      EXPECT_LT(of_mesh.radius, 1e-13);
      const Certified closer = integrate(found.signal);
      EXPECT_LE(std::abs(of_mesh.opacity - closer.opacity), of_mesh.radius + closer.radius);
    }
    EXPECT_GT(hits, 80U);
  }
}

TEST(TetrahedralField, PiecesMeetAndAgreeWithTheTrilinearFieldAtPointsAndEdges) {
  const Grid grid = noisy_grid();
  for (const auto& [split, parity] : splits) {
    const TetrahedralField field(split_grid(grid, split, parity));
    for (const Ray& ray : rays()) {
      const MeshRay found = field.trace(ray);
      const auto& pieces = found.signal.pieces;
      for (std::size_t i = 1; i < pieces.size(); ++i)
        EXPECT_EQ(pieces[i - 1].polynomial.coefficients[3], pieces[i].polynomial.coefficients[0]);
      EXPECT_EQ(std::accumulate(pieces.begin(), pieces.end(), DoubleDouble(),
                                [](DoubleDouble sum, const auto& piece) { return sum + piece.extent; }),
                found.signal.length);
    }
    const Ray along_edge{.origin = {-1, 2, 3}, .direction = {1, 0, 0}};
    const MeshRay found = field.trace(along_edge);
    ASSERT_EQ(found.signal.pieces.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(static_cast<double>(found.signal.pieces[i].polynomial.coefficients[0]),
                grid.at(static_cast<std::int64_t>(i), 2, 3));
  }
}

TetrahedralMesh two_cells() {
  return {.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
          .tetrahedra = {{0, 1, 2, 3}, {1, 3, 2, 4}},
          .scalars = {0, 1, 1, 1, 2},
          .cell_scalars = {},
          .places = {}};
}

void expect_refused(TetrahedralMesh mesh, const std::string& found) {
  try {
    complete(mesh);
    FAIL() << found;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(found), std::string::npos) << error.what();
  }
}

TEST(TetrahedralMesh, RefusesByTheNumberOfTheCell) {
  TetrahedralMesh good = two_cells();
  complete(good);
  TetrahedralMesh mesh = two_cells();
  mesh.tetrahedra[1] = {1, 2, 3, 7};
  expect_refused(mesh, "cell 1: found the point 7");
  mesh = two_cells();
  mesh.points[4] = {0.5, 0.25, 0.25};
  expect_refused(mesh, "cell 1: found a volume of zero");
  mesh = two_cells();
  mesh.points[4] = {0.25, 0.25, 0.25};
  expect_refused(mesh, "cell 1: found it folded over cell 0");
  mesh = two_cells();
  mesh.points.push_back({2, 2, 3});
  mesh.scalars.push_back(0);
  mesh.tetrahedra.push_back({1, 2, 3, 5});
  expect_refused(mesh, "cell 2: found a third cell");
  mesh = two_cells();
  mesh.points[0][1] = std::nan("");
  expect_refused(mesh, "point 0: found the coordinate nan");
  mesh = two_cells();
  mesh.scalars[3] = HUGE_VAL;
  expect_refused(mesh, "point 3: found the scalar inf");
  mesh = two_cells();
  mesh.scalars.pop_back();
  expect_refused(mesh, "found 4 scalars for 5 points");
}

TEST(TetrahedralField, CellsThatOverlapAreRefusedWhereARayMeetsThem) {
  TetrahedralMesh mesh = two_cells();
  mesh.tetrahedra = {{0, 1, 2, 3}, {5, 6, 7, 8}};
  for (std::size_t i = 0; i < 4; ++i) {
    auto point = mesh.points[i];
    for (double& x : point) x += 0.125;
    mesh.points.push_back(point);
    mesh.scalars.push_back(0);
  }
  complete(mesh);
  const TetrahedralField field(mesh);
  EXPECT_NO_THROW(static_cast<void>(field.trace({.origin = {-1, 0.01, 0.01}, .direction = {1, 0, 0}})));
  EXPECT_THROW(static_cast<void>(field.trace({.origin = {-1, 0.2, 0.2}, .direction = {1, 0, 0}})), InputError);
}

TEST(TetrahedralField, GapsAndBordersThatAreStatedTwice) {
  // Twice the same cell, the second one beyond a gap or at the first one's face with points of its own.
  for (const double shift : {1.0, 3.0}) {
    TetrahedralMesh mesh{.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                         .tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}},
                         .scalars = {},
                         .cell_scalars = {1, 2},
                         .places = {}};
    for (const std::array<double, 3>& point :
         std::vector<std::array<double, 3>>{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}})
      mesh.points.push_back(shift == 1 ? std::array<double, 3>{-point[0], point[1], point[2]}
                                       : std::array<double, 3>{point[0] - shift, point[1], point[2]});
    complete(mesh);
    const MeshRay ray = TetrahedralField(mesh).trace({.origin = {-5, 0.25, 0.25}, .direction = {1, 0, 0}});
    ASSERT_EQ(ray.signal.pieces.size(), 2U);
    EXPECT_EQ(ray.cells, (std::vector<std::uint32_t>{1, 0}));
    EXPECT_EQ(static_cast<double>(ray.signal.length), 1.0);
    EXPECT_EQ(ray.parts.size(), shift == 1 ? 1U : 2U);
    EXPECT_EQ(static_cast<double>(ray.parts.back().to), shift == 1 ? 1.0 : 3.5);
    EXPECT_EQ(ray.signal.pieces[0].polynomial.coefficients[0], DoubleDouble(2.0));
    EXPECT_EQ(ray.signal.pieces[1].polynomial.coefficients[3], DoubleDouble(1.0));
  }
}

TEST(TetrahedralField, OriginsInsideAndLengths) {
  TetrahedralMesh mesh = two_cells();
  complete(mesh);
  const TetrahedralField field(mesh);
  const MeshRay ray = field.trace({.origin = {0.125, 0.125, 0.125}, .direction = {2, 2, 2}, .length = 1});
  // The scalar is x + y + z up to the common face, and there it is 1.
  EXPECT_NEAR(static_cast<double>(ray.signal.pieces[0].polynomial.coefficients[0]), 0.375, 1e-15);
  EXPECT_NEAR(static_cast<double>(ray.signal.pieces[0].polynomial.coefficients[3]), 1, 1e-15);
  EXPECT_EQ(static_cast<double>(ray.signal.length), 1);
}

}  // namespace
}  // namespace raytruth
