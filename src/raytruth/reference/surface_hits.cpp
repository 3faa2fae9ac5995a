#include "raytruth/reference/surface_hits.hpp"

#include "raytruth/core/bernstein.hpp"
#include "raytruth/core/chain.hpp"
#include "raytruth/reference/arb/exact_passage.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace raytruth {

namespace {

constexpr double slack = 1 + 0x1p-20;
constexpr double rounding = 0x1p-92;   // of the largest number: de Casteljau's steps in pairs, and what begins them
constexpr double smallest = 0x1p-960;  // below it products of pairs underflow
constexpr double shortest = 0x1p-50;   // of a piece: what is not told apart there is left open
constexpr double narrowest = 0x1p-90;  // of a stretch: width of a bracket

/// Part of a piece in its unit coordinate, as one surface sees it: the scalar is on one side of it; or on it throughout
/// (`on`); or it is not known where. If it is known that it rises or falls all the time, `direction` says so.
struct SidePart {
  enum class Side { below, above, on, unknown };
  Side side = Side::unknown;
  DoubleDouble begin;
  DoubleDouble end;
  int direction = 0;
};

using Side = SidePart::Side;

Side side_of(int sign) { return sign < 0 ? Side::below : sign > 0 ? Side::above : Side::on; }

void append(std::vector<SidePart>& parts, const SidePart& part) {
  if (!(part.begin < part.end) && part.side != Side::unknown) return;
  if (!parts.empty() && parts.back().side == part.side) {
    parts.back().end = part.end;
    if (parts.back().direction != part.direction) parts.back().direction = 0;
    return;
  }
  parts.push_back(part);
}

/// Cuts a piece into such parts, in 106 bits.
template <int Degree>
class SideSearch {
 public:
  using Polynomial = Bernstein<Degree, DoubleDouble>;

  /// `error`: of the coefficients. `signal_error`: how much of it is the signal's own, a polynomial's too.
  SideSearch(double error, double signal_error, std::vector<SidePart>& parts)
      : error_(error), signal_error_(signal_error), parts_(&parts) {}

  /// `distance`: from the surface, on [begin, begin + width] of the piece.
  void operator()(const Polynomial& distance, double begin, double width) {
    const auto& d = distance.coefficients;
    const auto is = [this](int sign) { return [this, sign](const DoubleDouble& x) { return sign_of(x) == sign; }; };
    for (const int sign : {-1, 1})
      if (std::all_of(d.begin(), d.end(), is(sign))) {
        append(*parts_, {side_of(sign), begin, begin + width});
        return;
      }
    if (const int direction = direction_of(distance, width); direction != 0) {
      pass(distance, direction, begin, width);
      return;
    }
    const bool is_hidden =
        std::all_of(d.begin(), d.end(), [this](const DoubleDouble& x) { return std::abs(x.high) <= 4 * error_; });
    if (is_hidden || width <= shortest) {
      append(*parts_, {Side::unknown, begin, begin + width});
      return;
    }
    Polynomial front;
    Polynomial back = distance;
    auto& points = back.coefficients;
    for (std::size_t last = Degree; last > 0; --last) {
      front.coefficients[Degree - last] = points[0];
      for (std::size_t i = 0; i < last; ++i) points[i] = (points[i] + points[i + 1]) * 0.5;
    }
    front.coefficients[Degree] = points[0];
    (*this)(front, begin, width / 2);
    (*this)(back, begin + width / 2, width / 2);
  }

 private:
  [[nodiscard]] int sign_of(const DoubleDouble& x) const { return (x.high > error_) - (x.high < -error_); }

  /// Whether the signal certainly rises or falls: the slope of what a polynomial of degree n is off by is at most 2 n^2
  /// times that (Markov's inequality on [0, 1]).
  [[nodiscard]] int direction_of(const Polynomial& distance, double width) const {
    const double margin = slack * (2 * Degree * width * signal_error_ + 2 * error_);
    int direction = 0;
    for (std::size_t i = 0; i < Degree; ++i) {
      const double step = (distance.coefficients[i + 1] - distance.coefficients[i]).high;
      const int here = (step > margin) - (step < -margin);
      if (here == 0 || here == -direction) return 0;
      direction = here;
    }
    return direction;
  }

