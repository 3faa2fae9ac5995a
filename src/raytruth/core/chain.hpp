#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/double_double.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace raytruth {

/// The largest degree of a piece: that of a ray through a tricubic field. Higher ones are refused.
inline constexpr int largest_degree = 9;

/// A polynomial on [start, start + length] of a ray, in the local coordinate u = (t - start) / length.
template <int Degree, class Real = double>
struct Piece {
  Abscissa<Real> start{};
  Real length{};
  Bernstein<Degree, Real> polynomial{};

  /// u of t.
  [[nodiscard]] Real local(const Abscissa<Real>& t) const { return static_cast<Real>(t - start) / length; }
};

/// A piecewise polynomial along a ray: pieces in order, each starting where the one before ends, the first at t = 0.
/// Where two pieces disagree at a common border the right-hand one counts. Without pieces: a ray of length 0.
template <int Degree, class Real = double>
struct Chain {
  std::vector<Piece<Degree, Real>> pieces;
  Abscissa<Real> end{};

  [[nodiscard]] Real length() const { return static_cast<Real>(end); }

  [[nodiscard]] Abscissa<Real> end_of(std::size_t piece) const {
    return piece + 1 < pieces.size() ? pieces[piece + 1].start : end;
  }

  /// The piece that holds t; the first or last one beyond the ends. The chain must have pieces.
  [[nodiscard]] std::size_t index_at(const Abscissa<Real>& t) const {
    const auto after = std::upper_bound(pieces.begin() + 1, pieces.end(), t,
                                        [](const auto& x, const auto& piece) { return x < piece.start; });
    return static_cast<std::size_t>(after - pieces.begin()) - 1;
  }

  /// s(t).
  [[nodiscard]] Real value(const Abscissa<Real>& t) const {
    const auto& piece = pieces[index_at(t)];
    return piece.polynomial.value(piece.local(t));
  }

  /// Smallest and largest value. The chain must have pieces.
  [[nodiscard]] std::pair<Real, Real> range() const {
    auto result = pieces.front().polynomial.range();
    for (const auto& piece : pieces) {
      const auto [low, high] = piece.polynomial.range();
      result.first = std::min(result.first, low);
      result.second = std::max(result.second, high);
    }
    return result;
  }

  /// Whether all coefficients are one number, so that the signal is constant exactly.
  [[nodiscard]] bool is_constant() const {
    return std::all_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
      const auto& b = piece.polynomial.coefficients;
      return std::all_of(b.begin(), b.end(),
                         [&](const Real& x) { return x == pieces.front().polynomial.coefficients.front(); });
    });
  }
};

/// Calls visit(p, q, length) for every maximal interval on which both chains are one polynomial each: the two
/// polynomials on the interval's own unit coordinate, and its length. The chains must have the same length.
template <int DegreeA, int DegreeB, class Real, class Visit>
void for_each_common_interval(const Chain<DegreeA, Real>& a, const Chain<DegreeB, Real>& b, Visit&& visit) {
  Abscissa<Real> t{};
  Real u_begin(0);
  Real v_begin(0);
  for (std::size_t i = 0, j = 0; i < a.pieces.size() && j < b.pieces.size();) {
    const auto a_end = a.end_of(i);
    const auto b_end = b.end_of(j);
    const auto t_end = std::min(a_end, b_end);
    // The ends of pieces are hit exactly, so that common end values cancel to the last bit.
    const Real u_end = t_end == a_end ? Real(1) : a.pieces[i].local(t_end);
    const Real v_end = t_end == b_end ? Real(1) : b.pieces[j].local(t_end);
    if (t < t_end)
      visit(a.pieces[i].polynomial.restricted(u_begin, u_end), b.pieces[j].polynomial.restricted(v_begin, v_end),
            static_cast<Real>(t_end - t));
    t = t_end;
    u_begin = u_end;
    v_begin = v_end;
    if (t_end == a_end) {
      ++i;
      u_begin = Real(0);
    }
    if (t_end == b_end) {
      ++j;
      v_begin = Real(0);
    }
  }
}

}  // namespace raytruth
