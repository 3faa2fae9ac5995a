#pragma once

#include "raytruth/cells/tetrahedral_field.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace raytruth {

/// What is drawn of a tetrahedron that is split into triangles around its thickest place in the picture, and is linear
/// in each of them.
enum class ProjectionRule {
  opacity,      ///< opacity and colour (Shirley and Tuchman 1990)
  exponential,  ///< mean extinction, length and colour, one exponential per pixel (Stein, Becker and Max 1994; VTK)
  table,        ///< scalars at front and back, and length; a slab made of these (Roettger, Kraus and Ertl 2000)
};

inline constexpr std::array<std::string_view, 3> projection_rule_names{"projected_opacity", "projected_exponential",
                                                                       "projected_table"};

/// In which order cells are drawn: as rays meet them, or by the distance of their centres along the view, as VTK does.
enum class CellOrder { exact, centre };

inline constexpr std::array<std::string_view, 2> cell_order_names{"exact", "centre"};

/// Rays of a picture of s x s pixels around the z axis, seen along -z from a height: parallel, or from that height.
struct ProjectedView {
  bool is_perspective = false;
  double height = 4;     ///< of the eye, or of where parallel rays begin
  double half_side = 1;  ///< of the picture in the plane z = 0
  std::int64_t size = 64;

  [[nodiscard]] Ray ray(std::int64_t column, std::int64_t row) const;
  /// Where a point is in the plane z = 0 of the picture.
  [[nodiscard]] std::array<double, 2> place(const std::array<double, 3>& point) const;
};

/// A corner of a triangle that is drawn.
struct ProjectedCorner {
  std::array<double, 2> place{};
  double front = 0;  ///< scalars
  double back = 0;
  double length = 0;
};

/// A tetrahedron as triangles from its thickest place to each edge of its outline.
struct ProjectedCell {
  int kind = 0;  ///< 1: a corner is inside the others' triangle; 2: a quadrilateral; 3, 4: an edge-on face, or two
  std::array<ProjectedCorner, 5> corners{};  ///< the thickest one first
  std::vector<std::array<std::size_t, 2>> edges;

  /// Front, back and length at a place, linear in the triangle that it is in, or next to.
  [[nodiscard]] ProjectedCorner at(const std::array<double, 2>& place, std::array<double, 5>& weights) const;
};

/// Orientations in the picture are signs of determinants, exactly.
ProjectedCell project(const TetrahedralMesh& mesh, std::uint32_t cell, const ProjectedView& view);

/// The slab of two scalars and a length: exact, or looked up.
using CellSlab = std::function<Rules<double>::vec4(double front, double back, double length)>;

/// RGBA of a pixel, cell by cell from front to back, associated emission. `slab`: of the rule `table`.
Rules<double>::vec4 projected_light(const TetrahedralField& field, const ProjectedView& view, std::int64_t column,
                                    std::int64_t row, const PiecewiseLinear& transfer, ProjectionRule rule,
                                    CellOrder order, const CellSlab& slab);

}  // namespace raytruth
