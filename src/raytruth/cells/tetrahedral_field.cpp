#include "raytruth/cells/tetrahedral_field.hpp"

#include "raytruth/cells/exact_determinant.hpp"
#include "raytruth/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace raytruth {

namespace {

constexpr double slack = 1 + 0x1p-20;
constexpr double largest_origin = 0x1p250;
constexpr double coarse = 0x1p-64;  ///< share of a face's area, as the ray sees it, that its rounding may not reach

using Point = std::array<double, 3>;
using Corners = std::array<std::uint32_t, 4>;

/// Faces of a tetrahedron of positive orientation, counterclockwise from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

DoubleDouble quotient(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * first;
  const double second = rest.high / b.high;
  const DoubleDouble rest_of_rest = rest - b * second;
  return fast_two_sum(first, second) + DoubleDouble(rest_of_rest.high / b.high);
}

/// A line with a direction whose largest component is in [1/2, 1).
struct Line {
  Point origin;
  Point direction;
  DoubleDouble norm;  ///< of that direction
};

Line line_of(const Ray& ray) {
  static_cast<void>(unit_direction(ray.direction));  // refuses
  for (const double x : ray.origin)
    if (!(std::abs(x) <= largest_origin))
      throw InputError(fmt::format("origin {}; finite coordinates up to 2^250 are allowed", x));
  Line line{.origin = ray.origin, .direction = {}, .norm = {}};
  double largest = 0;
  for (const double x : ray.direction) largest = std::max(largest, std::abs(x));
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  DoubleDouble square;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = ray.direction[axis];
    // As in `unit_direction`: a component this small moves no ray.
    line.direction[axis] = std::abs(x) < 0x1p-500 * largest ? 0 : std::ldexp(x, -exponent);
    square += two_product(line.direction[axis], line.direction[axis]);
  }
  const double root = std::sqrt(square.high);
  line.norm = DoubleDouble(root) + (square - two_product(root, root)) / (2 * root);
  return line;
}

/// A corner as the line sees it.
struct Corner {
  std::uint32_t place = 0;
  Point point{};
  Vector106 from_origin{};
  DoubleDouble way;  ///< along the direction, not normalised
  double way_magnitude = 0;
};

Corner corner_of(const Line& line, const TetrahedralMesh& mesh, std::uint32_t index) {
  Corner corner;
  corner.place = mesh.places[index];
  corner.point = mesh.points[index];
  corner.from_origin = difference(corner.point, line.origin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const DoubleDouble term = corner.from_origin[axis] * line.direction[axis];
    corner.way += term;
    corner.way_magnitude += std::abs(term.high);
  }
  return corner;
}

ExactVector exact_direction(const Line& line) {
  return {ExactNumber(line.direction[0]), ExactNumber(line.direction[1]), ExactNumber(line.direction[2])};
}

ExactNumber exact_way(const Line& line, const Corner& corner) {
  const ExactVector d = exact_direction(line);
  const ExactVector a = exact_difference(corner.point, line.origin);
  return a[0] * d[0] + a[1] * d[1] + a[2] * d[2];
}

ExactNumber exact_side(const Line& line, const Corner& a, const Corner& b) {
  return determinant(exact_direction(line), exact_difference(a.point, line.origin),
                     exact_difference(b.point, line.origin));
}

/// On which side of the line an edge passes: det(direction, a, b), and its exact sign.
struct Side {
  Determinant value;
  int sign = 0;

  [[nodiscard]] Side reversed() const { return {{-value.value, value.error}, -sign}; }
};

/// It has one number whichever way round the edge is asked for.
Side side_of(const Line& line, const Corner& a, const Corner& b) {
  if (a.place > b.place) return side_of(line, b, a).reversed();
  const Vector106 direction{line.direction[0], line.direction[1], line.direction[2]};
  Side side{determinant(direction, a.from_origin, b.from_origin), 0};
  side.sign = side.value.sign();
  if (side.sign == 0) side.sign = exact_side(line, a, b).sign();
  return side;
}

/// Corners on which a point of the ray depends: one, an edge's or a face's, ascending by place.
using Support = std::array<std::int64_t, 3>;

