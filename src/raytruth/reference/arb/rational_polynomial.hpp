#pragma once

#include "raytruth/core/double_double.hpp"
#include "raytruth/reference/arb/arb_numbers.hpp"
#include "raytruth/signals/precise_chain.hpp"

#include <boost/math/special_functions/binomial.hpp>

#include <arb_fmpz_poly.h>
#include <flint/fmpq_poly.h>
#include <flint/fmpz_poly_factor.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// Polynomials with rational coefficients, and where they change their signs, without rounding. For .cpp files only: it
/// needs the headers of FLINT and Arb.
namespace raytruth::arb {

/// A rational number, and what binary64 holds exactly.
class Rational {
 public:
  Rational() { fmpq_init(x_); }
  explicit Rational(double value) : Rational() {
    constexpr int digits = 53;
    int exponent = 0;
    const double fraction = std::frexp(value, &exponent);
    fmpz_set_d(fmpq_numref(x_), std::ldexp(fraction, digits));
    exponent -= digits;
    if (exponent >= 0)
      fmpz_mul_2exp(fmpq_numref(x_), fmpq_numref(x_), static_cast<ulong>(exponent));
    else
      fmpz_mul_2exp(fmpq_denref(x_), fmpq_denref(x_), static_cast<ulong>(-exponent));
    fmpq_canonicalise(x_);
  }
  explicit Rational(const DoubleDouble& value) : Rational(value.high) { fmpq_add(x_, x_, Rational(value.low).x_); }
  Rational(const Rational& other) : Rational() { fmpq_set(x_, other.x_); }
  Rational& operator=(const Rational& other) {
    fmpq_set(x_, other.x_);
    return *this;
  }
  ~Rational() { fmpq_clear(x_); }

  [[nodiscard]] const fmpq* get() const { return x_; }
  [[nodiscard]] int sign() const { return fmpq_sgn(x_); }

  friend Rational operator+(const Rational& a, const Rational& b) {
    Rational result;
    fmpq_add(result.x_, a.x_, b.x_);
    return result;
  }
  friend Rational operator*(const Rational& a, const Rational& b) {
    Rational result;
    fmpq_mul(result.x_, a.x_, b.x_);
    return result;
  }

 private:
  fmpq_t x_;
};

/// A place of a piece in 212 bits.
struct Place {
  DoubleDouble nearest;
  DoubleDouble rest;

  [[nodiscard]] Rational exact() const { return Rational(nearest) + Rational(rest); }

  friend auto operator<=>(const Place&, const Place&) = default;
};

/// A polynomial with whole coefficients.
class IntegerPolynomial {
 public:
  explicit IntegerPolynomial(slong constant = 0) {
    fmpz_poly_init(p_);
    fmpz_poly_set_si(p_, constant);
  }
  IntegerPolynomial(const IntegerPolynomial& other) : IntegerPolynomial() { fmpz_poly_set(p_, other.p_); }
  IntegerPolynomial& operator=(const IntegerPolynomial& other) {
    fmpz_poly_set(p_, other.p_);
    return *this;
  }
  ~IntegerPolynomial() { fmpz_poly_clear(p_); }

  /// Divided by x and by x - 1 as often as they divide it.
  [[nodiscard]] IntegerPolynomial without_zeros_at_0_and_1() const {
    IntegerPolynomial result = *this;
    IntegerPolynomial factor;
    fmpz_poly_set_coeff_si(factor.p_, 1, 1);
    for (const slong constant : {0L, -1L}) {
      fmpz_poly_set_coeff_si(factor.p_, 0, constant);
      IntegerPolynomial quotient;
      while (fmpz_poly_is_zero(result.p_) == 0 && fmpz_poly_divides(quotient.p_, result.p_, factor.p_) != 0)
        result = quotient;
    }
    return result;
  }

  /// The real zeros, one in every ball, to so many bits of each. The polynomial must have simple zeros only.
  [[nodiscard]] std::vector<Ball> real_zeros(slong bits) const {
    std::vector<Ball> result;
    const slong degree = fmpz_poly_degree(p_);
    if (degree < 1) return result;
    acb_ptr zeros = _acb_vec_init(degree);
    arb_fmpz_poly_complex_roots(zeros, p_, 0, bits);
    for (slong i = 0; i < degree; ++i) {
      if (arb_is_zero(acb_imagref(zeros + i)) == 0) continue;
      arb_set(result.emplace_back().get(), acb_realref(zeros + i));
    }
    _acb_vec_clear(zeros, degree);
    return result;
  }

 private:
  friend class RationalPolynomial;
  fmpz_poly_t p_;
};

/// A polynomial with rational coefficients.
class RationalPolynomial {
 public:
  RationalPolynomial() { fmpq_poly_init(p_); }
  RationalPolynomial(const RationalPolynomial& other) : RationalPolynomial() { fmpq_poly_set(p_, other.p_); }
  RationalPolynomial& operator=(const RationalPolynomial& other) {
    fmpq_poly_set(p_, other.p_);
    return *this;
  }
  ~RationalPolynomial() { fmpq_poly_clear(p_); }

