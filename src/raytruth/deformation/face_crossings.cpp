#include "raytruth/deformation/face_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace raytruth {

namespace {

constexpr int deepest = 24;
// Two crossings of one kind, so near in the size of a cell, are one that patches share.
constexpr double same = 1e-8;
// How far beyond its part a root may lie and still count: those on common borders are found twice, not never.
constexpr double beyond = 1e-9;

/// A polynomial of degree 2 in each of two coordinates on [0, 1]^2: Bernstein coefficients, the first coordinate first.
using Biquadratic = std::array<double, 9>;

/// De Casteljau's halving along an axis: the stride of its coefficients is 1 or 3.
void halve(const Biquadratic& whole, std::size_t stride, Biquadratic& low, Biquadratic& high) {
  const std::size_t across = 4 - stride;
  for (std::size_t line = 0; line < 3; ++line) {
    const std::size_t i = line * across;
    const double a = whole[i];
    const double b = whole[i + stride];
    const double c = whole[i + 2 * stride];
    const double ab = (a + b) / 2;
    const double bc = (b + c) / 2;
    low[i] = a;
    low[i + stride] = ab;
    low[i + 2 * stride] = high[i] = (ab + bc) / 2;
    high[i + stride] = bc;
    high[i + 2 * stride] = c;
  }
}

bool has_one_sign(const Biquadratic& f) {
  const auto [low, high] = std::minmax_element(f.begin(), f.end());
  return *low > 0 || *high < 0;
}

/// Value and derivatives at a place.
std::array<double, 3> jet(const Biquadratic& f, double u, double v) {
  const std::array<double, 3> bu{(1 - u) * (1 - u), 2 * u * (1 - u), u * u};
  const std::array<double, 3> bv{(1 - v) * (1 - v), 2 * v * (1 - v), v * v};
  const std::array<double, 3> du{-2 * (1 - u), 2 - 4 * u, 2 * u};
  const std::array<double, 3> dv{-2 * (1 - v), 2 - 4 * v, 2 * v};
  std::array<double, 3> result{};
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const double b = f[3 * j + i];
      result[0] += b * bu[i] * bv[j];
      result[1] += b * du[i] * bv[j];
      result[2] += b * bu[i] * dv[j];
    }
  return result;
}

/// By how much the derivatives may differ from those at the middle, on a square twice as large about it: second
/// differences bound the second derivatives on the patch, and these change by no more on the larger square, as a
/// quadratic's do not change along their own axis.
std::array<double, 2> spread_of_derivatives(const Biquadratic& f) {
  double along_u = 0;
  double along_v = 0;
  double mixed = 0;
  for (std::size_t line = 0; line < 3; ++line) {
    along_u = std::max(along_u, 2 * std::abs(f[3 * line] - 2 * f[3 * line + 1] + f[3 * line + 2]));
    along_v = std::max(along_v, 2 * std::abs(f[line] - 2 * f[line + 3] + f[line + 6]));
  }
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t k = 3 * j + i;
      mixed = std::max(mixed, 4 * std::abs(f[k] - f[k + 1] - f[k + 3] + f[k + 4]));
    }
  // Beyond the patch the bounds of polynomials of degree 2 grow by at most (1 + 2 + 2 * ...) <= 7 on [-1/2, 3/2].
  constexpr double growth = 7;
  return {growth * (along_u + mixed), growth * (along_v + mixed)};
}

/// The search on one patch.
class PatchSearch {
 public:
  struct Root {
    double u;
    double v;
  };

  void operator()(const Biquadratic& f, const Biquadratic& g) { search(f, g, 0, 0, 1, 0); }

  std::vector<Root> roots;
  double in_doubt = 0;  ///< sides of undecided parts, in all

