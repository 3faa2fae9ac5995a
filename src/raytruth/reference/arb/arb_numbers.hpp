#pragma once

#include "raytruth/core/double_double.hpp"

#include <acb_poly.h>
#include <arb_poly.h>

#include <algorithm>
#include <utility>

/// Arb's balls and polynomials as values with operators (F. Johansson, Arb: efficient arbitrary-precision
/// midpoint-radius interval arithmetic, 2017). For .cpp files only: it needs Arb's headers.
namespace raytruth::arb {

/// Bits of the midpoints, more than twice those of binary64: what data of binary64 are made into here is exact, or as
/// good as.
inline constexpr slong precision = 128;

/// A real number that lies somewhere within a radius of a midpoint.
class Ball {
 public:
  Ball() { arb_init(x_); }
  // Implicit: a binary64 number is a ball of radius 0.
  Ball(double value) : Ball() { arb_set_d(x_, value); }  // NOLINT(google-explicit-constructor)
  Ball(const DoubleDouble& value) : Ball(value.high) {   // NOLINT(google-explicit-constructor)
    arb_add(x_, x_, Ball(value.low).x_, precision);
  }
  Ball(const Ball& other) : Ball() { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(x_, other.x_); }
  Ball& operator=(const Ball& other) {
    arb_set(x_, other.x_);
    return *this;
  }
  Ball& operator=(Ball&& other) noexcept {
    arb_swap(x_, other.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  [[nodiscard]] arb_ptr get() { return x_; }
  [[nodiscard]] arb_srcptr get() const { return x_; }

  [[nodiscard]] Ball middle() const {
    Ball result;
    arf_set(arb_midref(result.x_), arb_midref(x_));
    return result;
  }
  [[nodiscard]] Ball radius() const {
    Ball result;
    arf_set_mag(arb_midref(result.x_), arb_radref(x_));
    return result;
  }
  /// Bounds, exact numbers.
  [[nodiscard]] Ball lower() const {
    Ball result;
    arb_get_lbound_arf(arb_midref(result.x_), x_, precision);
    return result;
  }
  [[nodiscard]] Ball upper() const {
    Ball result;
    arb_get_ubound_arf(arb_midref(result.x_), x_, precision);
    return result;
  }
  /// The largest magnitude, as an exact number.
  [[nodiscard]] Ball magnitude() const {
    Ball result;
    arb_get_abs_ubound_arf(arb_midref(result.x_), x_, precision);
    return result;
  }
  /// -1, 0 or 1: the sign of every number in the ball, 0 where they differ or all are 0.
  [[nodiscard]] int sign() const { return arb_is_positive(x_) ? 1 : arb_is_negative(x_) ? -1 : 0; }

  [[nodiscard]] double nearest() const { return arf_get_d(arb_midref(x_), ARF_RND_NEAR); }
  [[nodiscard]] double upper_double() const { return arf_get_d(arb_midref(upper().x_), ARF_RND_CEIL); }

  friend Ball operator+(const Ball& a, const Ball& b) { return make(arb_add, a, b); }
  friend Ball operator-(const Ball& a, const Ball& b) { return make(arb_sub, a, b); }
  friend Ball operator*(const Ball& a, const Ball& b) { return make(arb_mul, a, b); }
  friend Ball operator/(const Ball& a, const Ball& b) { return make(arb_div, a, b); }
  friend Ball operator-(const Ball& a) {
    Ball result;
    arb_neg(result.x_, a.x_);
    return result;
  }
  Ball& operator+=(const Ball& other) {
    arb_add(x_, x_, other.x_, precision);
    return *this;
  }

  /// Whether it is certainly so; not certain is false.
  friend bool operator<(const Ball& a, const Ball& b) { return arb_lt(a.x_, b.x_) != 0; }
  friend bool operator<=(const Ball& a, const Ball& b) { return arb_le(a.x_, b.x_) != 0; }

  friend Ball exp(const Ball& a) { return make(arb_exp, a); }
  friend Ball log(const Ball& a) { return make(arb_log, a); }
  friend Ball expm1(const Ball& a) { return make(arb_expm1, a); }
  friend Ball sqrt(const Ball& a) { return make(arb_sqrt, a); }
  friend Ball min(const Ball& a, const Ball& b) { return make(arb_min, a, b); }
  friend Ball max(const Ball& a, const Ball& b) { return make(arb_max, a, b); }
  /// The smallest ball over both.
  friend Ball hull(const Ball& a, const Ball& b) { return make(arb_union, a, b); }
  /// value +- error.
  friend Ball widened(Ball value, const Ball& error) {
    arb_add_error(value.x_, error.x_);
    return value;
  }
  static Ball pi() {
    Ball result;
    arb_const_pi(result.x_, precision);
    return result;
  }

 private:
  static Ball make(void (*function)(arb_t, const arb_t, slong), const Ball& a) {
    Ball result;
    function(result.x_, a.x_, precision);
    return result;
  }
  static Ball make(void (*function)(arb_t, const arb_t, const arb_t, slong), const Ball& a, const Ball& b) {
    Ball result;
    function(result.x_, a.x_, b.x_, precision);
    return result;
  }

  arb_t x_{};
};

/// A polynomial in x with balls as coefficients, in ascending powers. It stands for any function whose value at every x
/// of an interval lies in the polynomial's ball there; sums, products and antiderivatives (for x >= 0) keep that.
class Polynomial {
 public:
  Polynomial() { arb_poly_init(p_); }
  Polynomial(const Ball& constant) : Polynomial() { set(0, constant); }  // NOLINT(google-explicit-constructor)
  Polynomial(double constant) : Polynomial(Ball(constant)) {}            // NOLINT(google-explicit-constructor)
  Polynomial(const Polynomial& other) : Polynomial() { arb_poly_set(p_, other.p_); }
  Polynomial(Polynomial&& other) noexcept : Polynomial() { arb_poly_swap(p_, other.p_); }
  Polynomial& operator=(const Polynomial& other) {
    arb_poly_set(p_, other.p_);
    return *this;
  }
  Polynomial& operator=(Polynomial&& other) noexcept {
    arb_poly_swap(p_, other.p_);
    return *this;
  }
  ~Polynomial() { arb_poly_clear(p_); }

  [[nodiscard]] arb_poly_struct* get() { return p_; }
  [[nodiscard]] const arb_poly_struct* get() const { return p_; }

  [[nodiscard]] slong size() const { return arb_poly_length(p_); }
  [[nodiscard]] Ball coefficient(slong k) const {
    Ball result;
    arb_poly_get_coeff_arb(result.get(), p_, k);
    return result;
  }
  void set(slong k, const Ball& coefficient) { arb_poly_set_coeff_arb(p_, k, coefficient.get()); }

  [[nodiscard]] Ball operator()(const Ball& x) const {
    Ball result;
    arb_poly_evaluate_horner(result.get(), p_, x.get(), precision);
    return result;
  }
  [[nodiscard]] Polynomial derivative() const {
    Polynomial result;
    arb_poly_derivative(result.p_, p_, precision);
    return result;
  }
  /// The integral from 0.
  [[nodiscard]] Polynomial antiderivative() const {
    Polynomial result;
    arb_poly_integral(result.p_, p_, precision);
    return result;
  }
  /// p(begin + (end - begin) x).
  [[nodiscard]] Polynomial restricted(const Ball& begin, const Ball& end) const {
    Polynomial result;
    arb_poly_taylor_shift_horner(result.p_, p_, begin.get(), precision);
    const Ball width = end - begin;
    Ball power = 1.0;
    for (slong k = 0; k < result.size(); ++k, power = power * width)
      arb_mul(result.p_->coeffs + k, result.p_->coeffs + k, power.get(), precision);
    return result;
  }
  /// The polynomial of the midpoints, exact.
  [[nodiscard]] Polynomial middle() const {
    Polynomial result = *this;
    for (slong k = 0; k < result.size(); ++k) mag_zero(arb_radref(result.p_->coeffs + k));
    return result;
  }
  /// How far the function can be from `middle` on [-1, 1]: the sum of the radii.
  [[nodiscard]] Ball error() const {
    Ball sum;
    for (slong k = 0; k < size(); ++k) sum += coefficient(k).radius();
    return sum.upper();
  }
  /// A bound on [-1, 1]: the sum of the magnitudes.
  [[nodiscard]] Ball magnitude() const {
    Ball sum;
    for (slong k = 0; k < size(); ++k) sum += coefficient(k).magnitude();
    return sum.upper();
  }

  /// The polynomial without the highest powers, which the constant covers on [-1, 1], as long as they are below 2^-bits
  /// of the rest.
  [[nodiscard]] Polynomial trimmed(slong bits) const {
    Polynomial result = *this;
    Ball tolerance = magnitude();
    arb_mul_2exp_si(tolerance.get(), tolerance.get(), -bits);
    Ball removed;
    while (result.size() > 1) {
      const Ball sum = removed + result.coefficient(result.size() - 1).magnitude();
      if (!(sum <= tolerance)) break;
      removed = sum;
      arb_poly_truncate(result.p_, result.size() - 1);
    }
    result.set(0, widened(result.coefficient(0), removed));
    return result;
  }

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b) { return make(arb_poly_add, a, b); }
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b) { return make(arb_poly_sub, a, b); }
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) { return make(arb_poly_mul, a, b); }
  friend Polynomial operator*(const Ball& a, const Polynomial& b) {
    Polynomial result;
    arb_poly_scalar_mul(result.p_, b.p_, a.get(), precision);
    return result;
  }

 private:
  static Polynomial make(void (*function)(arb_poly_t, const arb_poly_t, const arb_poly_t, slong), const Polynomial& a,
                         const Polynomial& b) {
    Polynomial result;
    function(result.p_, a.p_, b.p_, precision);
    return result;
  }

  arb_poly_t p_{};
};

}  // namespace raytruth::arb
