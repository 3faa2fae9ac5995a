#include "raytruth/reference/arb/exact_passage.hpp"

#include "raytruth/reference/arb/rational_polynomial.hpp"

#include <algorithm>

namespace raytruth::arb {

namespace {

/// A zero of the piece's scalar less one of several.
struct Zero {
  Ball place;
  std::size_t scalar;
};

/// The zeros in (0, 1), in order; empty if so many bits do not tell all of them from the ends and from each other.
struct Zeros {
  std::vector<Zero> in_order;
  bool are_told_apart = true;
};

Zeros zeros_of(const std::vector<IntegerPolynomial>& polynomials, slong bits) {
  Zeros zeros;
  for (std::size_t i = 0; i < polynomials.size(); ++i)
    for (const Ball& place : polynomials[i].real_zeros(bits)) {
      const bool is_inside = Ball(0.0) < place && place < Ball(1.0);
      const bool is_outside = place < Ball(0.0) || Ball(1.0) < place;
      zeros.are_told_apart = zeros.are_told_apart && (is_inside || is_outside);
      if (is_inside) zeros.in_order.push_back({place, i});
    }
  std::sort(zeros.in_order.begin(), zeros.in_order.end(), [](const Zero& a, const Zero& b) {
    return arf_cmp(arb_midref(a.place.get()), arb_midref(b.place.get())) < 0;
  });
  for (std::size_t i = 1; i < zeros.in_order.size(); ++i)
    zeros.are_told_apart = zeros.are_told_apart && zeros.in_order[i - 1].place < zeros.in_order[i].place;
  return zeros;
}

}  // namespace

template <int Degree>
ExactPassage exact_passage(const PrecisePiece<Degree>& piece, const std::vector<double>& scalars) {
  const RationalPolynomial signal = polynomial_of(piece);
  ExactPassage passage;
  std::vector<IntegerPolynomial> polynomials;
  for (const double scalar : scalars) {
    const RationalPolynomial difference = signal.less(Rational(scalar));
    passage.first_signs.push_back(difference.sign_behind_0());
    polynomials.push_back(difference.sign_changes().without_zeros_at_0_and_1());
  }
  // No two zeros are one: those of a scalar are simple, and those of two scalars lie where the signal differs.
  slong bits = 128;
  Zeros zeros = zeros_of(polynomials, bits);
  while (!zeros.are_told_apart) zeros = zeros_of(polynomials, bits *= 2);
  std::vector<int> signs = passage.first_signs;
  for (const Zero& zero : zeros.in_order) {
    const double nearest = zero.place.nearest();
    const double rest = (zero.place - Ball(nearest)).nearest();
    passage.crossings.push_back({fast_two_sum(nearest, rest), zero.scalar, signs[zero.scalar] < 0});
    signs[zero.scalar] = -signs[zero.scalar];
  }
  return passage;
}

template ExactPassage exact_passage(const PrecisePiece<3>&, const std::vector<double>&);
template ExactPassage exact_passage(const PrecisePiece<largest_degree>&, const std::vector<double>&);

}  // namespace raytruth::arb
