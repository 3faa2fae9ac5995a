#include "raytruth/reference/surface_integral.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

constexpr double unit_roundoff = 0x1p-53;
constexpr double slack = 1 + 0x1p-20;
constexpr double rounding = 0x1p-92;  // of the largest coefficient: de Casteljau's steps in pairs

template <int Degree>
DoubleDouble length_of(const PrecisePiece<Degree>& piece) {
  return DoubleDouble(0) < piece.extent ? piece.extent : DoubleDouble(piece.length);
}

/// A piece from u to u.
template <int Degree>
PrecisePiece<Degree> part_of(const PrecisePiece<Degree>& piece, const DoubleDouble& begin, const DoubleDouble& end) {
  if (begin == DoubleDouble(0) && end == DoubleDouble(1)) return piece;
  PrecisePiece<Degree> part;
  part.polynomial = piece.polynomial.restricted(begin, end);
  double largest = 0;
  for (const DoubleDouble& b : piece.polynomial.coefficients) largest = std::max(largest, std::abs(b.high));
  part.error = slack * (piece.error + rounding * largest);
  part.extent = length_of(piece) * (end - begin);
  part.length = static_cast<double>(part.extent);
  return part;
}

/// The part of a ray that has been put together.
struct Front {
  Vector3<double> color = Vector3<double>::Constant(0);
  double color_error = 0;
  double opacity = 0;  ///< so that faint matter keeps its digits
  double transmittance = 1;
  double transmittance_error = 0;

  /// Behind it comes something, its colour and opacity off by no more than `error`.
  void add(const Vector3<double>& next, double next_opacity, double error) {
    const double brightest = next.maxCoeff();
    color_error += (transmittance + transmittance_error) * error + transmittance_error * brightest +
                   4 * unit_roundoff * (transmittance * brightest + color.maxCoeff());
    color += transmittance * next;
    transmittance_error =
        transmittance_error * std::min(1.0, 1 - next_opacity + error) + transmittance * (error + 4 * unit_roundoff);
    opacity += transmittance * next_opacity;
    transmittance *= 1 - next_opacity;
  }
};

}  // namespace

SurfaceIntegral::SurfaceIntegral(const PiecewiseLinear& transfer, Emission emission,
                                 std::vector<Isosurface> isosurfaces)
    : matter_(transfer, emission), emission_(emission), isosurfaces_(std::move(isosurfaces)) {
  check(isosurfaces_);
  for (const Isosurface& surface : isosurfaces_) {
    scalars_.push_back(surface.s);
    most_surface_ = std::max(most_surface_, surface.color.maxCoeff());
  }
  for (const TransferPoint& point : transfer.points())
    most_matter_ = std::max(most_matter_, point.optics.color.maxCoeff());
}

template <int Degree>
Certified SurfaceIntegral::operator()(const PreciseChain<Degree>& signal, const SurfaceHits& hits, double tolerance) {
  Certified result;
  Front front;
  const auto length = static_cast<double>(signal.length);
  const double most_matter = emission_ == Emission::associated ? most_matter_ : most_matter_ * length;
  const double scale = std::max({1.0, most_surface_, most_matter});
  const double most_light = std::max(1.0, most_surface_ + most_matter);
  double doubt = 0;  // light that is not known, behind the first unresolved contact
  const auto look_for_contacts = [&](double from, double to) {
    const auto is_between = [&](const UnresolvedContact& contact) { return contact.from <= to && contact.to >= from; };
    if (std::any_of(hits.unresolved.begin(), hits.unresolved.end(), is_between))
      doubt = std::max(doubt, front.transmittance + front.transmittance_error);
  };
  const SurfaceHit* before = nullptr;
  for (std::size_t i = 0; i <= hits.hits.size(); ++i) {
    const SurfaceHit* const next = i < hits.hits.size() ? &hits.hits[i] : nullptr;
    look_for_contacts(before == nullptr ? 0 : before->t.high - before->error,
                      next == nullptr ? HUGE_VAL : next->t.high + next->error);
    const PreciseChain<Degree> part = between(signal, before, next);
    const auto [chain, error] = rounded(part);
    Certified matter = matter_(chain, error, tolerance);
    if (matter.status != Status::converged) {
      const Certified closer = matter_(part, tolerance);
      if (closer.radius < matter.radius) matter = closer;
    }
    result.evaluations += matter.evaluations;
    front.add(matter.color, matter.opacity, matter.radius);
    if (next == nullptr) break;
    const Isosurface& surface = isosurfaces_[next->surface];
    front.add(surface.opacity * surface.color, surface.opacity, unit_roundoff * scale);
    before = next;
  }
  result.color = front.color;
  result.opacity = front.opacity;
  result.radius = slack * (std::max(front.color_error, front.transmittance_error) + doubt * most_light);
  // No light is brighter than this, no opacity above 1.
  if (!(result.radius <= most_light)) {
    result.color = Vector3<double>::Constant(0);
    result.opacity = 0.5;
    result.radius = most_light;
  }
  if (!(result.radius <= tolerance * scale)) result.status = Status::not_converged;
  return result;
}

template <int Degree>
PreciseChain<Degree> between(const PreciseChain<Degree>& signal, const SurfaceHit* from, const SurfaceHit* to) {
  if (from == nullptr && to == nullptr) return signal;
  PreciseChain<Degree> result;
  result.unclaimed = signal.unclaimed + (from == nullptr ? 0 : from->error);
  result.of_length = to == nullptr ? signal.of_length : to->error;
  const std::size_t first = from == nullptr ? 0 : from->piece;
  const std::size_t last = to == nullptr ? signal.pieces.size() : to->piece + 1;
  for (std::size_t i = first; i < last; ++i) {
    const DoubleDouble begin = from != nullptr && i == from->piece ? from->u : DoubleDouble(0);
    const DoubleDouble end = to != nullptr && i == to->piece ? to->u : DoubleDouble(1);
    if (!(begin < end)) continue;
    result.pieces.push_back(part_of(signal.pieces[i], begin, end));
    result.length += length_of(result.pieces.back());
  }
  return result;
}

template <int Degree>
void scale_lengths(PreciseChain<Degree>& signal, double factor) {
  if (factor == 1) return;
  for (auto& piece : signal.pieces) {
    piece.length *= factor;
    piece.extent = piece.extent * factor;
    piece.powers.clear();
  }
  signal.length = signal.length * factor;
  signal.of_length *= factor;
  signal.unclaimed *= factor;
}

template Certified SurfaceIntegral::operator()(const PreciseChain<3>&, const SurfaceHits&, double);
template Certified SurfaceIntegral::operator()(const PreciseChain<largest_degree>&, const SurfaceHits&, double);
template PreciseChain<3> between(const PreciseChain<3>&, const SurfaceHit*, const SurfaceHit*);
template PreciseChain<largest_degree> between(const PreciseChain<largest_degree>&, const SurfaceHit*,
                                              const SurfaceHit*);
template void scale_lengths(PreciseChain<3>&, double);
template void scale_lengths(PreciseChain<largest_degree>&, double);

}  // namespace raytruth
