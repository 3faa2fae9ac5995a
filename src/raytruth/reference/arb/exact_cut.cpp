#include "raytruth/reference/arb/exact_cut.hpp"

#include <boost/math/special_functions/binomial.hpp>

#include <arb_fmpz_poly.h>
#include <flint/fmpq_poly.h>
#include <flint/fmpz_poly_factor.h>

#include <algorithm>
#include <cmath>

namespace raytruth::arb {

namespace {

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

  /// Adds the places in (0, 1) where the sign changes.
  void add_sign_changes(std::vector<Place>& places) const {
    if (fmpq_poly_degree(p_) < 1) return;
    fmpz_poly_t numerator;
    fmpz_poly_t odd;
    fmpz_poly_factor_t factors;
    fmpz_poly_init(numerator);
    fmpz_poly_init(odd);
    fmpz_poly_factor_init(factors);
    fmpq_poly_get_numerator(numerator, p_);
    fmpz_poly_factor_squarefree(factors, numerator);
    fmpz_poly_one(odd);
    for (slong i = 0; i < factors->num; ++i)
      if (factors->exp[i] % 2 == 1) fmpz_poly_mul(odd, odd, factors->p + i);
    if (const slong degree = fmpz_poly_degree(odd); degree > 0) {
      constexpr slong bits = 256;
      acb_ptr roots = _acb_vec_init(degree);
      arb_fmpz_poly_complex_roots(roots, odd, 0, bits);
      for (slong i = 0; i < degree; ++i) {
        if (arb_is_zero(acb_imagref(roots + i)) == 0) continue;
        const Place place = nearest(acb_realref(roots + i));
        if (DoubleDouble(0) < place.nearest && place.nearest < DoubleDouble(1)) places.push_back(place);
      }
      _acb_vec_clear(roots, degree);
    }
    fmpz_poly_factor_clear(factors);
    fmpz_poly_clear(odd);
    fmpz_poly_clear(numerator);
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
  static Place nearest(const arb_t ball) {
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

double binomial(std::size_t n, std::size_t k) {
  return boost::math::binomial_coefficient<double>(static_cast<unsigned>(n), static_cast<unsigned>(k));
}

/// The scalar in powers of u.
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

}  // namespace

template <int Degree>
std::vector<CutPart> exact_cut(const PrecisePiece<Degree>& piece, const std::vector<double>& knots) {
  const RationalPolynomial signal = polynomial_of(piece);
  const double error = piece.powers.empty() ? piece.error : 0;
  // The signal less each knot, above it and below it by the error.
  std::vector<RationalPolynomial> above;
  std::vector<RationalPolynomial> below;
  std::vector<Place> places{{0.0, {}}, {1.0, {}}};
  for (const double knot : knots) {
    above.push_back(signal.less(Rational(knot) + Rational(error)));
    above.back().add_sign_changes(places);
    if (error == 0) continue;
    below.push_back(signal.less(Rational(knot) + Rational(-error)));
    below.back().add_sign_changes(places);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());

  std::vector<CutPart> parts;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Place& begin = places[i];
    const Place& end = places[i + 1];
    CutPart part{
        .begin = begin.nearest, .end = end.nearest, .width = (end.nearest - begin.nearest) + (end.rest - begin.rest)};
    for (std::size_t k = 0; k < knots.size(); ++k) {
      if (above[k].sign_between(begin, end) >= 0)
        part.first_interval = part.last_interval = k + 1;
      else if (error > 0 && below[k].sign_between(begin, end) > 0)
        part.last_interval = k + 1;
    }
    parts.push_back(part);
  }
  return parts;
}

template std::vector<CutPart> exact_cut(const PrecisePiece<3>&, const std::vector<double>&);
template std::vector<CutPart> exact_cut(const PrecisePiece<largest_degree>&, const std::vector<double>&);

}  // namespace raytruth::arb