  /// Appends a stretch on which the scalar rises or falls.
  void pass(const Polynomial& distance, int direction, double begin, double width) {
    const int first = sign_of(distance.coefficients.front());
    const int last = sign_of(distance.coefficients.back());
    double least_slope = HUGE_VAL;
    Bernstein<Degree> rounded;
    for (std::size_t i = 0; i <= Degree; ++i) {
      rounded.coefficients[i] = distance.coefficients[i].high;
      if (i == 0) continue;
      const double step = (distance.coefficients[i] - distance.coefficients[i - 1]).high;
      least_slope = std::min(least_slope, Degree * std::abs(step));
    }
    DoubleDouble middle = first == 0 ? 0.0 : 1.0;
    if (first != 0 && last != 0) {
      const auto zeros = rounded.sign_changes();
      middle = zeros.empty() ? 0.5 : zeros.front();
      const auto slope = rounded.derivative();
      for (int step = 0; step < 2; ++step) {
        const DoubleDouble next = middle - distance.value(middle) / slope.value(middle.high);
        if (next < DoubleDouble(0) || DoubleDouble(1) < next || !std::isfinite(next.high)) break;
        middle = next;
      }
    }
    DoubleDouble low = 0.0;
    DoubleDouble high = 1.0;
    double reach = std::max(narrowest, 2 * error_ / least_slope);
    const auto has_sign = [&](const DoubleDouble& x, int sign) { return sign_of(distance.value(x)) == sign; };
    while (first != 0 && reach < 1 && DoubleDouble(reach) < middle && !has_sign(middle - reach, first)) reach *= 4;
    if (first != 0 && DoubleDouble(reach) < middle) low = middle - reach;
    while (last != 0 && reach < 1 && middle + reach < DoubleDouble(1) && !has_sign(middle + reach, last)) reach *= 4;
    if (last != 0 && middle + reach < DoubleDouble(1)) high = middle + reach;
    const auto place = [&](const DoubleDouble& x) { return DoubleDouble(begin) + x * width; };
    if (first != 0) append(*parts_, {side_of(first), begin, place(low)});
    append(*parts_, {Side::unknown, place(low), place(high), direction});
    if (last != 0) append(*parts_, {side_of(last), place(high), begin + width});
  }

  double error_;
  double signal_error_;
  std::vector<SidePart>* parts_;
};

/// A hit, and what tells it from its neighbours.
struct BracketedHit {
  SurfaceHit hit;
  std::optional<std::size_t> rank = {};  ///< in its piece, if that is decided without rounding
};

/// What a surface has seen of the ray so far.
struct Track {
  Side side = Side::unknown;  ///< the last one that is known
  DoubleDouble end = {};      ///< t where that ended
  std::size_t piece = 0;      ///< and where in the chain
  DoubleDouble u = {};
  // What came behind it:
  bool is_on = false;          ///< a stretch on the surface
  DoubleDouble on_begin = {};  ///< which begins there
  std::size_t on_piece = 0;
  bool is_unknown = false;   ///< something that is not known
  bool always_rises = true;  ///< on it the scalar rises throughout
  bool always_falls = true;
  bool leads_to_surface = true;  ///< it moves towards the surface where it is before a stretch on it, and away behind
};

template <int Degree>
class HitSearch {
 public:
  HitSearch(const PreciseChain<Degree>& signal, const std::vector<double>& scalars, const Surroundings& surroundings)
      : signal_(signal), scalars_(scalars), surroundings_(surroundings), tracks_(scalars.size()) {}

  SurfaceHits operator()() {
    for (index_ = 0; index_ < signal_.pieces.size(); ++index_) {
      const PrecisePiece<Degree>& piece = signal_.pieces[index_];
      length_ = DoubleDouble(0) < piece.extent ? piece.extent : DoubleDouble(piece.length);
      cut();
      start_ += length_;
      // A length in binary64 may be off by its rounding.
      if (!(DoubleDouble(0) < piece.extent)) start_error_ += 0x1p-53 * piece.length;
    }
    for (std::size_t surface = 0; surface < scalars_.size(); ++surface) finish(surface);
    SurfaceHits result{.hits = {}, .unresolved = std::move(unresolved_)};
    sort();
    for (const BracketedHit& found : hits_) result.hits.push_back(found.hit);
    std::stable_sort(result.unresolved.begin(), result.unresolved.end(),
                     [](const UnresolvedContact& a, const UnresolvedContact& b) { return a.from < b.from; });
    return result;
  }

 private:
  [[nodiscard]] static bool is_exact(const PrecisePiece<Degree>& piece) {
    return !piece.powers.empty() || piece.error == 0;
  }

