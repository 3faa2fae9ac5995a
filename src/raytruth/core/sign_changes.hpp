#pragma once

#include <boost/container/static_vector.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace raytruth {

/// Abscissae in (0, 1), ascending; a polynomial of degree n changes its sign at most n times.
template <class Real, int Degree>
using SignChanges = boost::container::static_vector<Real, Degree + 1>;

namespace detail {

template <class Real>
int sign(const Real& x) {
  return (Real(0) < x) - (x < Real(0));
}

/// Bisection by Descartes' rule of signs in the Bernstein basis (J. M. Lane and R. F. Riesenfeld, Bounds on a
/// polynomial, 1981): no variation in the coefficients, no sign change; one variation, exactly one; else halve.
template <class Real, int Degree>
class SignChangeSearch {
 public:
  explicit SignChangeSearch(Real noise) : noise_(std::move(noise)) {}

  struct Polynomial {
    std::array<Real, Degree + 1> coefficients;
    std::size_t degree;
  };

  void search(Polynomial p, const Real& begin, const Real& width) {
    if (!divide_out_end_zeros(p)) return;
    const auto first = p.coefficients.begin();
    const auto last = first + static_cast<std::ptrdiff_t>(p.degree);
    const int first_sign = sign(*first);
    const int last_sign = sign(*last);
    const int variations = count_variations(p);
    const bool resolved = variations < 2;
    if (!resolved && (width <= std::numeric_limits<Real>::epsilon() || is_noise(p))) {
      // A cluster too tight to tell apart: only whether the sign differs on its two sides matters.
      enter(first_sign, begin);
      enter(last_sign, begin + width / Real(2));
    } else if (!resolved) {
      Polynomial left{{}, p.degree};
      halve(p, left);
      search(left, begin, width / Real(2));
      search(p, begin + width / Real(2), width / Real(2));
    } else {
      enter(first_sign, begin);
      if (variations == 1) enter(last_sign, begin + width * crossing(p));
    }
  }

  [[nodiscard]] const SignChanges<Real, Degree>& found() const { return found_; }

 private:
  /// From `abscissa` on the polynomial has this sign.
  void enter(int sign_here, const Real& abscissa) {
    if (sign_ != 0 && sign_here != sign_ && found_.size() < Degree) found_.push_back(abscissa);
    sign_ = sign_here;
  }

  /// Divides by u, or by 1 - u, where the end value is exactly zero; neither changes a sign inside.
  /// False for the zero polynomial.
  static bool divide_out_end_zeros(Polynomial& p) {
    auto& b = p.coefficients;
    while (b[0] == Real(0)) {
      if (p.degree == 0) return false;
      for (std::size_t i = 0; i < p.degree; ++i) b[i] = b[i + 1] * Real(p.degree) / Real(i + 1);
      --p.degree;
    }
    while (b[p.degree] == Real(0)) {
      for (std::size_t i = 0; i < p.degree; ++i) b[i] = b[i] * Real(p.degree) / Real(p.degree - i);
      --p.degree;
    }
    return true;
  }

  static int count_variations(const Polynomial& p) {
    int variations = 0;
    int before = 0;
    for (std::size_t i = 0; i <= p.degree; ++i) {
      const int here = sign(p.coefficients[i]);
      if (here == 0) continue;
      if (before != 0 && here != before) ++variations;
      before = here;
    }
    return variations;
  }

  [[nodiscard]] bool is_noise(const Polynomial& p) const {
    return std::all_of(p.coefficients.begin(), p.coefficients.begin() + static_cast<std::ptrdiff_t>(p.degree) + 1,
                       [&](const Real& b) { return b <= noise_ && -b <= noise_; });
  }

  /// p becomes its right half, `left` the left one.
  static void halve(Polynomial& p, Polynomial& left) {
    for (std::size_t last = p.degree; last > 0; --last) {
      left.coefficients[p.degree - last] = p.coefficients[0];
      for (std::size_t i = 0; i < last; ++i) p.coefficients[i] = (p.coefficients[i] + p.coefficients[i + 1]) / Real(2);
    }
    left.coefficients[p.degree] = p.coefficients[0];
  }

  /// The only zero of p in (0, 1); its end values differ in sign.
  static Real crossing(const Polynomial& p) {
    const Real& first = p.coefficients.front();
    const Real& last = p.coefficients[p.degree];
    if constexpr (Degree > 1) {
      if (p.degree > 1) return bracketed_zero(p, first, last);
    }
    return first / (first - last);
  }

  static Real bracketed_zero(const Polynomial& p, const Real& first, const Real& last) {
    const auto value = [&p](const Real& u) {
      auto points = p.coefficients;
      for (std::size_t end = p.degree; end > 0; --end)
        for (std::size_t i = 0; i < end; ++i) points[i] = points[i] + u * (points[i + 1] - points[i]);
      return points[0];
    };
    std::uintmax_t evaluations = 200;
    const boost::math::tools::eps_tolerance<Real> tolerance(std::numeric_limits<Real>::digits);
    const auto bracket =
        boost::math::tools::toms748_solve(value, Real(0), Real(1), first, last, tolerance, evaluations);
    return (bracket.first + bracket.second) / Real(2);
  }

  Real noise_;
  int sign_ = 0;
  SignChanges<Real, Degree> found_;
};

}  // namespace detail

/// Where a polynomial with these Bernstein coefficients changes sign inside (0, 1), ascending.
///
/// A zero without a sign change is not reported. Zeros closer together than rounding can tell (a piece on which all
/// coefficients are below 2 ulp of the largest) count as one place, with or without a change of sign.
template <class Real, int Degree>
SignChanges<Real, Degree> sign_changes(const std::array<Real, Degree + 1>& coefficients) {
  Real largest(0);
  for (const Real& b : coefficients) largest = std::max(largest, b < Real(0) ? Real(-b) : b);
  detail::SignChangeSearch<Real, Degree> search(largest * std::numeric_limits<Real>::epsilon());
  search.search({coefficients, Degree}, Real(0), Real(1));
  return search.found();
}

}  // namespace raytruth