/// Where a line passes through a face.
struct Passage {
  std::array<Corner, 3> corners;  ///< ascending by place, those of weight 0 behind
  std::array<DoubleDouble, 3> weights{};
  std::size_t count = 0;
  double weight_error = 0;  ///< of each, in parts of their sum
  DoubleDouble way;
  double way_error = 0;
  Support support{-1, -1, -1};

  /// The mean of a number of each corner, and what it may be off by; equal numbers have themselves as mean.
  [[nodiscard]] std::pair<DoubleDouble, double> mean(const std::array<DoubleDouble, 3>& numbers) const {
    DoubleDouble sum;
    DoubleDouble weight;
    double spread = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const DoubleDouble step = numbers[k] - numbers[0];
      spread = std::max(spread, std::abs(step.high));
      sum += weights[k] * step;
      weight += weights[k];
    }
    if (spread == 0) return {numbers[0], 0};
    const DoubleDouble result = numbers[0] + quotient(sum, weight);
    return {result, slack * (spread * (6 * weight_error + 0x1p-96) + 0x1p-102 * std::abs(result.high) + 0x1p-1000)};
  }
};

ExactNumber exact_way(const Line& line, const Passage& passage) {
  if (passage.count == 1) return exact_way(line, passage.corners[0]);
  ExactNumber sum = 0;
  ExactNumber weight = 0;
  for (std::size_t k = 0; k < passage.count; ++k) {
    const ExactNumber side =
        abs(passage.count == 2 ? exact_side(line, passage.corners[1 - k], passage.corners[2])
                               : exact_side(line, passage.corners[(k + 1) % 3], passage.corners[(k + 2) % 3]));
    sum += side * exact_way(line, passage.corners[k]);
    weight += side;
  }
  return sum / weight;
}

Passage passage_of(const Line& line, const std::array<Corner, 3>& corners, const std::array<Side, 3>& opposite) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const bool a_counts = opposite[a].sign != 0;
    const bool b_counts = opposite[b].sign != 0;
    return a_counts != b_counts ? a_counts : corners[a].place < corners[b].place;
  });
  Passage passage;
  double error = 0;
  DoubleDouble sum;
  for (std::size_t k = 0; k < 3; ++k) {
    passage.corners[k] = corners[order[k]];
    const Side& side = opposite[order[k]];
    if (side.sign == 0) continue;
    passage.support[k] = passage.corners[k].place;
    passage.weights[k] = side.value.value.high < 0 ? -side.value.value : side.value.value;
    error = std::max(error, side.value.error);
    sum += passage.weights[k];
    ++passage.count;
  }
  if (passage.count > 1) {
    passage.weight_error = error / sum.high;
    if (!(passage.weight_error < coarse)) {
      std::array<ExactNumber, 3> exact;
      ExactNumber total = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (k >= passage.count) continue;
        exact[k] = abs(exact_side(line, corners[(order[k] + 1) % 3], corners[(order[k] + 2) % 3]));
        total += exact[k];
      }
      for (std::size_t k = 0; k < passage.count; ++k) passage.weights[k] = to_106_bits(ExactNumber(exact[k] / total));
      passage.weight_error = 0x1p-102;
    }
  }
  const auto [way, way_error] = passage.mean({passage.corners[0].way, passage.corners[1].way, passage.corners[2].way});
  double magnitude = 0;
  for (std::size_t k = 0; k < passage.count; ++k) magnitude = std::max(magnitude, passage.corners[k].way_magnitude);
  passage.way = way;
  passage.way_error = way_error + 0x1p-98 * magnitude + 0x1p-1000;
  return passage;
}

/// A cell along the line.
struct Stretch {
  std::uint32_t cell = 0;
  Passage in;
  Passage out;
  bool is_in_face = false;
  bool is_cut = false;  ///< begins at the ray's origin, inside the cell
};

