#include "raytruth/cells/projected_tetrahedra.hpp"

#include "raytruth/cells/exact_determinant.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

using Point = std::array<double, 3>;
using Vec4 = Rules<double>::vec4;

constexpr std::array<std::array<std::size_t, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// det of a line of sight and two differences: which way round three points are in the picture.
Determinant seen(const ProjectedView& view, const Point& a, const Point& b, const Point& c) {
  const Point eye{0, 0, view.height};
  const Vector106 sight = view.is_perspective ? difference(a, eye) : Vector106{0.0, 0.0, -1.0};
  return determinant(sight, difference(b, a), difference(c, a));
}

int seen_sign(const ProjectedView& view, const Point& a, const Point& b, const Point& c) {
  const int sign = seen(view, a, b, c).sign();
  if (sign != 0) return sign;
  const Point eye{0, 0, view.height};
  const ExactVector sight = view.is_perspective ? exact_difference(a, eye) : ExactVector{0, 0, -1};
  return determinant(sight, exact_difference(b, a), exact_difference(c, a)).sign();
}

double seen_area(const ProjectedView& view, const Point& a, const Point& b, const Point& c) {
  return static_cast<double>(seen(view, a, b, c).value);
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// The thickest place, whose line of sight meets the cell in two points with these scalars.
ProjectedCorner thickest(const ProjectedView& view, const Point& a, double at_a, const Point& b, double at_b) {
  const Point eye{0, 0, view.height};
  const bool is_a_in_front = view.is_perspective ? distance(a, eye) <= distance(b, eye) : a[2] >= b[2];
  return {.place = view.place(a),
          .front = is_a_in_front ? at_a : at_b,
          .back = is_a_in_front ? at_b : at_a,
          .length = distance(a, b)};
}

double cross(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// A point between two, and the scalar there.
struct Between {
  Point point{};
  double scalar = 0;
};

Between between(const Point& a, double at_a, const Point& b, double at_b, double share) {
  Between result{.point = {}, .scalar = at_a + share * (at_b - at_a)};
  for (std::size_t axis = 0; axis < 3; ++axis) result.point[axis] = a[axis] + share * (b[axis] - a[axis]);
  return result;
}

}  // namespace

Ray ProjectedView::ray(std::int64_t column, std::int64_t row) const {
  const auto at = [this](std::int64_t pixel) {
    return half_side * ((2 * static_cast<double>(pixel) + 1) / static_cast<double>(size) - 1);
  };
  const double x = at(column);
  const double y = -at(row);
  if (is_perspective) return {.origin = {0, 0, height}, .direction = {x, y, -height}};
  return {.origin = {x, y, height}, .direction = {0, 0, -1}};
}

std::array<double, 2> ProjectedView::place(const Point& point) const {
  const double scale = is_perspective ? height / (height - point[2]) : 1;
  return {point[0] * scale, point[1] * scale};
}

ProjectedCorner ProjectedCell::at(const std::array<double, 2>& place, std::array<double, 5>& weights) const {
  weights.fill(0);
  double best = -std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : edges) {
    const double area = cross(corners[0].place, corners[a].place, corners[b].place);
    if (area == 0) continue;
    const double of_a = cross(corners[0].place, place, corners[b].place) / area;
    const double of_b = cross(corners[0].place, corners[a].place, place) / area;
    const double least = std::min({of_a, of_b, 1 - of_a - of_b});
    if (!(least > best)) continue;
    best = least;
    weights.fill(0);
    weights[0] = 1 - of_a - of_b;
    weights[a] = of_a;
    weights[b] = of_b;
  }
  ProjectedCorner result{.place = place};
  for (std::size_t k = 0; k < 5; ++k) {
    // Rounding may put a place next to a triangle just outside of all.
    result.front += weights[k] * corners[k].front;
    result.back += weights[k] * corners[k].back;
    result.length += std::max(0.0, weights[k]) * corners[k].length;
  }
  return result;
}