  /// The piece at hand, seen from every surface.
  void cut() {
    const PrecisePiece<Degree>& piece = signal_.pieces[index_];
    std::vector<std::vector<SidePart>> parts(scalars_.size());
    bool is_open = false;
    for (std::size_t surface = 0; surface < scalars_.size(); ++surface) {
      parts[surface] = parts_of(piece, scalars_[surface]);
      for (const SidePart& part : parts[surface])
        is_open = is_open || (part.side == Side::unknown &&
                              (part.direction == 0 || part.begin == DoubleDouble(0) || part.end == DoubleDouble(1)));
    }
    std::optional<arb::ExactPassage> passage;
    if (is_open && is_exact(piece) && !is_moved(piece)) {
      passage = arb::exact_passage(piece, scalars_);
      for (std::size_t surface = 0; surface < scalars_.size(); ++surface)
        parts[surface] = exact_parts(*passage, surface);
    }
    for (std::size_t surface = 0; surface < scalars_.size(); ++surface) {
      const std::size_t first = hits_.size();
      for (const SidePart& part : parts[surface]) add(surface, part);
      if (!passage) continue;
      std::size_t next = first;
      for (std::size_t rank = 0; rank < passage->crossings.size(); ++rank)
        if (passage->crossings[rank].scalar == surface) {
          // A crossing at the beginning of the piece, or before it, stands before those inside.
          while (next < hits_.size() && !(hits_[next].hit.piece == index_ && DoubleDouble(0) < hits_[next].hit.u))
            ++next;
          if (next < hits_.size()) hits_[next++].rank = rank;
        }
    }
  }

  /// Whether the signal may be elsewhere for a moment at the ends of the piece, constant as it is.
  [[nodiscard]] bool is_moved(const PrecisePiece<Degree>& piece) const {
    const auto& b = piece.polynomial.coefficients;
    return signal_.unclaimed > 0 && piece.error == 0 &&
           std::all_of(b.begin(), b.end(), [&b](const DoubleDouble& x) { return x == b.front(); });
  }

  [[nodiscard]] std::vector<SidePart> parts_of(const PrecisePiece<Degree>& piece, double scalar) const {
    Bernstein<Degree, DoubleDouble> distance;
    double largest = std::abs(scalar);
    bool is_constant = true;
    for (std::size_t i = 0; i <= Degree; ++i) {
      const DoubleDouble& b = piece.polynomial.coefficients[i];
      distance.coefficients[i] = b - DoubleDouble(scalar);
      largest = std::max(largest, std::abs(b.high));
      is_constant = is_constant && b == piece.polynomial.coefficients[0];
    }
    for (std::size_t k = 1; k < piece.powers.size(); ++k) is_constant = is_constant && piece.powers[k] == 0;
    std::vector<SidePart> parts;
    if (is_constant && is_exact(piece)) {
      const DoubleDouble& b = piece.polynomial.coefficients[0];
      const double reach = is_moved(piece) ? signal_.unclaimed * surroundings_.steepest : 0;
      const double d = distance.coefficients[0].high;
      if (reach > 0 && std::abs(d) <= reach && !(d == 0 && surroundings_.are_in_line))
        parts.push_back({Side::unknown, 0.0, 1.0});
      else
        parts.push_back({side_of(b > DoubleDouble(scalar) ? 1 : b < DoubleDouble(scalar) ? -1 : 0), 0.0, 1.0});
      return parts;
    }
    SideSearch<Degree>(slack * (piece.error + rounding * largest + smallest), piece.powers.empty() ? piece.error : 0,
                       parts)(distance, 0, 1);
    return parts;
  }

  /// Crossings in rational numbers as parts: what is unknown is a place only.
  static std::vector<SidePart> exact_parts(const arb::ExactPassage& passage, std::size_t surface) {
    std::vector<SidePart> parts;
    int sign = passage.first_signs[surface];
    DoubleDouble begin = 0.0;
    for (const arb::ExactCrossing& crossing : passage.crossings) {
      if (crossing.scalar != surface) continue;
      parts.push_back({side_of(sign), begin, crossing.place});
      parts.push_back({Side::unknown, crossing.place, crossing.place, crossing.is_rising ? 1 : -1});
      begin = crossing.place;
      sign = -sign;
    }
    parts.push_back({side_of(sign), begin, 1.0});
    return parts;
  }

  [[nodiscard]] DoubleDouble t_of(const DoubleDouble& u) const { return start_ + length_ * u; }

  void add(std::size_t surface, const SidePart& part) {
    Track& track = tracks_[surface];
    switch (part.side) {
      case Side::on:
        if (!track.is_on) {
          track.is_on = true;
          track.on_begin = t_of(part.begin);
          track.on_piece = index_;
        }
        return;
      case Side::unknown: {
        track.is_unknown = true;
        track.always_rises = track.always_rises && part.direction > 0;
        track.always_falls = track.always_falls && part.direction < 0;
        // Before a stretch on the surface the scalar must come nearer.
        const int from_surface = track.side == Side::above ? 1 : -1;
        const int towards = track.is_on ? part.direction : -part.direction;
        track.leads_to_surface = track.leads_to_surface && towards == from_surface;
        return;
      }
      default:
        arrive(surface, part.side, part.begin);
    }
    track = {.side = part.side, .end = t_of(part.end), .piece = index_, .u = part.end};
  }