/// Whether the line certainly passes by: all other corners are on one side of the plane through it and some corner.
bool passes_by(const Line& line, const TetrahedralMesh& mesh, std::uint32_t cell) {
  constexpr double rounding = 0x1p-48;  // of binary64, of what the corners' differences and six products come to
  std::array<Point, 4> corners{};
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      corners[k][axis] = mesh.points[mesh.tetrahedra[cell][k]][axis] - line.origin[axis];
  std::array<int, 4> left{};
  std::array<int, 4> right{};
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b) {
      double side = 0;
      double magnitude = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double p = corners[a][(i + 1) % 3] * corners[b][(i + 2) % 3];
        const double q = corners[a][(i + 2) % 3] * corners[b][(i + 1) % 3];
        side += line.direction[i] * (p - q);
        magnitude += std::abs(line.direction[i]) * (std::abs(p) + std::abs(q));
      }
      if (std::abs(side) <= rounding * magnitude + 0x1p-900) continue;
      ++(side > 0 ? left : right)[a];
      ++(side > 0 ? right : left)[b];
    }
  for (std::size_t a = 0; a < 4; ++a)
    if (left[a] == 3 || right[a] == 3) return true;
  return false;
}

std::optional<Stretch> stretch_of(const Line& line, const TetrahedralMesh& mesh, std::uint32_t cell) {
  if (passes_by(line, mesh, cell)) return {};
  std::array<Corner, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = corner_of(line, mesh, mesh.tetrahedra[cell][k]);
  std::array<std::array<Side, 4>, 4> sides;
  for (std::size_t a = 0; a < 4; ++a) {
    bool is_above = false;
    bool is_below = false;
    for (std::size_t b = 0; b < 4; ++b) {
      if (b > a) {
        sides[a][b] = side_of(line, corners[a], corners[b]);
        sides[b][a] = sides[a][b].reversed();
      }
      if (b == a) continue;
      is_above = is_above || sides[a][b].sign >= 0;
      is_below = is_below || sides[a][b].sign <= 0;
    }
    // All other corners are on one side of the plane through the line and this one: the line passes by.
    if (!is_above || !is_below) {
      return {};
    }
  }
  std::optional<Passage> in;
  std::optional<Passage> out;
  for (const auto& [a, b, c] : outward) {
    const std::array<Side, 3> opposite{sides[b][c], sides[c][a], sides[a][b]};
    const auto count = [&opposite](int sign) {
      return std::count_if(opposite.begin(), opposite.end(), [sign](const Side& side) { return side.sign == sign; });
    };
    if (count(0) == 3) continue;
    if (count(1) == 0 && !in) in = passage_of(line, {corners[a], corners[b], corners[c]}, opposite);
    if (count(-1) == 0 && !out) out = passage_of(line, {corners[a], corners[b], corners[c]}, opposite);
  }
  // A point of a cell has one support: the line only touches the cell where both are the same.
  if (!in || !out || in->support == out->support) return {};
  Stretch stretch{.cell = cell, .in = *in, .out = *out};
  std::vector<std::int64_t> all;
  for (const Support& support : {in->support, out->support})
    for (const std::int64_t place : support)
      if (place >= 0 && std::find(all.begin(), all.end(), place) == all.end()) all.push_back(place);
  stretch.is_in_face = all.size() < 4;
  return stretch;
}

/// -1, 0 or 1: whether one place is before, at or behind another, exactly.
int compare(const Line& line, const Passage& a, const Passage& b) {
  const DoubleDouble gap = b.way - a.way;
  if (std::abs(gap.high) > slack * (a.way_error + b.way_error)) return gap.high > 0 ? -1 : 1;
  return ExactNumber(exact_way(line, a) - exact_way(line, b)).sign();
}

int sign_of_way(const Line& line, const Passage& passage) {
  if (std::abs(passage.way.high) > passage.way_error) return passage.way.high > 0 ? 1 : -1;
  return exact_way(line, passage).sign();
}

[[noreturn]] void refuse_overlap(std::uint32_t a, std::uint32_t b) {
  throw InputError(
      fmt::format("cell {}: found it on the same part of a ray as cell {}; cells that do not overlap and "
                  "meet in whole faces are allowed",
                  std::max(a, b), std::min(a, b)));
}

