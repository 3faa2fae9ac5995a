#pragma once

#include "raytruth/core/sign_changes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace raytruth {

/// The line from a at u = 0 to b at u = 1, exact at both ends; constant data stay constant; the error is below 1.5 ulp
/// of max(|a|, |b|).
template <class Real>
Real interpolate(const Real& a, const Real& b, const Real& u) {
  // It counts from the nearer end, by two selections and no branch: loops over this become vector code.
  const bool near_a = u < Real(0.5);
  const Real weight = near_a ? u : Real(u - Real(1));
  return (near_a ? a : b) + weight * (b - a);
}

/// A polynomial p(u) = sum_i b_i B_i(u), B_i(u) = binomial(n, i) u^i (1 - u)^(n - i), on 0 <= u <= 1, n = Degree.
///
/// The coefficients bound the polynomial, its end values are the first and the last coefficient bit by bit, and all
/// operations below are convex combinations, so that rounding stays within a few ulps of the largest coefficient
/// (G. Farin, Curves and Surfaces for CAGD, chapters 5 and 6).
template <int Degree, class Real = double>
struct Bernstein {
  static_assert(Degree >= 0);
  static constexpr int degree = Degree;

  std::array<Real, Degree + 1> coefficients{};

  /// p(u) by de Casteljau's algorithm.
  [[nodiscard]] Real value(const Real& u) const {
    auto points = coefficients;
    reduce(points, Degree, 0, u);
    return points[0];
  }

  /// p on [0, u] and on [u, 1], each on its own unit interval; both meet in the bits of value(u).
  [[nodiscard]] std::pair<Bernstein, Bernstein> split(const Real& u) const {
    std::pair<Bernstein, Bernstein> parts{{}, *this};
    auto& points = parts.second.coefficients;
    for (std::size_t last = Degree; last > 0; --last) {
      parts.first.coefficients[Degree - last] = points[0];
      for (std::size_t i = 0; i < last; ++i) points[i] = interpolate(points[i], points[i + 1], u);
    }
    parts.first.coefficients[Degree] = points[0];
    return parts;
  }

  /// p on [begin, end], on a unit interval of its own; begin may lie behind end. Coefficient i is the polar form of p
  /// at n - i times begin and i times end, so its end values are the bits of value(begin) and value(end).
  [[nodiscard]] Bernstein restricted(const Real& begin, const Real& end) const {
    if (begin == Real(0)) return end == Real(1) ? *this : split(end).first;
    if (end == Real(1)) return split(begin).second;
    Bernstein part;
    auto at_begin = coefficients;
    for (std::size_t i = Degree + 1; i-- > 0;) {
      auto points = at_begin;
      reduce(points, i, 0, end);
      part.coefficients[i] = points[0];
      if (i > 0) reduce(at_begin, i, i - 1, begin);
    }
    return part;
  }

  /// dp/du.
  [[nodiscard]] Bernstein<std::max(Degree - 1, 0), Real> derivative() const {
    Bernstein<std::max(Degree - 1, 0), Real> result;
    for (std::size_t i = 0; i < Degree; ++i)
      result.coefficients[i] = Real(Degree) * (coefficients[i + 1] - coefficients[i]);
    return result;
  }

  /// The integral of p from 0 to u.
  [[nodiscard]] Bernstein<Degree + 1, Real> antiderivative() const {
    Bernstein<Degree + 1, Real> result;
    for (std::size_t i = 0; i <= Degree; ++i)
      result.coefficients[i + 1] = result.coefficients[i] + coefficients[i] / Real(Degree + 1);
    return result;
  }

  /// The integral of p from 0 to 1: the mean of the coefficients.
  [[nodiscard]] Real integral() const {
    Real sum(0);
    for (const Real& coefficient : coefficients) sum = sum + coefficient;
    return sum / Real(Degree + 1);
  }

  /// This polynomial, written in a higher degree.
  template <int Higher>
  [[nodiscard]] Bernstein<Higher, Real> elevated() const {
    static_assert(Higher >= Degree);
    if constexpr (Higher == Degree) {
      return *this;
    } else {
      Bernstein<Degree + 1, Real> result;
      result.coefficients.front() = coefficients.front();
      result.coefficients.back() = coefficients.back();
      for (std::size_t i = 1; i <= Degree; ++i)
        result.coefficients[i] = coefficients[i] + Real(i) * (coefficients[i - 1] - coefficients[i]) / Real(Degree + 1);
      return result.template elevated<Higher>();
    }
  }

  /// Where p changes sign inside (0, 1), ascending; see `sign_changes`.
  [[nodiscard]] SignChanges<Real, Degree> sign_changes() const {
    return raytruth::sign_changes<Real, Degree>(coefficients);
  }

  /// Smallest and largest value on [0, 1]: of the end values and of the values where the derivative changes sign.
  [[nodiscard]] std::pair<Real, Real> range() const {
    auto [low, high] = std::minmax(coefficients.front(), coefficients.back());
    const auto inside = [low = low, high = high](const Real& b) { return low <= b && b <= high; };
    if (std::all_of(coefficients.begin(), coefficients.end(), inside)) return {low, high};
    std::pair<Real, Real> result{low, high};
    for (const Real& u : derivative().sign_changes()) {
      const Real extremum = value(u);
      result.first = std::min(result.first, extremum);
      result.second = std::max(result.second, extremum);
    }
    return result;
  }

  /// The integral of |p| from 0 to 1: the variation of the antiderivative between the sign changes of p.
  [[nodiscard]] Real integral_of_magnitude() const {
    using std::abs;
    const auto positive = [](const Real& b) { return b >= Real(0); };
    const auto negative = [](const Real& b) { return b <= Real(0); };
    if (std::all_of(coefficients.begin(), coefficients.end(), positive) ||
        std::all_of(coefficients.begin(), coefficients.end(), negative))
      return abs(integral());
    const auto primitive = antiderivative();
    Real sum(0);
    Real before(0);
    for (const Real& u : sign_changes()) {
      const Real here = primitive.value(u);
      sum = sum + abs(here - before);
      before = here;
    }
    return sum + abs(primitive.coefficients.back() - before);
  }

  friend Bernstein operator-(const Bernstein& a, const Bernstein& b) {
    Bernstein difference;
    for (std::size_t i = 0; i <= Degree; ++i) difference.coefficients[i] = a.coefficients[i] - b.coefficients[i];
    return difference;
  }

  friend bool operator==(const Bernstein&, const Bernstein&) = default;

 private:
  /// De Casteljau's steps at u, from points 0 ... from to points 0 ... to.
  static void reduce(std::array<Real, Degree + 1>& points, std::size_t from, std::size_t to, const Real& u) {
    for (std::size_t last = from; last > to; --last)
      for (std::size_t i = 0; i < last; ++i) points[i] = interpolate(points[i], points[i + 1], u);
  }
};

}  // namespace raytruth