ProjectedCell project(const TetrahedralMesh& mesh, std::uint32_t cell, const ProjectedView& view) {
  std::array<Point, 4> points;
  std::array<double, 4> scalars{};
  std::array<int, 4> signs{};  ///< of the faces opposite to the corners
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t corner = mesh.tetrahedra[cell][k];
    points[k] = mesh.points[corner];
    scalars[k] = mesh.scalars.empty() ? mesh.cell_scalars[cell] : mesh.scalars[corner];
  }
  for (std::size_t k = 0; k < 4; ++k)
    signs[k] = seen_sign(view, points[outward[k][0]], points[outward[k][1]], points[outward[k][2]]);
  const auto count = [&signs](int sign) { return std::count(signs.begin(), signs.end(), sign); };
  const auto find = [&signs](int sign) {
    return static_cast<std::size_t>(std::find(signs.begin(), signs.end(), sign) - signs.begin());
  };
  ProjectedCell result;
  for (std::size_t k = 0; k < 4; ++k)
    result.corners[k + 1] = {.place = view.place(points[k]), .front = scalars[k], .back = scalars[k], .length = 0};
  if (count(1) == 2 && count(-1) == 2) {
    // Two faces in front share one diagonal of the outline, those behind the other one.
    result.kind = 2;
    std::array<std::size_t, 2> first{};
    std::array<std::size_t, 2> second{};
    std::size_t firsts = 0;
    std::size_t seconds = 0;
    for (std::size_t k = 0; k < 4; ++k) (signs[k] > 0 ? first[firsts++] : second[seconds++]) = k;
    const auto [i, j] = first;
    const auto [k, l] = second;
    // By faces: seen from a point of one edge, the other edge vanishes where their lines cross in the picture.
    const auto share = [&](std::size_t from, std::size_t to, std::size_t a, std::size_t b) {
      const double at_from = seen_area(view, points[from], points[a], points[b]);
      const double at_to = seen_area(view, points[to], points[a], points[b]);
      return at_from / (at_from - at_to);
    };
    const Between p = between(points[k], scalars[k], points[l], scalars[l], share(k, l, i, j));
    const Between q = between(points[i], scalars[i], points[j], scalars[j], share(i, j, k, l));
    result.corners[0] = thickest(view, p.point, p.scalar, q.point, q.scalar);
    result.edges = {{i + 1, k + 1}, {k + 1, j + 1}, {j + 1, l + 1}, {l + 1, i + 1}};
    return result;
  }
  // The corner opposite to the one face of its sign is in front of that face, or behind it.
  const std::size_t lone = count(-1) == 1 ? find(-1) : find(1);
  result.kind = 1;
  if (count(0) > 0) result.kind = count(0) == 1 ? 3 : 4;
  const auto& [a, b, c] = outward[lone];
  const double of_a = seen_area(view, points[lone], points[b], points[c]);
  const double of_b = seen_area(view, points[lone], points[c], points[a]);
  const double of_c = seen_area(view, points[lone], points[a], points[b]);
  const double sum = of_a + of_b + of_c;
  Between other;
  for (std::size_t axis = 0; axis < 3; ++axis)
    other.point[axis] = (of_a * points[a][axis] + of_b * points[b][axis] + of_c * points[c][axis]) / sum;
  other.scalar = (of_a * scalars[a] + of_b * scalars[b] + of_c * scalars[c]) / sum;
  result.corners[0] = thickest(view, points[lone], scalars[lone], other.point, other.scalar);
  result.edges = {{a + 1, b + 1}, {b + 1, c + 1}, {c + 1, a + 1}};
  return result;
}

Vec4 projected_light(const TetrahedralField& field, const ProjectedView& view, std::int64_t column, std::int64_t row,
                     const PiecewiseLinear& transfer, ProjectionRule rule, CellOrder order, const CellSlab& slab) {
  const Ray ray = view.ray(column, row);
  std::vector<std::uint32_t> cells = field.trace(ray).cells;
  const TetrahedralMesh& mesh = field.mesh();
  if (order == CellOrder::centre) {
    const auto way = [&](std::uint32_t cell) {
      double z = 0;
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double centre = 0;
        for (const std::uint32_t corner : mesh.tetrahedra[cell]) centre += mesh.points[corner][axis] / 4;
        if (axis == 2) z = view.height - centre;
        const double from_eye = axis == 2 ? z : centre;
        square += from_eye * from_eye;
      }
      return view.is_perspective ? square : z;
    };
    std::stable_sort(cells.begin(), cells.end(), [&](std::uint32_t a, std::uint32_t b) { return way(a) < way(b); });
  }
  const std::array<double, 2> place{ray.direction[0] + (view.is_perspective ? 0 : ray.origin[0]),
                                    ray.direction[1] + (view.is_perspective ? 0 : ray.origin[1])};
  Vec4 light = Vec4::Zero();
  for (const std::uint32_t number : cells) {
    const ProjectedCell cell = project(mesh, number, view);
    std::array<double, 5> weights{};
    const ProjectedCorner here = cell.at(place, weights);
    Vec4 of_cell = Vec4::Zero();
    if (rule == ProjectionRule::table) {
      of_cell = slab(here.front, here.back, here.length);
    } else {
      Vector3<double> color = Vector3<double>::Constant(0);
      double extinction = 0;
      double opacity = 0;
      for (std::size_t k = 0; k < 5; ++k) {
        if (weights[k] == 0) continue;
        const Optics front = transfer.at(cell.corners[k].front);
        const Optics back = transfer.at(cell.corners[k].back);
        const double mean = (front.extinction + back.extinction) / 2;
        color += weights[k] * (front.color + back.color) / 2;
        extinction += weights[k] * mean;
        opacity += weights[k] * -std::expm1(-mean * cell.corners[k].length);
      }
      if (rule == ProjectionRule::exponential) opacity = -std::expm1(-extinction * here.length);
      of_cell.head<3>() = opacity * color;
      of_cell[3] = opacity;
    }
    light += (1 - light[3]) * of_cell;
  }
  return light;
}

}  // namespace raytruth