/// The stretches in the order in which the ray meets them; the indices at which a part begins.
std::pair<std::vector<Stretch>, std::vector<std::size_t>> walk(const Line& line, std::vector<Stretch> found) {
  std::map<Support, std::size_t> by_entry;
  std::map<Support, std::size_t> by_exit;
  std::vector<bool> is_taken(found.size(), false);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [entered, is_first] = by_entry.emplace(found[i].in.support, i);
    if (is_first) {
      const auto [left, is_first_out] = by_exit.emplace(found[i].out.support, i);
      if (!is_first_out) refuse_overlap(found[left->second].cell, found[i].cell);
      is_taken[i] = true;
      continue;
    }
    const Stretch& other = found[entered->second];
    // Cells around a face or an edge in which the ray lies: the first has it.
    if (other.out.support != found[i].out.support || !other.is_in_face || !found[i].is_in_face)
      refuse_overlap(other.cell, found[i].cell);
  }
  std::vector<std::size_t> heads;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (is_taken[i] && !by_exit.contains(found[i].in.support)) heads.push_back(i);
  std::sort(heads.begin(), heads.end(),
            [&](std::size_t a, std::size_t b) { return compare(line, found[a].in, found[b].in) < 0; });
  std::pair<std::vector<Stretch>, std::vector<std::size_t>> result;
  auto& [stretches, parts] = result;
  for (const std::size_t head : heads) {
    bool is_new_part = stretches.empty();
    if (!stretches.empty()) {
      const int order = compare(line, stretches.back().out, found[head].in);
      if (order > 0) {
        const auto over = std::find_if(stretches.begin(), stretches.end(), [&](const Stretch& stretch) {
          return compare(line, stretch.out, found[head].in) > 0;
        });
        refuse_overlap(over->cell, found[head].cell);
      }
      is_new_part = order < 0;
    }
    if (is_new_part) parts.push_back(stretches.size());
    for (auto next = by_entry.find(found[head].in.support); next != by_entry.end();
         next = by_entry.find(stretches.back().out.support))
      stretches.push_back(found[next->second]);
  }
  return result;
}

/// The length between two passages in 106 bits, to its own rounding, and the bound of that.
std::pair<DoubleDouble, double> length_of(const Line& line, const Stretch& stretch) {
  const DoubleDouble begin = stretch.is_cut ? DoubleDouble(0) : stretch.in.way;
  const double begin_error = stretch.is_cut ? 0 : stretch.in.way_error;
  DoubleDouble length = stretch.out.way - begin;
  double error = slack * (begin_error + stretch.out.way_error) + 0x1p-102 * std::abs(length.high);
  if (!(length.high > 0x1p40 * error)) {
    ExactNumber exact = exact_way(line, stretch.out);
    if (!stretch.is_cut) exact -= exact_way(line, stretch.in);
    length = to_106_bits(exact);
    error = 0x1p-102 * length.high;
  }
  const DoubleDouble normalised = quotient(length, line.norm);
  return {normalised, slack * (error / line.norm.high + 0x1p-97 * normalised.high)};
}

/// The scalar where the line passes through a face of the cell.
std::pair<DoubleDouble, double> scalar_at(const TetrahedralMesh& mesh, std::uint32_t cell, const Passage& passage) {
  if (mesh.scalars.empty()) return {mesh.cell_scalars[cell], 0};
  std::array<DoubleDouble, 3> scalars{};
  for (std::size_t k = 0; k < passage.count; ++k)
    for (const std::uint32_t corner : mesh.tetrahedra[cell])
      if (mesh.places[corner] == passage.corners[k].place) scalars[k] = mesh.scalars[corner];
  return passage.mean(scalars);
}

void cut_piece(PrecisePiece<3>& piece, const DoubleDouble& share, double share_error) {
  const auto& b = piece.polynomial.coefficients;
  const DoubleDouble first = b[0] + (b[3] - b[0]) * share;
  piece.error += std::abs((b[3] - b[0]).high) * share_error;
  const DoubleDouble last = b[3];
  piece.polynomial.coefficients = {first, first + (last - first) / 3, first + (last - first) * 2.0 / 3, last};
}

}  // namespace

/// A tree of boxes around cells, halved at the median of their centres.
struct TetrahedralField::Tree {
  struct Box {
    Point low;
    Point high;
  };
  static constexpr std::size_t leaf = 8;  ///< cells

  explicit Tree(const TetrahedralMesh& mesh) : cells(mesh.tetrahedra.size()) {
    std::iota(cells.begin(), cells.end(), 0U);
    boxes.reserve(4 * (cells.size() / leaf + 1));
    build(mesh, 0, cells.size());
  }