  void set(std::size_t power, const Rational& coefficient) {
    fmpq_poly_set_coeff_fmpq(p_, static_cast<slong>(power), coefficient.get());
  }

  [[nodiscard]] RationalPolynomial less(const Rational& x) const {
    RationalPolynomial result;
    fmpq_poly_set_fmpq(result.p_, x.get());
    fmpq_poly_sub(result.p_, p_, result.p_);
    return result;
  }

  /// The sign between two places between which it does not change; 0 of nothing but zeros. It may vanish at some places
  /// there, at no more than its degree.
  [[nodiscard]] int sign_between(const Place& begin, const Place& end) const {
    Rational place = begin.exact();
    const Rational step = (end.exact() + Rational(-1.0) * place) * Rational(0x1p-4);
    for (slong i = 0; i <= std::max<slong>(fmpq_poly_degree(p_), 0); ++i) {
      place = place + step;
      if (const int sign = sign_at(place); sign != 0) return sign;
    }
    return 0;
  }

  [[nodiscard]] bool is_zero() const { return fmpq_poly_is_zero(p_) != 0; }

  /// The sign just behind 0: that of the lowest power.
  [[nodiscard]] int sign_behind_0() const {
    for (slong k = 0; k <= fmpq_poly_degree(p_); ++k) {
      fmpq_t coefficient;
      fmpq_init(coefficient);
      fmpq_poly_get_coeff_fmpq(coefficient, p_, k);
      const int sign = fmpq_sgn(coefficient);
      fmpq_clear(coefficient);
      if (sign != 0) return sign;
    }
    return 0;
  }

  /// The product of the factors of odd multiplicity: simple zeros, where the sign changes. 1 of nothing but zeros.
  [[nodiscard]] IntegerPolynomial sign_changes() const {
    IntegerPolynomial odd(1);
    if (fmpq_poly_degree(p_) < 1) return odd;
    IntegerPolynomial numerator;
    fmpq_poly_get_numerator(numerator.p_, p_);
    fmpz_poly_factor_t factors;
    fmpz_poly_factor_init(factors);
    fmpz_poly_factor_squarefree(factors, numerator.p_);
    for (slong i = 0; i < factors->num; ++i)
      if (factors->exp[i] % 2 == 1) fmpz_poly_mul(odd.p_, odd.p_, factors->p + i);
    fmpz_poly_factor_clear(factors);
    return odd;
  }

  /// Adds the places in (0, 1) where the sign changes.
  void add_sign_changes(std::vector<Place>& places) const {
    constexpr slong bits = 256;
    for (const Ball& root : sign_changes().real_zeros(bits)) {
      const Place place = nearest(root.get());
      if (DoubleDouble(0) < place.nearest && place.nearest < DoubleDouble(1)) places.push_back(place);
    }
  }

 private:
  [[nodiscard]] int sign_at(const Rational& x) const {
    fmpq_t value;
    fmpq_init(value);
    fmpq_poly_evaluate_fmpq(value, p_, x.get());
    const int sign = fmpq_sgn(value);
    fmpq_clear(value);
    return sign;
  }

  /// The middle of a ball, in four numbers.
  static Place nearest(arb_srcptr ball) {
    arf_t rest;
    arf_init(rest);
    arf_set(rest, arb_midref(ball));
    const auto take = [&rest] {
      const double part = arf_get_d(rest, ARF_RND_NEAR);
      arf_t taken;
      arf_init(taken);
      arf_set_d(taken, part);
      arf_sub(rest, rest, taken, ARF_PREC_EXACT, ARF_RND_NEAR);
      arf_clear(taken);
      return part;
    };
    Place place;
    for (double* const part : {&place.nearest.high, &place.nearest.low, &place.rest.high, &place.rest.low})
      *part = take();
    arf_clear(rest);
    return place;
  }

  fmpq_poly_t p_;
};

inline double binomial(std::size_t n, std::size_t k) {
  return boost::math::binomial_coefficient<double>(static_cast<unsigned>(n), static_cast<unsigned>(k));
}

/// The scalar of a piece in powers of u.
template <int Degree>
RationalPolynomial polynomial_of(const PrecisePiece<Degree>& piece) {
  RationalPolynomial result;
  if (!piece.powers.empty()) {
    Rational power(1.0);
    for (std::size_t k = 0; k < piece.powers.size(); ++k) {
      result.set(k, Rational(piece.powers[k]) * power);
      power = power * Rational(piece.extent);
    }
    return result;
  }
  const auto& b = piece.polynomial.coefficients;
  for (std::size_t k = 0; k <= Degree; ++k) {
    Rational sum;
    for (std::size_t i = 0; i <= k; ++i)
      sum = sum + Rational(((k - i) % 2 == 0 ? 1 : -1) * binomial(Degree, k) * binomial(k, i)) * Rational(b[i]);
    result.set(k, sum);
  }
  return result;
}

}  // namespace raytruth::arb
