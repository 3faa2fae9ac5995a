#include "raytruth/cells/tetrahedral_mesh.hpp"

#include "raytruth/cells/exact_determinant.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace raytruth {

namespace {

/// Products of three coordinates and a scalar's difference stay within binary64.
constexpr double largest_coordinate = 0x1p250;

using Corners = std::array<std::uint32_t, 4>;

/// -1, 0 or 1: how the tetrahedron is oriented, exactly.
int orientation(const TetrahedralMesh& mesh, const Corners& corners) {
  const auto& origin = mesh.points[corners[0]];
  const auto in_106_bits = [&](std::size_t k) { return difference(mesh.points[corners[k]], origin); };
  const int sign = determinant(in_106_bits(1), in_106_bits(2), in_106_bits(3)).sign();
  if (sign != 0) return sign;
  const auto exact = [&](std::size_t k) { return exact_difference(mesh.points[corners[k]], origin); };
  return determinant(exact(1), exact(2), exact(3)).sign();
}

void check_numbers(const TetrahedralMesh& mesh) {
  if (mesh.tetrahedra.empty()) throw InputError("found no tetrahedra; at least one is allowed");
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    for (const double x : mesh.points[i])
      if (!(std::abs(x) <= largest_coordinate))
        throw InputError(fmt::format("point {}: found the coordinate {}; finite ones up to 2^250 are allowed", i, x));
  const bool is_of_cells = mesh.scalars.empty();
  const auto& scalars = is_of_cells ? mesh.cell_scalars : mesh.scalars;
  const std::size_t count = is_of_cells ? mesh.tetrahedra.size() : mesh.points.size();
  const std::string_view what = is_of_cells ? "cell" : "point";
  if (scalars.size() != count)
    throw InputError(
        fmt::format("found {} scalars for {} {}s; one for each {} is allowed", scalars.size(), count, what, what));
  for (std::size_t i = 0; i < scalars.size(); ++i)
    if (!(std::abs(scalars[i]) <= std::numeric_limits<double>::max() / 16))
      throw InputError(
          fmt::format("{} {}: found the scalar {}; finite ones up to 2^1020 are allowed", what, i, scalars[i]));
}

void orient(TetrahedralMesh& mesh) {
  for (std::size_t cell = 0; cell < mesh.tetrahedra.size(); ++cell) {
    Corners& corners = mesh.tetrahedra[cell];
    for (const std::uint32_t point : corners)
      if (point >= mesh.points.size())
        throw InputError(fmt::format("cell {}: found the point {}; 0 to {} are allowed", cell, point,
                                     static_cast<std::int64_t>(mesh.points.size()) - 1));
    const int sign = orientation(mesh, corners);
    if (sign == 0)
      throw InputError(
          fmt::format("cell {}: found a volume of zero; four points that lie in no plane are allowed", cell));
    if (sign < 0) std::swap(corners[2], corners[3]);
  }
}

void find_places(TetrahedralMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&mesh](std::uint32_t a, std::uint32_t b) {
    return std::tie(mesh.points[a], a) < std::tie(mesh.points[b], b);
  });
  mesh.places.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    mesh.places[order[i]] =
        i > 0 && mesh.points[order[i]] == mesh.points[order[i - 1]] ? mesh.places[order[i - 1]] : order[i];
}

/// A face by its places, ascending; which way round the cell has it.
struct Face {
  std::array<std::uint32_t, 3> places;
  std::uint32_t cell;
  bool is_odd;
};