  /// Boxes stand in the order in which `visit` meets them, each half behind its whole.
  void build(const TetrahedralMesh& mesh, std::size_t begin, std::size_t end) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    Box box{{infinite, infinite, infinite}, {-infinite, -infinite, -infinite}};
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t corner : mesh.tetrahedra[cells[i]])
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::min(box.low[axis], mesh.points[corner][axis]);
          box.high[axis] = std::max(box.high[axis], mesh.points[corner][axis]);
        }
    const std::size_t here = boxes.size();
    boxes.push_back(box);
    skips.push_back(0);
    if (end - begin > leaf) {
      std::size_t axis = 0;
      for (std::size_t other = 1; other < 3; ++other)
        if (box.high[other] - box.low[other] > box.high[axis] - box.low[axis]) axis = other;
      const auto centre = [&](std::uint32_t cell) {
        double sum = 0;
        for (const std::uint32_t corner : mesh.tetrahedra[cell]) sum += mesh.points[corner][axis] / 4;
        return sum;
      };
      const std::size_t middle = begin + (end - begin) / 2;
      const auto at = [this](std::size_t i) { return cells.begin() + static_cast<std::ptrdiff_t>(i); };
      std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(centre(a), a) < std::pair(centre(b), b);
      });
      build(mesh, begin, middle);
      build(mesh, middle, end);
    }
    skips[here] = boxes.size();
  }

  /// All cells whose boxes the line may meet.
  template <class Visit>
  void visit(const Line& line, const Visit& visit_cell, std::size_t node, std::size_t begin, std::size_t end) const {
    if (!may_meet(line, boxes[node])) return;
    if (end - begin <= leaf) {
      for (std::size_t i = begin; i < end; ++i) visit_cell(cells[i]);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    visit(line, visit_cell, node + 1, begin, middle);
    visit(line, visit_cell, skips[node + 1], middle, end);
  }

  /// Whether the line passes the box by less than some roundings.
  static bool may_meet(const Line& line, const Box& box) {
    double first = -std::numeric_limits<double>::infinity();
    double last = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double size = std::max({std::abs(box.low[axis]), std::abs(box.high[axis]), std::abs(line.origin[axis])});
      const double low = box.low[axis] - line.origin[axis] - 0x1p-48 * size;
      const double high = box.high[axis] - line.origin[axis] + 0x1p-48 * size;
      if (line.direction[axis] == 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const double a = low / line.direction[axis];
      const double b = high / line.direction[axis];
      const double rounding = 0x1p-50 * std::max(std::abs(a), std::abs(b));
      first = std::max(first, std::min(a, b) - rounding);
      last = std::min(last, std::max(a, b) + rounding);
    }
    return !(first > last);
  }

  std::vector<std::uint32_t> cells;
  std::vector<Box> boxes;
  std::vector<std::size_t> skips;  ///< behind the last box inside of each
};

TetrahedralField::TetrahedralField(TetrahedralMesh mesh)
    : mesh_(std::move(mesh)), tree_(std::make_unique<const Tree>(mesh_)) {}
TetrahedralField::~TetrahedralField() = default;
TetrahedralField::TetrahedralField(TetrahedralField&&) noexcept = default;
TetrahedralField& TetrahedralField::operator=(TetrahedralField&&) noexcept = default;

std::array<std::array<double, 3>, 2> TetrahedralField::box() const {
  return {tree_->boxes.front().low, tree_->boxes.front().high};
}

