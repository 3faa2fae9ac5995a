#pragma once

#include "raytruth/reference/arb/arb_numbers.hpp"

#include <functional>
#include <optional>

namespace raytruth::arb {

/// A power series in x, cut behind `order` coefficients. Its operations are exact in the coefficients that are left.
class Series {
 public:
  Series(Polynomial polynomial, slong order) : polynomial_(std::move(polynomial)), order_(order) {}

  [[nodiscard]] const Polynomial& polynomial() const { return polynomial_; }
  [[nodiscard]] slong order() const { return order_; }

  friend Series operator+(const Series& a, const Series& b) { return {a.polynomial_ + b.polynomial_, a.order_}; }
  friend Series operator-(const Series& a, const Series& b) { return {a.polynomial_ - b.polynomial_, a.order_}; }
  friend Series operator*(const Series& a, const Series& b) {
    Series result({}, a.order_);
    arb_poly_mullow(result.polynomial_.get(), a.polynomial_.get(), b.polynomial_.get(), a.order_, precision);
    return result;
  }
  friend Series operator+(const Ball& a, const Series& b) { return {Polynomial(a) + b.polynomial_, b.order_}; }
  friend Series operator-(const Ball& a, const Series& b) { return {Polynomial(a) - b.polynomial_, b.order_}; }
  friend Series operator*(const Ball& a, const Series& b) { return {a * b.polynomial_, b.order_}; }

  friend Series sin(const Series& a) { return a.mapped(arb_poly_sin_series); }
  friend Series cos(const Series& a) { return a.mapped(arb_poly_cos_series); }
  friend Series log(const Series& a) { return a.mapped(arb_poly_log_series); }
  friend Series exp(const Series& a) { return a.mapped(arb_poly_exp_series); }

 private:
  [[nodiscard]] Series mapped(void (*function)(arb_poly_t, const arb_poly_t, slong, slong)) const {
    Series result({}, order_);
    function(result.polynomial_.get(), polynomial_.get(), order_, precision);
    return result;
  }

  Polynomial polynomial_;
  slong order_;
};

/// An analytic function, written for power series of its argument.
using Formula = std::function<Series(const Series&)>;

/// A polynomial in x on [0, 1] that encloses f(begin + (end - begin) x) at every x: Taylor's polynomial about the
/// middle, its constant widened by Lagrange's remainder, a coefficient of the series about the whole interval.
/// Nothing where that remainder is above `largest_remainder`, if there is one.
inline std::optional<Polynomial> taylor_model(const Formula& f, const Ball& begin, const Ball& end,
                                              const std::optional<Ball>& largest_remainder) {
  // The costs of longer series and of more pieces balance about here.
  constexpr slong order = 28;
  const auto about = [&](const Ball& centre, slong terms) {
    Polynomial argument(centre);
    argument.set(1, (end - begin) / 2);
    return f(Series(argument, terms)).polynomial();
  };
  const Ball remainder = about(hull(begin, end), order + 1).coefficient(order).magnitude();
  if (largest_remainder && !(remainder <= *largest_remainder)) return {};
  Polynomial taylor = about(((begin + end) / 2).middle(), order);
  taylor.set(0, widened(taylor.coefficient(0), remainder));
  return taylor.restricted(-1.0, 1.0);
}

}  // namespace raytruth::arb