  /// The scalar is known to be on a side from u on.
  void arrive(std::size_t surface, Side side, const DoubleDouble& u) {
    const Track& track = tracks_[surface];
    const bool is_first = track.side == Side::unknown;
    const bool crosses = !is_first && track.side != side;
    const bool is_rising = side == Side::above;
    if (track.is_unknown) {
      const bool is_passage = crosses && (is_rising ? track.always_rises : track.always_falls);
      const bool is_visit = !is_first && !crosses && track.is_on && track.leads_to_surface;
      if (!is_passage && !is_visit) leave_open(surface, track.end, t_of(u));
    }
    if (!crosses) return;
    const DoubleDouble low = track.end;
    const DoubleDouble high = track.is_on ? track.on_begin : t_of(u);
    SurfaceHit hit{.t = low + (high - low) * 0.5, .surface = surface, .is_rising = is_rising};
    hit.error = slack * ((high - low).high / 2 + start_error_ + 0x1p-98 * hit.t.high);
    hit.piece = track.is_on ? track.on_piece : index_;
    if (!track.is_on && track.piece == index_) hit.u = track.u + (u - track.u) * 0.5;
    hits_.push_back({hit});
  }

  void leave_open(std::size_t surface, const DoubleDouble& from, const DoubleDouble& to) {
    unresolved_.push_back({std::max(0.0, from.high - start_error_), to.high + start_error_, surface});
  }

  /// The end of the ray.
  void finish(std::size_t surface) {
    const Track& track = tracks_[surface];
    if (signal_.pieces.empty()) return;
    bool is_open = track.is_unknown && !(track.side != Side::unknown && track.is_on && track.leads_to_surface);
    if (signal_.of_length > 0) {
      // The ray may be longer, or shorter, by that: the scalar must be farther away.
      const PrecisePiece<Degree>& piece = signal_.pieces.back();
      const auto& b = piece.polynomial.coefficients;
      double step = 0;
      for (std::size_t i = 0; i < Degree; ++i) step = std::max(step, std::abs((b[i + 1] - b[i]).high));
      const double reach =
          slack * (piece.error + (surroundings_.steepest + 2 * Degree * step / piece.length) * signal_.of_length);
      is_open = is_open || !(std::abs((b[Degree] - DoubleDouble(scalars_[surface])).high) > reach);
    }
    if (is_open) leave_open(surface, std::min(track.end, start_ - signal_.of_length), start_);
  }

  /// Whether a ray meets one hit before another. Where places are too near to tell, the scalar rises through both, or
  /// falls through both, in the order of their surfaces.
  static bool is_before(const BracketedHit& a, const BracketedHit& b) {
    if (a.hit.piece == b.hit.piece && a.rank && b.rank) return *a.rank < *b.rank;
    const double gap = static_cast<double>(b.hit.t - a.hit.t);
    if (std::abs(gap) > a.hit.error + b.hit.error) return gap > 0;
    if (a.hit.is_rising != b.hit.is_rising) return gap > 0;
    return a.hit.is_rising ? a.hit.surface < b.hit.surface : a.hit.surface > b.hit.surface;
  }

  /// By insertion: hits come nearly in order.
  void sort() {
    for (std::size_t i = 1; i < hits_.size(); ++i)
      for (std::size_t j = i; j > 0 && is_before(hits_[j], hits_[j - 1]); --j) std::swap(hits_[j], hits_[j - 1]);
  }

  const PreciseChain<Degree>& signal_;
  const std::vector<double>& scalars_;
  Surroundings surroundings_;
  std::vector<Track> tracks_;
  std::vector<BracketedHit> hits_;
  std::vector<UnresolvedContact> unresolved_;
  std::size_t index_ = 0;
  DoubleDouble start_;  ///< of the piece at hand
  DoubleDouble length_;
  double start_error_ = 0;
};

}  // namespace

template <int Degree>
SurfaceHits surface_hits(const PreciseChain<Degree>& signal, const std::vector<double>& scalars,
                         const Surroundings& surroundings) {
  return HitSearch<Degree>(signal, scalars, surroundings)();
}

template SurfaceHits surface_hits(const PreciseChain<3>&, const std::vector<double>&, const Surroundings&);
template SurfaceHits surface_hits(const PreciseChain<largest_degree>&, const std::vector<double>&, const Surroundings&);

}  // namespace raytruth