MeshRay TetrahedralField::trace(const Ray& ray) const {
  const Line line = line_of(ray);
  std::vector<Stretch> found;
  tree_->visit(
      line,
      [&](std::uint32_t cell) {
        auto stretch = stretch_of(line, mesh_, cell);
        if (!stretch || sign_of_way(line, stretch->out) <= 0) return;
        stretch->is_cut = sign_of_way(line, stretch->in) < 0;
        found.push_back(std::move(*stretch));
      },
      0, 0, tree_->cells.size());
  // The order in which the tree has them decides nothing but whose a ray in a face is.
  std::sort(found.begin(), found.end(), [](const Stretch& a, const Stretch& b) { return a.cell < b.cell; });
  const auto [stretches, heads] = walk(line, std::move(found));

  MeshRay result;
  if (ray.length == 0) return result;
  DoubleDouble t;
  DoubleDouble first_way;
  DoubleDouble last_scalar;
  double last_error = 0;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const Stretch& stretch = stretches[i];
    const bool is_head = std::find(heads.begin(), heads.end(), i) != heads.end();
    if (i == 0 && !stretch.is_cut) first_way = stretch.in.way;
    if (is_head) {
      if (i > 0) t = quotient(stretch.in.way - first_way, line.norm);
      if (!(static_cast<double>(t) < ray.length)) break;
      result.parts.push_back({result.signal.pieces.size(), t, t});
    }
    const auto [length, length_error] = length_of(line, stretch);
    PrecisePiece<3> piece;
    piece.length = static_cast<double>(length);
    piece.extent = length;
    auto [begin, begin_error] = scalar_at(mesh_, stretch.cell, stretch.in);
    // Where the ray passes an edge or a point, this scalar was found through another face before.
    const double apart = is_head ? HUGE_VAL : std::abs(static_cast<double>(begin - last_scalar));
    if (apart <= begin_error + last_error) {
      begin = last_scalar;
      begin_error += last_error;
    }
    const auto [end, end_error] = scalar_at(mesh_, stretch.cell, stretch.out);
    last_scalar = end;
    last_error = end_error;
    const DoubleDouble step = end - begin;
    piece.polynomial.coefficients = {begin, begin + step / 3, begin + step * 2.0 / 3, end};
    piece.error = std::max(begin_error, end_error);
    if (step.high != 0) piece.error += 0x1p-98 * (std::abs(begin.high) + std::abs(end.high)) + 0x1p-1000;
    if (stretch.is_cut) {
      const DoubleDouble whole = stretch.out.way - stretch.in.way;
      const DoubleDouble share = quotient(-stretch.in.way, whole);
      cut_piece(piece, share, slack * (2 * (stretch.in.way_error + stretch.out.way_error) / whole.high + 0x1p-96));
    }
    result.signal.unclaimed += length_error;
    result.cells.push_back(stretch.cell);
    const DoubleDouble left = DoubleDouble(ray.length) - t;
    const bool is_last = std::isfinite(ray.length) && !(length < left);
    if (is_last && left < length) {
      auto& b = piece.polynomial.coefficients;
      const DoubleDouble share = quotient(left, length);
      const DoubleDouble last = b[0] + (b[3] - b[0]) * share;
      const double share_error = slack * (length_error / length.high + 0x1p-96);
      piece.error += std::abs((b[3] - b[0]).high) * share_error;
      b = {b[0], b[0] + (last - b[0]) / 3, b[0] + (last - b[0]) * 2.0 / 3, last};
      piece.extent = left;
      piece.length = static_cast<double>(left);
    }
    result.signal.length += piece.extent;
    result.signal.pieces.push_back(piece);
    t += piece.extent;
    result.parts.back().to = t;
    if (is_last) break;
  }
  if (!result.signal.pieces.empty())
    result.signal.of_length = result.signal.unclaimed + 0x1p-98 * result.signal.length.high;
  return result;
}

std::pair<Chain<3>, SignalError> MeshRay::chain() const {
  std::pair<Chain<3>, SignalError> result;
  auto& [chain, error] = result;
  for (const auto& piece : signal.pieces) {
    Piece<3> to{.start = chain.end, .length = piece.length};
    double rounding = 0;
    double steepest = 0;
    for (std::size_t k = 0; k <= 3; ++k) {
      const DoubleDouble& b = piece.polynomial.coefficients[k];
      to.polynomial.coefficients[k] = static_cast<double>(b);
      rounding = std::max(rounding, std::abs(static_cast<double>(b - to.polynomial.coefficients[k])));
      if (k > 0)
        steepest = std::max(steepest, std::abs(to.polynomial.coefficients[k] - to.polynomial.coefficients[k - 1]));
    }
    // A chain may be read by t as well as by pieces, whose lengths are rounded.
    const double stretch =
        3 * steepest * std::abs(static_cast<double>(piece.extent - DoubleDouble(piece.length))) / piece.length;
    chain.pieces.push_back(to);
    chain.end += piece.extent;
    const double of_piece = piece.error + rounding + stretch;
    error.of_pieces.push_back(of_piece > 0 ? slack * of_piece + 0x1p-1000 : 0);
  }
  error.of_length = signal.of_length;
  error.unclaimed = signal.unclaimed;
  return result;
}

}  // namespace raytruth