void check_faces(const TetrahedralMesh& mesh) {
  constexpr std::array<std::array<std::size_t, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (std::size_t cell = 0; cell < mesh.tetrahedra.size(); ++cell) {
    for (const auto& corners : outward) {
      Face face{.places = {}, .cell = static_cast<std::uint32_t>(cell), .is_odd = false};
      for (std::size_t k = 0; k < 3; ++k) face.places[k] = mesh.places[mesh.tetrahedra[cell][corners[k]]];
      for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {0, 1}}) {
        if (face.places[a] < face.places[b]) continue;
        std::swap(face.places[a], face.places[b]);
        face.is_odd = !face.is_odd;
      }
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return std::tie(a.places, a.cell) < std::tie(b.places, b.cell); });
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].places != faces[i - 1].places) continue;
    const auto& [a, b, c] = faces[i].places;
    if (i > 1 && faces[i].places == faces[i - 2].places)
      throw InputError(
          fmt::format("cell {}: found a third cell at the face of points {}, {}, {}; two are allowed, here "
                      "cells {} and {} have it",
                      faces[i].cell, a, b, c, faces[i - 2].cell, faces[i - 1].cell));
    if (faces[i].is_odd == faces[i - 1].is_odd)
      throw InputError(
          fmt::format("cell {}: found it folded over cell {}, on the same side of their face of points {}, "
                      "{}, {}; cells on both sides are allowed",
                      faces[i].cell, faces[i - 1].cell, a, b, c));
  }
}

using Cube = std::vector<std::array<unsigned, 4>>;

const Cube& tetrahedra_of_cube(GridSplit split, bool is_even) {
  static const Cube even{{0, 3, 5, 6}, {1, 0, 5, 3}, {2, 0, 3, 6}, {4, 0, 6, 5}, {7, 3, 5, 6}};
  static const Cube odd{{1, 2, 4, 7}, {0, 1, 2, 4}, {3, 1, 7, 2}, {5, 1, 4, 7}, {6, 2, 7, 4}};
  static const Cube six{{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
  if (split == GridSplit::six) return six;
  return is_even ? even : odd;
}

}  // namespace

void complete(TetrahedralMesh& mesh) {
  check_numbers(mesh);
  orient(mesh);
  find_places(mesh);
  check_faces(mesh);
}

TetrahedralMesh split_grid(const Grid& grid, GridSplit split, SplitParity parity) {
  const auto [nx, ny, nz] = grid.size;
  if (std::min({nx, ny, nz}) < 2)
    throw InputError(
        fmt::format("found {} x {} x {} voxels; at least two along each axis are allowed, for tetrahedra "
                    "lie between voxel centres",
                    nx, ny, nz));
  if (grid.values.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError(fmt::format("found {} voxels; up to 2^32 - 1 are allowed", grid.values.size()));
  const auto cubes = static_cast<std::uint64_t>((nx - 1) * (ny - 1) * (nz - 1));
  // A tetrahedron has its indices, and its share of the tree in which rays look for it.
  need_memory(cubes * static_cast<std::uint64_t>(split) * 48 + grid.values.size() * 40, "a grid split into tetrahedra");
  TetrahedralMesh mesh;
  mesh.scalars = grid.values;
  mesh.points.reserve(grid.values.size());
  for (std::int64_t k = 0; k < nz; ++k)
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i)
        mesh.points.push_back({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
  mesh.places.resize(mesh.points.size());
  std::iota(mesh.places.begin(), mesh.places.end(), 0U);
  mesh.tetrahedra.reserve(cubes * static_cast<std::size_t>(split));
  for (std::int64_t k = 0; k + 1 < nz; ++k) {
    for (std::int64_t j = 0; j + 1 < ny; ++j) {
      for (std::int64_t i = 0; i + 1 < nx; ++i) {
        const bool is_even = ((i + j + k) % 2 == 0) == (parity == SplitParity::even);
        for (const auto& corners : tetrahedra_of_cube(split, is_even)) {
          Corners& tetrahedron = mesh.tetrahedra.emplace_back();
          for (std::size_t c = 0; c < 4; ++c)
            tetrahedron[c] = static_cast<std::uint32_t>(
                grid.index(i + (corners[c] & 1U), j + (corners[c] >> 1U & 1U), k + (corners[c] >> 2U)));
        }
      }
    }
  }
  orient(mesh);
  return mesh;
}

}  // namespace raytruth