 private:
  void search(const Biquadratic& f, const Biquadratic& g, double u, double v, double side, int depth) {
    if (has_one_sign(f) || has_one_sign(g)) return;
    if (decide(f, g, u, v, side)) return;
    if (depth == deepest) {
      in_doubt += side;
      return;
    }
    std::array<Biquadratic, 2> fu;
    std::array<Biquadratic, 2> gu;
    halve(f, 1, fu[0], fu[1]);
    halve(g, 1, gu[0], gu[1]);
    for (std::size_t i = 0; i < 2; ++i) {
      std::array<Biquadratic, 2> fv;
      std::array<Biquadratic, 2> gv;
      halve(fu[i], 3, fv[0], fv[1]);
      halve(gu[i], 3, gv[0], gv[1]);
      for (std::size_t j = 0; j < 2; ++j)
        search(fv[j], gv[j], u + static_cast<double>(i) * side / 2, v + static_cast<double>(j) * side / 2, side / 2,
               depth + 1);
    }
  }

  /// Whether it is known that there is no root, or the only one is found.
  bool decide(const Biquadratic& f, const Biquadratic& g, double u, double v, double side) {
    const auto at_f = jet(f, 0.5, 0.5);
    const auto at_g = jet(g, 0.5, 0.5);
    const double determinant = at_f[1] * at_g[2] - at_f[2] * at_g[1];
    if (determinant == 0) return false;
    const std::array<double, 4> inverse{at_g[2] / determinant, -at_f[2] / determinant, -at_g[1] / determinant,
                                        at_f[1] / determinant};
    const auto spread_f = spread_of_derivatives(f);
    const auto spread_g = spread_of_derivatives(g);
    double variation = 0;
    for (std::size_t row = 0; row < 2; ++row)
      variation = std::max(variation, std::abs(inverse[2 * row]) * (spread_f[0] + spread_f[1]) +
                                          std::abs(inverse[2 * row + 1]) * (spread_g[0] + spread_g[1]));
    if (!(variation <= 0.5)) return false;
    double x = 0.5;
    double y = 0.5;
    for (int step = 0; step < 60; ++step) {
      const auto here_f = jet(f, x, y);
      const auto here_g = jet(g, x, y);
      const double dx = inverse[0] * here_f[0] + inverse[1] * here_g[0];
      const double dy = inverse[2] * here_f[0] + inverse[3] * here_g[0];
      // A root in this part is at most half a side away, which a step is at most half as much again of.
      if (step == 0 && std::max(std::abs(dx), std::abs(dy)) > 0.76) return true;
      x -= dx;
      y -= dy;
      if (std::max(std::abs(x - 0.5), std::abs(y - 0.5)) > 1) return true;
      if (std::max(std::abs(dx), std::abs(dy)) < 0x1p-52) break;
    }
    const double reach = beyond / side;
    if (std::max(std::abs(x - 0.5), std::abs(y - 0.5)) <= 0.5 + reach) roots.push_back({u + side * x, v + side * y});
    return true;
  }
};

}  // namespace

LatticeFaces::LatticeFaces(const Lattice& lattice) : lattice_(&lattice) {
  const auto& cells = lattice.cells();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t first = (axis + 1) % 3;
    const std::size_t second = (axis + 2) % 3;
    for (const bool is_last : {false, true})
      for (std::int64_t j = 0; j < cells[second]; ++j)
        for (std::int64_t i = 0; i < cells[first]; ++i) {
          Patch patch{.axis = axis, .is_last = is_last, .cell = {}, .points = {}};
          patch.cell[axis] = is_last ? cells[axis] - 1 : 0;
          patch.cell[first] = i;
          patch.cell[second] = j;
          const LatticeCell& cell = lattice.cell(patch.cell);
          std::array<Eigen::Vector3d, 9> powers;
          for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t a = 0; a < 3; ++a) {
              std::array<std::size_t, 3> exponents{};
              exponents[first] = a;
              exponents[second] = b;
              Eigen::Vector3d sum = Eigen::Vector3d::Zero();
              for (std::size_t c = 0; c < (is_last ? 3U : 1U); ++c) {
                exponents[axis] = c;
                sum += cell.powers[LatticeCell::index(exponents[0], exponents[1], exponents[2])];
              }
              powers[3 * b + a] = sum;
              if (a == 0 && b == 0) powers[0] += cell.centre;
            }
          // Powers to Bernstein coefficients: (p0, p0 + p1 / 2, p0 + p1 + p2) along both axes.
          for (const std::size_t stride : {std::size_t{1}, std::size_t{3}})
            for (std::size_t line = 0; line < 3; ++line) {
              const std::size_t k = line * (4 - stride);
              const Eigen::Vector3d middle = powers[k] + powers[k + stride] / 2;
              powers[k + 2 * stride] += powers[k] + powers[k + stride];
              powers[k + stride] = middle;
            }
          patch.points = powers;
          diagonal_ = std::max(diagonal_, (powers[8] - powers[0]).norm() + (powers[6] - powers[2]).norm());
          patches_.push_back(patch);
        }
  }
}

