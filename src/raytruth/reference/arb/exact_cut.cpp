#include "raytruth/reference/arb/exact_cut.hpp"

#include "raytruth/reference/arb/rational_polynomial.hpp"

#include <algorithm>

namespace raytruth::arb {

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
