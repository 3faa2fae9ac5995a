#include "raytruth/deformation/lattice_proof.hpp"

#include <Eigen/LU>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using Cell = std::array<std::int64_t, 3>;
/// Bernstein coefficients of F on a part of a cell, x fastest.
using Hull = std::array<Eigen::Vector3d, 27>;

constexpr int most_halvings = 6;  // of one part
constexpr std::size_t most_parts = 1U << 17U;

std::string name_of(const Cell& cell) { return fmt::format("[{}, {}, {}]", cell[0], cell[1], cell[2]); }

Hull hull_of(const LatticeCell& cell) {
  Hull hull = cell.powers;
  hull[0] += cell.centre;
  for (const std::size_t stride : {std::size_t{1}, std::size_t{3}, std::size_t{9}})
    for (std::size_t k = 0; k < 27; ++k) {
      if (k / stride % 3 != 0) continue;
      const Eigen::Vector3d middle = hull[k] + hull[k + stride] / 2;
      hull[k + 2 * stride] += hull[k] + hull[k + stride];
      hull[k + stride] = middle;
    }
  return hull;
}

/// The eight halves of a part on all axes.
std::array<Hull, 8> halves_of(const Hull& whole) {
  std::array<Hull, 8> parts;
  parts[0] = whole;
  std::size_t count = 1;
  for (const std::size_t stride : {std::size_t{1}, std::size_t{3}, std::size_t{9}}) {
    for (std::size_t part = 0; part < count; ++part) {
      Hull& low = parts[part];
      Hull& high = parts[part + count];
      high = low;
      for (std::size_t k = 0; k < 27; ++k) {
        if (k / stride % 3 != 0) continue;
        const Eigen::Vector3d ab = (low[k] + low[k + stride]) / 2;
        const Eigen::Vector3d bc = (low[k + stride] + low[k + 2 * stride]) / 2;
        const Eigen::Vector3d middle = (ab + bc) / 2;
        high[k] = middle;
        high[k + stride] = bc;
        low[k + stride] = ab;
        low[k + 2 * stride] = middle;
      }
    }
    count *= 2;
  }
  return parts;
}

constexpr std::array<std::size_t, 3> strides{1, 3, 9};

/// The derivative in the middle of a part, by the part's own coordinates.
Eigen::Matrix3d middle_derivative(const Hull& hull) {
  constexpr std::array<double, 3> value{0.25, 0.5, 0.25};
  constexpr std::array<double, 3> slope{-1, 0, 1};
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < 27; ++k) {
    const std::array<std::size_t, 3> i{k % 3, k / 3 % 3, k / 9};
    result.col(0) += slope[i[0]] * value[i[1]] * value[i[2]] * hull[k];
    result.col(1) += value[i[0]] * slope[i[1]] * value[i[2]] * hull[k];
    result.col(2) += value[i[0]] * value[i[1]] * slope[i[2]] * hull[k];
  }
  return result;
}

/// For each axis the largest of |A D - e|, over the differences D of neighbouring coefficients: the derivatives along
/// an axis are means of twice these.
Eigen::Vector3d deviations(const Hull& hull, const Eigen::Matrix3d& inverse) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const std::size_t stride = strides[static_cast<std::size_t>(axis)];
    for (std::size_t k = 0; k < 27; ++k) {
      if (k / stride % 3 == 2) continue;
      const Eigen::Vector3d slope = inverse * (2 * (hull[k + stride] - hull[k]));
      result[axis] = std::max(result[axis], (slope - Eigen::Vector3d::Unit(axis)).norm());
    }
  }
  return result;
}

/// A lower bound of the determinant of the derivative by the part's own coordinates, of the sign of `orientation`;
/// none: it is not known yet. `folds` is set where the middle's has the other sign.
std::optional<double> least_determinant(const Hull& hull, double orientation, bool& folds) {
  const Eigen::Matrix3d middle = middle_derivative(hull);
  const double determinant = orientation * middle.determinant();
  if (!(determinant > 0)) {
    folds = true;
    return std::nullopt;
  }
  const double norm = deviations(hull, middle.inverse()).norm();
  if (!(norm < 1)) return std::nullopt;
  return determinant * (1 - norm) * (1 - norm) * (1 - norm);
}

/// The least determinant in a part, by the whole cell's coordinates.
double least_determinant_within(const Hull& hull, double orientation, int depth, bool& folds) {
  if (const auto least = least_determinant(hull, orientation, folds)) {
    // A bound far below the determinant itself widens what hangs on it: a few halvings bring it near.
    if (depth >= 2 || *least > 0.5 * orientation * middle_derivative(hull).determinant())
      return *least * std::pow(8.0, depth);
  }
  if (folds || depth == most_halvings) return -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Hull& part : halves_of(hull)) {
    least = std::min(least, least_determinant_within(part, orientation, depth + 1, folds));
    if (!(least > 0)) return least;
  }
  return least;
}

struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;

  [[nodiscard]] bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

Box box_of(const Hull& hull) {
  Box box{hull[0], hull[0]};
  for (const Eigen::Vector3d& point : hull) {
    box.low = box.low.cwiseMin(point);
    box.high = box.high.cwiseMax(point);
  }
  return box;
}

bool may_meet(const Hull& one, const Hull& other, int depth) {
  if (!box_of(one).meets(box_of(other))) return false;
  if (depth == most_halvings) return true;
  const auto parts = halves_of(one);
  return std::any_of(parts.begin(), parts.end(), [&](const Hull& part) { return may_meet(other, part, depth + 1); });
}