FaceCrossings LatticeFaces::operator()(const RayEquations& equations) const {
  FaceCrossings result;
  for (const Patch& patch : patches_) {
    std::array<Biquadratic, 2> f;
    bool is_met = true;
    for (std::size_t i = 0; i < 2 && is_met; ++i) {
      for (std::size_t k = 0; k < 9; ++k) f[i][k] = equations.value(i, patch.points[k]);
      is_met = !has_one_sign(f[i]);
    }
    if (!is_met) continue;
    PatchSearch search;
    search(f[0], f[1]);
    // A part that touches the ray is no longer along it than it is wide, as far as second order goes.
    result.in_doubt += 4 * search.in_doubt * diagonal_;
    for (const PatchSearch::Root& root : search.roots) {
      FaceCrossing crossing{.t = 0, .enters = false, .axis = patch.axis, .place = {.cell = patch.cell}};
      crossing.place.local[static_cast<Eigen::Index>(patch.axis)] = patch.is_last ? 1 : 0;
      crossing.place.local[static_cast<Eigen::Index>((patch.axis + 1) % 3)] = root.u;
      crossing.place.local[static_cast<Eigen::Index>((patch.axis + 2) % 3)] = root.v;
      const LatticeCell& cell = lattice_->cell(patch.cell);
      crossing.t = equations.t_of(cell.value(crossing.place.local));
      const Eigen::Matrix3d derivative = cell.derivative(crossing.place.local);
      std::array<Eigen::Vector3d, 2> gradient;
      for (std::size_t i = 0; i < 2; ++i)
        for (Eigen::Index axis = 0; axis < 3; ++axis) gradient[i][axis] = equations.along(i, derivative.col(axis));
      const auto a = static_cast<Eigen::Index>((patch.axis + 1) % 3);
      const auto b = static_cast<Eigen::Index>((patch.axis + 2) % 3);
      const double inwards = gradient[0][a] * gradient[1][b] - gradient[0][b] * gradient[1][a];
      crossing.enters = (inwards > 0) != patch.is_last;
      result.found.push_back(crossing);
    }
  }
  std::sort(result.found.begin(), result.found.end(), [](const FaceCrossing& one, const FaceCrossing& other) {
    return one.t < other.t || (one.t == other.t && one.enters < other.enters);
  });
  // Patches share borders, and faces edges: a crossing there is found by each.
  std::vector<FaceCrossing> once;
  for (const FaceCrossing& crossing : result.found) {
    const bool is_again =
        !once.empty() && once.back().enters == crossing.enters && crossing.t - once.back().t <= same * diagonal_;
    if (!is_again) once.push_back(crossing);
  }
  // What has no partner touches an edge: one of the other kind is beside it, or something is not understood.
  const auto drop = [&](std::size_t i) {
    const auto is_beside = [&](std::size_t other) { return std::abs(once[other].t - once[i].t) <= same * diagonal_; };
    const bool is_touch = (i > 0 && is_beside(i - 1)) || (i + 1 < once.size() && is_beside(i + 1));
    result.in_doubt += is_touch ? same * diagonal_ : std::numeric_limits<double>::infinity();
  };
  std::vector<FaceCrossing> in_turn;
  for (std::size_t i = 0; i < once.size(); ++i) {
    if (once[i].enters == (in_turn.size() % 2 == 0))
      in_turn.push_back(once[i]);
    else
      drop(i);
  }
  if (in_turn.size() % 2 == 1) {
    drop(once.size() - 1);
    in_turn.pop_back();
  }
  result.found = std::move(in_turn);
  return result;
}

}  // namespace raytruth