/// The cells of a lattice, each halved on all axes some times: parts.
class Parts {
 public:
  explicit Parts(const Lattice& lattice) : size_(lattice.cells()) {
    for (std::int64_t k = 0; k < size_[2]; ++k)
      for (std::int64_t j = 0; j < size_[1]; ++j)
        for (std::int64_t i = 0; i < size_[0]; ++i) hulls_.push_back(hull_of(lattice.cell({i, j, k})));
  }

  void halve() {
    Parts halved = *this;
    for (std::int64_t& axis : halved.size_) axis *= 2;
    halved.by_cell_ *= 2;
    halved.hulls_.resize(8 * hulls_.size());
    for (std::size_t i = 0; i < hulls_.size(); ++i) {
      const Cell whole = part(i);
      const auto parts = halves_of(hulls_[i]);
      for (std::size_t k = 0; k < 8; ++k)
        halved.hulls_[halved.index({2 * whole[0] + static_cast<std::int64_t>(k & 1U),
                                    2 * whole[1] + static_cast<std::int64_t>(k >> 1U & 1U),
                                    2 * whole[2] + static_cast<std::int64_t>(k >> 2U)})] = parts[k];
    }
    *this = std::move(halved);
  }

  [[nodiscard]] const Cell& size() const { return size_; }
  [[nodiscard]] std::size_t count() const { return hulls_.size(); }
  [[nodiscard]] Cell part(std::size_t index) const {
    const auto i = static_cast<std::int64_t>(index);
    return {i % size_[0], i / size_[0] % size_[1], i / (size_[0] * size_[1])};
  }
  /// The lattice's cell that a part is of.
  [[nodiscard]] Cell cell(std::size_t index) const {
    Cell cell = part(index);
    for (std::int64_t& axis : cell) axis /= by_cell_;
    return cell;
  }
  [[nodiscard]] const Hull& operator[](std::size_t index) const { return hulls_[index]; }
  [[nodiscard]] const Hull& at(const Cell& part) const { return hulls_[index(part)]; }

 private:
  [[nodiscard]] std::size_t index(const Cell& part) const {
    return static_cast<std::size_t>((part[2] * size_[1] + part[1]) * size_[0] + part[0]);
  }

  Cell size_;
  std::int64_t by_cell_ = 1;
  std::vector<Hull> hulls_;
};

/// Whether F is one to one on the block of parts about one, by a single matrix.
bool is_one_to_one(const Parts& parts, const Cell& middle) {
  Cell first{};
  Cell last{};
  Cell centre{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    first[axis] = std::max<std::int64_t>(0, middle[axis] - 1);
    last[axis] = std::min(parts.size()[axis] - 1, middle[axis] + 1);
    centre[axis] = (first[axis] + last[axis]) / 2;
  }
  const Eigen::Matrix3d inverse = middle_derivative(parts.at(centre)).inverse();
  Eigen::Vector3d worst = Eigen::Vector3d::Zero();
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
      for (std::int64_t i = first[0]; i <= last[0]; ++i)
        worst = worst.cwiseMax(deviations(parts.at({i, j, k}), inverse));
  return worst.norm() < 1;
}

/// Whether every block of parts is mapped one to one; else a part about which it is not.
std::optional<std::size_t> first_that_is_not_one_to_one(const Parts& parts) {
  for (std::size_t i = 0; i < parts.count(); ++i)
    if (!is_one_to_one(parts, parts.part(i))) return i;
  return std::nullopt;
}

/// Two parts that no block holds and that may meet.
std::optional<std::array<std::size_t, 2>> first_that_may_meet(const Parts& parts) {
  std::vector<Box> boxes;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < parts.count(); ++i) {
    boxes.push_back(box_of(parts[i]));
    order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t one, std::size_t other) { return boxes[one].low[0] < boxes[other].low[0]; });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].low[0] <= boxes[order[i]].high[0]; ++j) {
      if (!boxes[order[i]].meets(boxes[order[j]])) continue;
      const Cell one = parts.part(order[i]);
      const Cell other = parts.part(order[j]);
      bool is_in_block = true;
      for (std::size_t axis = 0; axis < 3; ++axis) is_in_block = is_in_block && std::abs(one[axis] - other[axis]) <= 2;
      if (!is_in_block && may_meet(parts[order[i]], parts[order[j]], 0)) return std::array{order[i], order[j]};
    }
  return std::nullopt;
}

}  // namespace

LatticeProof proof_of(const Lattice& lattice) {
  Parts parts(lattice);
  const double by_object = lattice.cell_edges().determinant();
  const double orientation = by_object < 0 ? -1 : 1;
  LatticeProof proof{.least_determinant = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < parts.count(); ++i) {
    bool folds = false;
    const double least = least_determinant_within(parts[i], orientation, 0, folds);
    if (!(least > 0)) {
      proof.least_determinant = 0;
      proof.refusal =
          fmt::format("the deformation {} in the lattice's cell {}: its determinant is not {} there",
                      folds ? "folds" : "may fold", name_of(parts.cell(i)), folds ? "positive" : "proven positive");
      return proof;
    }
    proof.least_determinant = std::min(proof.least_determinant, least / std::abs(by_object));
  }
  while (true) {
    const auto part = first_that_is_not_one_to_one(parts);
    if (!part) break;
    if (8 * parts.count() > most_parts) {
      proof.refusal = fmt::format(
          "the deformation changes so much about the lattice's cell {} that it is not proven one "
          "to one there; more cells, or a smaller displacement, are allowed",
          name_of(parts.cell(*part)));
      return proof;
    }
    parts.halve();
  }
  if (const auto pair = first_that_may_meet(parts))
    proof.refusal = fmt::format("the deformation lays the lattice's cells {} and {} over each other",
                                name_of(parts.cell((*pair)[0])), name_of(parts.cell((*pair)[1])));
  return proof;
}

}  // namespace raytruth
