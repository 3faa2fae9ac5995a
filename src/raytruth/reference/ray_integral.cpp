#include "raytruth/reference/ray_integral.hpp"

#include "raytruth/core/double_double.hpp"
#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/kernels/kernels.hpp"
#include "raytruth/reference/arb/exact_cut.hpp"
#include "raytruth/reference/knot_cut.hpp"
#include "raytruth/reference/linear_interval.hpp"
#include "raytruth/reference/piece_integral.hpp"
#include "raytruth/reference/units.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

namespace raytruth {

namespace {

constexpr double slack = 1 + 0x1p-20;   // second-order terms, and the rounding of the error bounds themselves
constexpr double negligible = 0x1p-48;  // share of an interval's extinction or colour: some roundings of x
constexpr double brief = 0x1p-20;       // share of a stretch outside its interval that halving cannot much improve
constexpr double shortest = 0x1p-45;    // in a piece's unit coordinate
constexpr double briefest = 0x1p-52;    // share of a piece outside its interval where the opacity is 1 just there
constexpr int most_refinements = 400;   // of one piece
constexpr double precise = 0x1p-93;  // of the largest coefficient: de Casteljau's steps in pairs, and what begins them
constexpr double precisely_placed = 0x1p-200;  // of a piece: `CutPart::width`
constexpr double narrow = 0x1p-140;            // of a piece: its length is less than a rounding off by that
constexpr double most_clear_ratio = 6;  // of 1 - a on an opacity piece: more takes more points than two halves do
constexpr std::size_t pieces_at_once = 256;
constexpr double bottomless = 0x1p20;          // optical depth of a homogeneous stretch that need not be known
constexpr double deep_enough = 0x1p10;         // which then stands for it
constexpr double longest_at_hand = 0x1p400;    // longer rays are done in other units
constexpr double deepest_at_hand = 0x1p800;    // and deeper ones
constexpr double negligible_radius = 0x1p-60;  // share of a radius that its slack covers

/// How wrong an interval's linear functions are on a stretch that leaves it: by how much at most, and on what share.
struct Outside {
  double share = 0;
  double extinction = 0;
  double color = 0;
  bool is_settled = true;  ///< halving the stretch would not help
  bool is_deadly = false;  ///< the ray ends there, if it is outside indeed
  bool is_early = false;   ///< what may be outside is not at the stretch's end alone
};

/// How wrong they are beyond an end where the opacity is 1. There -ln(1 - a), of the interval's own function or of its
/// neighbour's, is -ln of a polynomial p of degree n. On any part of a stretch of the share v its integral is at most v
/// (n (2 + ln(1 / v)) - ln(max |p|)), max over the whole stretch. (For n = 1, with u - r relative to its largest value,
/// which it is enough to look at for r in [0, 1]: -ln |u - r| over a set of measure v is largest about r, and there at
/// most v (1 + ln(2 / v)).)
///
/// `width`: of the stretch, in its piece. Where the crossing is known to its last bit, half a stretch tells no more.
Outside beyond_opaque_end(const IntervalEnd& end, double share, double excess, double seen, double width, int degree,
                          const LinearInterval& interval, const LinearIntervals& intervals) {
  Outside outside{.share = share, .is_settled = share * width <= briefest, .is_deadly = end.is_opaque_beyond};
  const double own = std::max(interval.at_0.extinction, interval.at_1.extinction);
  const double units = intervals.units_per_length();
  if (own < opaque_extinction * units) outside.extinction = 2 * own;
  if (end.contact_slope > 0) {
    const double most = std::min(1.0, end.contact_slope * seen);
    outside.extinction =
        most > 0 ? outside.extinction + slack * 2 * units * (degree * (2 - std::log(share)) - std::log(most))
                 : HUGE_VAL;
  }
  outside.color =
      excess < brief ? end.color_jump + end.color_kink * excess : intervals.most_color() + interval.most_color;
  // Behind the end of a ray nothing shines.
  if (end.is_opaque_beyond) outside.color = std::max(outside.color, interval.most_color + end.color_kink * excess);
  return outside;
}

/// How wrong they are beyond one end of the interval. For degrees n >= 3, e and f the excess at the two ends, g what is
/// inside, x(u) >= -e (1-u)^n - f u^n + g (1 - (1-u)^n - u^n) and (1-u)^n + u^n <= 1 - 3 u (1-u), so for max(e,
/// f) <= g/64 x is negative on at most (e + f) / (2.9 g) of the stretch.
Outside beyond(const IntervalEnd& end, double at_begin, double at_end, double inside, double width, int degree,
               const LinearInterval& interval, const LinearIntervals& intervals) {
  const double e = std::max(0.0, -at_begin);
  const double f = std::max(0.0, -at_end);
  if (e == 0 && f == 0 && inside >= 0) return {};
  const double excess = std::max({e, f, -inside});
  Outside outside{.share = 64 * std::max(e, f) <= inside ? slack * (e + f) / (2.9 * inside) : 1};
  if (end.contact_slope > 0 || end.is_opaque_beyond) {
    outside =
        beyond_opaque_end(end, outside.share, excess, std::max(at_begin, at_end), width, degree, interval, intervals);
    outside.is_early = e > 0;
    return outside;
  }
  if (excess <= end.reach) {
    outside.extinction = end.extinction_jump + end.extinction_kink * excess;
    outside.color = end.color_jump + end.color_kink * excess;
  } else {
    const double slope = std::abs(interval.at_1.extinction - interval.at_0.extinction);
    const double color_slope = (interval.at_1.color - interval.at_0.color).abs().maxCoeff();
    outside.extinction = intervals.most_extinction() + interval.most_extinction + slope * excess;
    outside.color = intervals.most_color() + interval.most_color + color_slope * excess;
  }
  outside.is_settled =
      outside.share <= brief || (outside.share * outside.extinction <= negligible * interval.typical_extinction &&
                                 outside.share * outside.color <= negligible * interval.most_color);
  return outside;
}

/// How far exp(-D) can be from its value at hand, for |D - depth| <= depth_error: e^d - 1 <= 2 d up to d = 1. Depths
/// above 700 count as 700. Of an error above 1 all that is told is how little the least depth lets through.
double drift_of(double depth, double transmittance, double depth_error) {
  if (depth_error >= 1) {
    const double least = depth - depth_error;
    return least > 0 ? slack * exponential(-least) : 1;
  }
  return transmittance * 2 * depth_error + (depth < 690 ? 0 : 0x1p-990);
}

/// Whether a piece that is not opaque may touch what is, so that the ray ends; or the other way round.
struct Doubt {
  enum class Kind { none, may_end, may_go_on, has_ended };
  Kind kind = Kind::none;
  /// What it may touch; where a ray has ended: the interval that it must have come from, if its colour depends on that.
  std::optional<std::size_t> interval = {};
  /// It may touch it anywhere, and the errors of the piece have all its light; else at its end alone.
  bool is_throughout = false;
};

/// The part of a ray that has been integrated.
struct Sum {
  DoubleDouble depth;
  double depth_error = 0;
  Vector3<double> color = Vector3<double>::Constant(0);
  Vector3<double> color_rest = Vector3<double>::Constant(0);  ///< what the sums rounded away
  double color_error = 0;
  double nodes = 0;
  std::size_t pieces = 0;
  double doubt = 0;    ///< light that may have been lost already, where the ray may have touched what is opaque
  double pending = 0;  ///< the same of the last pieces: none if the ray ends behind them just where it may have ended
  std::size_t pending_interval = 0;  ///< theirs
  std::size_t pending_beyond = 0;    ///< what they may have touched
  double end_extinction = 0;         ///< bound just behind the ray's end

  [[nodiscard]] bool is_opaque() const { return depth.high - depth_error > opaque_depth; }

  /// What is doubtful of the next piece, in an interval; `most_seen`: of its light. Where the ray may have ended
  /// before, that makes no difference if it ends now, in what it may have touched and with the colour that it has
  /// there.
  void add_doubt(const Doubt& next, std::size_t interval, double most_seen) {
    const bool may_end = next.kind == Doubt::Kind::may_end && next.interval.has_value();
    const bool goes_on =
        may_end && next.is_throughout && next.interval == pending_beyond && interval == pending_interval;
    const bool has_ended = next.kind == Doubt::Kind::has_ended && interval == pending_beyond &&
                           next.interval.value_or(pending_interval) == pending_interval;
    if (!goes_on && !has_ended) {
      doubt = std::max(doubt, pending);
      pending = 0;
    }
    if (may_end) {
      pending = std::max(pending, most_seen);
      pending_interval = interval;
      pending_beyond = *next.interval;
      return;
    }
    pending = 0;
    if (next.kind == Doubt::Kind::may_go_on || next.kind == Doubt::Kind::may_end) doubt = std::max(doubt, most_seen);
  }

  void add_color(const Vector3<double>& color_here) {
    for (int channel = 0; channel < 3; ++channel) {
      const DoubleDouble exact = two_sum(color[channel], color_here[channel]);
      color[channel] = exact.high;
      color_rest[channel] += exact.low;
    }
  }
};

/// What a ray comes to, with proven bounds.
struct Answer {
  Slab<> light;
  double color_error = 0;
  double opacity_error = 0;
  double nodes = 0;
};

/// Where the integral of a piece comes from, for transfer functions that are linear in opacity.
struct Source {
  enum class Kind { linear, opacity, known };
  Kind kind;
  std::size_t index;
};

/// How far a piece may be from the signal meant.
struct PieceError {
  double signal = 0;
  bool has_exact_ends = true;  ///< both end values are the signal's own
};

/// A stretch in an interval whose opacity is 1 at one of its ends.
template <int Degree>
struct Contact {
  const Piece<Degree>& piece;
  PieceError error;
  std::size_t piece_index = 0;
  std::size_t interval = 0;
  bool is_at_top = false;     ///< x is 1 there, else 0
  bool is_inside = false;     ///< it certainly does not go beyond
  double slope = 0;           ///< of 1 - a, by the scalar's distance from there
  double width = 0;           ///< of the interval
  double distance_error = 0;  ///< of the scalar
};

/// Some of it: in the piece's unit coordinate, and the scalar's distance.
template <int Degree>
struct ContactStretch {
  double begin;
  double end;
  Bernstein<Degree, DoubleDouble> distance;
};

/// A stretch in 106 bits, in a unit coordinate of its own.
template <int Degree>
struct PreciseStretch {
  Bernstein<Degree, DoubleDouble> polynomial;
  double error = 0;  ///< of the scalar
  DoubleDouble length;
  double width = 1;          ///< in its piece
  double width_of_part = 1;  ///< of what it is cut from, between two crossings
  std::size_t interval = 0;  ///< in which it is, but for what its errors cover
  // Those in which the scalar may be at all: it certainly crosses no jump at the ends of these.
  std::size_t first_interval = 0;
  std::size_t last_interval = 0;
};

/// What a ray of a degree leaves behind for the next one: memory.
template <int Degree>
struct Buffers {
  std::vector<KnotStretch> stretches;
  std::vector<LinearPiece<Degree, Eight>> pieces;  ///< the first lanes are in use, `linear_count` in all
  std::vector<PieceIntegral<Eight>> integrals;
  std::vector<std::size_t> intervals;  ///< one for every piece, in their order along the ray
  std::vector<double> depth_errors;    ///< by what the scalar does outside its interval
  std::vector<double> color_errors;
  std::size_t linear_count = 0;
  // Only where the opacity is linear:
  std::vector<Source> sources;
  std::vector<Doubt> doubts;
  bool is_over = false;  ///< the ray has ended
  std::vector<OpacityPiece<Degree, Eight>> opacity_pieces;
  std::size_t opacity_count = 0;
  std::vector<PieceIntegral<>> known;
  std::vector<PieceIntegral<Eight>> in_order;

  void clear_pieces() {
    pieces.clear();
    intervals.clear();
    depth_errors.clear();
    color_errors.clear();
    linear_count = 0;
    sources.clear();
    doubts.clear();
    is_over = false;
    opacity_pieces.clear();
    opacity_count = 0;
    known.clear();
  }
};

template <int Degree>
void set_stretch(Stretches<Degree>& stretches, std::size_t lane, const Bernstein<Degree>& polynomial,
                 double signal_error, double begin, double end, const LinearInterval& interval) {
  for (std::size_t j = 0; j <= Degree; ++j) stretches.signal[j][lane] = polynomial.coefficients[j];
  stretches.signal_error[lane] = signal_error;
  stretches.begin[lane] = begin;
  stretches.end[lane] = end;
  stretches.origin[lane] = interval.origin;
  stretches.scale[lane] = interval.scale;
  stretches.offset[lane] = interval.offset;
  stretches.bottom[lane] = interval.bottom;
  stretches.top[lane] = interval.top;
}

/// Whether a chain is the signal itself.
bool is_zero(const SignalError& error) {
  return error.of_length == 0 && error.unclaimed == 0 &&
         std::all_of(error.of_pieces.begin(), error.of_pieces.end(), [](double of_piece) { return of_piece == 0; });
}

/// Whether the scalar varies by no more than what is known of it.
template <int Degree>
bool is_noise(const NormalisedStretches<Degree>& normalised, std::size_t lane) {
  double least = normalised.x[0][lane];
  double most = least;
  for (const Eight& x : normalised.x) {
    least = std::min(least, x[lane]);
    most = std::max(most, x[lane]);
  }
  return most - least <= 16 * normalised.x_error[lane];
}

/// Appends a piece whose integral is known.
template <int Degree>
void append(const PieceIntegral<>& integral, std::size_t interval, Buffers<Degree>& buffers) {
  buffers.sources.push_back({Source::Kind::known, buffers.known.size()});
  buffers.known.push_back(integral);
  buffers.intervals.push_back(interval);
}

}  // namespace

struct RayIntegral::Parts {
  Parts(const PiecewiseLinear& transfer, Emission its_emission)
      : transfer_(transfer),
        intervals_(transfer),
        emission_(its_emission),
        most_underflow_(0x1p-1033 * std::max(1.0, intervals_.largest_scale()) *
                        std::max(1.0, intervals_.most_extinction()) * std::max(1.0, intervals_.most_color())) {}

  template <int Degree>
  Certified operator()(const Chain<Degree>& signal, const SignalError& error, double tolerance);
  template <int Degree>
  Certified operator()(const PreciseChain<Degree>& signal, double tolerance);

 private:
  template <int Degree>
  Answer integrate_ray(const Chain<Degree>& signal, const SignalError& error);
  template <int Degree>
  Answer integrate_in_other_units(const Chain<Degree>& signal, const SignalError& error) const;
  [[nodiscard]] double most_underflow(double length, std::size_t pieces) const {
    return most_underflow_ * std::max(1.0, length) * static_cast<double>(pieces);
  }
  template <int Degree>
  [[nodiscard]] double underflow(const Chain<Degree>& signal) const;
  template <int Degree>
  [[nodiscard]] bool is_dark(const Chain<Degree>& signal, const SignalError& error);
  template <int Degree>
  void fit(const Chain<Degree>& signal, const SignalError& error, Buffers<Degree>& buffers) const;
  template <int Degree>
  std::array<Outside, 2> outside(const LinearInterval& interval, const NormalisedStretches<Degree>& normalised,
                                 std::size_t lane, double width) const;
  template <int Degree>
  void accept_or_halve(const Piece<Degree>& piece, const PieceError& error, const KnotStretch& stretch,
                       const NormalisedStretches<Degree>& normalised, std::size_t lane, int& budget,
                       Buffers<Degree>& buffers) const;
  template <int Degree>
  void accept(const std::array<Outside, 2>& ends, const Piece<Degree>& piece, const PieceError& error,
              const KnotStretch& stretch, const NormalisedStretches<Degree>& normalised, std::size_t lane, int& budget,
              Buffers<Degree>& buffers) const;
  template <int Degree>
  void fit_precisely(const PrecisePiece<Degree>& piece, Buffers<Degree>& buffers);
  template <int Degree>
  void accept_or_halve_precisely(const PreciseStretch<Degree>& stretch, int& budget, Buffers<Degree>& buffers) const;
  template <int Degree>
  void append_opacity(const OpacityPiece<Degree>& piece, int level, std::size_t interval,
                      Buffers<Degree>& buffers) const;
  template <int Degree>
  void append_contact(const Piece<Degree>& piece, const PieceError& error, const KnotStretch& stretch, int& budget,
                      Buffers<Degree>& buffers) const;
  template <int Degree>
  void append_contact_stretch(const Contact<Degree>& contact, const ContactStretch<Degree>& stretch, int level,
                              int& budget, Buffers<Degree>& buffers) const;
  template <int Degree>
  void append_neighbour(const Contact<Degree>& contact, const ContactStretch<Degree>& stretch, int& budget,
                        Buffers<Degree>& buffers) const;
  template <int Degree>
  void append_touching(const OpacityPiece<Degree>& piece, const Contact<Degree>& contact,
                       Buffers<Degree>& buffers) const;
  template <int Degree>
  void append_opaque(std::size_t interval, const NormalisedStretches<Degree>& normalised, std::size_t lane,
                     bool is_certain, bool is_entered, Buffers<Degree>& buffers) const;
  template <int Degree>
  void find_integrals(Buffers<Degree>& buffers) const;
  template <int Degree>
  void integrate_pieces(Buffers<Degree>& buffers, Sum& sum) const;
  template <int Degree>
  void add_end(const Chain<Degree>& signal, const SignalError& error, Sum& sum) const;
  [[nodiscard]] Answer finish(const Sum& sum, double length, double hidden, const SignalError& error) const;
  [[nodiscard]] Certified certified(const Answer& answer, double length, double tolerance) const;

  PiecewiseLinear transfer_;
  LinearIntervals intervals_;
  Emission emission_;
  double most_underflow_;  ///< what `underflow` can be for a piece in a ray of length 1
  KnotCut cut_;
  std::tuple<Buffers<3>, Buffers<largest_degree>> buffers_;
};

/// Makes pieces of the stretches, front to back.
template <int Degree>
void RayIntegral::Parts::fit(const Chain<Degree>& signal, const SignalError& error, Buffers<Degree>& buffers) const {
  const auto error_of = [&error](std::size_t piece) -> PieceError {
    if (error.of_pieces.empty()) return {};
    const double signal = error.of_pieces[piece];
    return {signal, error.exact_ends.empty() ? signal == 0 : error.exact_ends[piece]};
  };
  const auto& stretches = buffers.stretches;
  Stretches<Degree> eight;
  for (std::size_t first = 0; first < stretches.size(); first += lane_count) {
    const std::size_t used = std::min(lane_count, stretches.size() - first);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const KnotStretch& stretch = stretches[first + std::min(lane, used - 1)];
      set_stretch(eight, lane, signal.pieces[stretch.piece].polynomial, error_of(stretch.piece).signal, stretch.begin,
                  stretch.end, intervals_[stretch.interval]);
    }
    const auto normalised = kernels<Degree>().normalise(eight);
    for (std::size_t lane = 0; lane < used; ++lane) {
      const KnotStretch& stretch = stretches[first + lane];
      int budget = most_refinements;
      accept_or_halve(signal.pieces[stretch.piece], error_of(stretch.piece), stretch, normalised, lane, budget,
                      buffers);
    }
  }
}

/// How wrong an interval's linear functions are beyond its two ends on a stretch, or on one `width` wide in its piece.
template <int Degree>
std::array<Outside, 2> RayIntegral::Parts::outside(const LinearInterval& interval,
                                                   const NormalisedStretches<Degree>& normalised, std::size_t lane,
                                                   double width) const {
  const auto beyond_end = [&](const IntervalEnd& end, const Margins& margins) {
    return beyond(end, margins.at_begin[lane], margins.at_end[lane], margins.inside[lane], width, Degree, interval,
                  intervals_);
  };
  std::array ends{beyond_end(interval.end_0, normalised.from_0), beyond_end(interval.end_1, normalised.from_1)};
  // Where the interval's own opacity comes to 1 the parts are cut by better means (`append_contact`).
  for (std::size_t end = 0; end < 2; ++end)
    if (interval.is_opacity && interval.clear[end] == 0) ends[end] = {};
  return ends;
}

/// Appends a stretch that is inside its interval but for what its errors cover; else its two halves.
template <int Degree>
void RayIntegral::Parts::accept_or_halve(const Piece<Degree>& piece, const PieceError& error,
                                         const KnotStretch& stretch, const NormalisedStretches<Degree>& normalised,
                                         std::size_t lane, int& budget, Buffers<Degree>& buffers) const {
  if (buffers.is_over) return;
  const double width = stretch.end - stretch.begin;
  const auto ends = outside(intervals_[stretch.interval], normalised, lane, width);
  const bool is_settled = ends[0].is_settled && ends[1].is_settled;
  if (is_settled || width <= shortest || budget <= 0 || is_noise(normalised, lane)) {
    accept(ends, piece, error, stretch, normalised, lane, budget, buffers);
    return;
  }
  --budget;
  const double middle = stretch.begin + width / 2;
  for (const auto& [begin, end] : {std::pair{stretch.begin, middle}, {middle, stretch.end}}) {
    const double value = piece.polynomial.value(begin + (end - begin) / 2);
    const auto& knots = intervals_.knots();
    const auto above = std::upper_bound(knots.begin(), knots.end(), value);
    const KnotStretch half{stretch.piece, begin, end, static_cast<std::size_t>(above - knots.begin())};
    Stretches<Degree> eight;
    set_stretch(eight, 0, piece.polynomial, error.signal, begin, end, intervals_[half.interval]);
    accept_or_halve(piece, error, half, kernels<Degree>().normalise(eight), 0, budget, buffers);
  }
}

/// Makes stretches of a piece in 106 bits, cut without rounding where it crosses jumps.
template <int Degree>
void RayIntegral::Parts::fit_precisely(const PrecisePiece<Degree>& piece, Buffers<Degree>& buffers) {
  const auto& knots = intervals_.knots();
  double largest = 0;
  for (const DoubleDouble& b : piece.polynomial.coefficients) largest = std::max(largest, std::abs(b.high));
  const double error = slack * (piece.error + precise * largest);
  const auto [low, high] =
      std::minmax_element(piece.polynomial.coefficients.begin(), piece.polynomial.coefficients.end());
  const double reach = 2 * error + 4 * unit_roundoff * largest;
  std::vector<double> jumps;
  std::vector<std::size_t> jump_indices;
  for (auto knot = std::lower_bound(knots.begin(), knots.end(), low->high - reach);
       knot != knots.end() && *knot <= high->high + reach; ++knot) {
    const auto index = static_cast<std::size_t>(knot - knots.begin());
    const IntervalEnd& end = intervals_[index].end_1;
    if (end.extinction_jump == 0 && end.color_jump == 0) continue;
    jumps.push_back(*knot);
    jump_indices.push_back(index);
  }
  std::vector<arb::CutPart> parts{{0.0, 1.0, 1.0}};
  if (!jumps.empty()) parts = arb::exact_cut(piece, jumps);
  std::vector<KnotStretch> stretches;
  int budget = most_refinements;
  for (const arb::CutPart& part : parts) {
    const std::size_t first = part.first_interval == 0 ? 0 : jump_indices[part.first_interval - 1] + 1;
    const std::size_t last = part.last_interval == jumps.size() ? knots.size() : jump_indices[part.last_interval];
    const auto polynomial = piece.polynomial.restricted(part.begin, part.end);
    Bernstein<Degree> rounded;
    std::transform(polynomial.coefficients.begin(), polynomial.coefficients.end(), rounded.coefficients.begin(),
                   [](const DoubleDouble& b) { return static_cast<double>(b); });
    stretches.clear();
    cut_(intervals_, rounded, 0, stretches);
    for (std::size_t i = 0; i < stretches.size();) {
      // What rounding has cut off beyond a jump belongs to its neighbour.
      const double begin = stretches[i].begin;
      const std::size_t interval = std::clamp(stretches[i].interval, first, last);
      while (++i < stretches.size() && std::clamp(stretches[i].interval, first, last) == interval) {
      }
      const double end = stretches[i - 1].end;
      const DoubleDouble share = two_sum(end, -begin) * part.width;
      accept_or_halve_precisely(PreciseStretch<Degree>{.polynomial = polynomial.restricted(begin, end),
                                                       .error = error,
                                                       .length = share * piece.length,
                                                       .width = share.high,
                                                       .width_of_part = part.width.high,
                                                       .interval = interval,
                                                       .first_interval = first,
                                                       .last_interval = last},
                                budget, buffers);
    }
  }
}

/// Does what `accept_or_halve` does, in 106 bits. The scalar counts from the interval's origin, so that what is
/// subtracted there costs no digits.
template <int Degree>
void RayIntegral::Parts::accept_or_halve_precisely(const PreciseStretch<Degree>& stretch, int& budget,
                                                   Buffers<Degree>& buffers) const {
  const LinearInterval& interval = intervals_[stretch.interval];
  Piece<Degree> piece{.length = static_cast<double>(stretch.length)};
  double largest = interval.top - interval.bottom;
  for (std::size_t j = 0; j <= Degree; ++j) {
    double& b = piece.polynomial.coefficients[j];
    b = static_cast<double>(stretch.polynomial.coefficients[j] - DoubleDouble(interval.origin));
    largest = std::max(largest, std::abs(b));
  }
  const PieceError error{slack * (stretch.error + 2 * unit_roundoff * largest), false};
  Stretches<Degree> eight;
  set_stretch(eight, 0, piece.polynomial, error.signal, 0, 1, interval);
  eight.origin[0] = 0;
  eight.bottom[0] = interval.bottom - interval.origin;
  eight.top[0] = interval.top - interval.origin;
  const auto normalised = kernels<Degree>().normalise(eight);
  auto ends = outside(interval, normalised, 0, stretch.width);
  if (stretch.interval == stretch.first_interval && stretch.interval > 0) ends[0] = {};
  if (stretch.interval == stretch.last_interval && stretch.interval < intervals_.knots().size()) ends[1] = {};
  const bool is_settled = ends[0].is_settled && ends[1].is_settled;
  if (is_settled || stretch.width <= shortest || budget <= 0 || is_noise(normalised, 0)) {
    if (stretch.width_of_part < narrow)
      for (Outside& end : ends)
        if (end.share == 0)
          end = {.share = std::min(1.0, precisely_placed / stretch.width_of_part),
                 .extinction = interval.most_extinction,
                 .color = interval.most_color};
    accept(ends, piece, error, {0, 0, 1, stretch.interval}, normalised, 0, budget, buffers);
    return;
  }
  --budget;
  const auto [front, back] = stretch.polynomial.split(0.5);
  for (const auto& polynomial : {front, back}) {
    const DoubleDouble middle = polynomial.value(0.5);
    const auto& knots = intervals_.knots();
    const auto above = std::upper_bound(knots.begin(), knots.end(), middle);
    PreciseStretch<Degree> half = stretch;
    half.polynomial = polynomial;
    half.length = stretch.length * 0.5;
    half.width = stretch.width * 0.5;
    half.interval =
        std::clamp(static_cast<std::size_t>(above - knots.begin()), stretch.first_interval, stretch.last_interval);
    accept_or_halve_precisely(half, budget, buffers);
  }
}

/// Appends a stretch, whatever is outside of its interval.
template <int Degree>
void RayIntegral::Parts::accept(const std::array<Outside, 2>& ends, const Piece<Degree>& piece, const PieceError& error,
                                const KnotStretch& stretch, const NormalisedStretches<Degree>& normalised,
                                std::size_t lane, int& budget, Buffers<Degree>& buffers) const {
  const LinearInterval& interval = intervals_[stretch.interval];
  const bool is_settled = ends[0].is_settled && ends[1].is_settled;
  const double width = stretch.end - stretch.begin;
  double length = width * piece.length;
  if (!interval.is_linear && length * interval.at_0.extinction > bottomless)
    length = deep_enough / interval.at_0.extinction;
  const bool is_bottomless = emission_ == Emission::associated && length * interval.most_extinction > bottomless;
  double depth_error = 0;
  double color_error = 0;
  for (const Outside& outside : ends) {
    if (outside.share == 0) continue;
    const double stretch_outside = slack * length * outside.share;
    const double color = interval.most_color + outside.color;
    depth_error += stretch_outside * outside.extinction;
    // Two things may be wrong: the source there, and all that is seen through the stretch.
    if (is_bottomless)
      // The integral of tau T is at most 1, whatever the extinction.
      color_error += 2 * stretch_outside * outside.extinction * color +
                     std::min(1.0, stretch_outside * interval.most_extinction) * outside.color;
    else if (emission_ == Emission::associated)
      color_error += stretch_outside * (2 * outside.extinction * color + interval.most_extinction * outside.color);
    else
      color_error += stretch_outside * (outside.color + length * outside.extinction * color);
  }
  // No depth is known of a stretch within rounding of what is opaque: the ray may end there, or it may not.
  bool may_end = ends[0].is_deadly || ends[1].is_deadly;
  const bool has_no_depth = !std::isfinite(depth_error);
  if (has_no_depth) {
    may_end = true;
    depth_error = 0;
    color_error = std::max(ends[0].color, ends[1].color) + interval.most_color * brief;
  }
  const std::size_t first = buffers.intervals.size();
  if (intervals_.units_per_length() > 0 && interval.is_opaque) {
    // It ends at the beginning, wherever that is.
    const double lost = std::min(
        1.0, length * std::max(ends[0].share, ends[1].share) * most_mean_of_opaque * intervals_.units_per_length());
    color_error = lost * std::max(ends[0].color, ends[1].color);
    depth_error = 0;
    append_opaque(stretch.interval, normalised, lane, is_settled || std::max(ends[0].share, ends[1].share) < 0.25,
                  stretch.begin > 0, buffers);
  } else if (interval.is_opacity && (interval.clear[0] == 0 || interval.clear[1] == 0)) {
    append_contact(piece, error, stretch, budget, buffers);
  } else if (interval.is_opacity) {
    OpacityPiece<Degree> result{
        .x_error = normalised.x_error[lane],
        .clear_error = slack * std::abs(interval.opacity[1] - interval.opacity[0]) * normalised.x_error[lane],
        .length = length,
        .units = length * intervals_.units_per_length()};
    for (std::size_t j = 0; j <= Degree; ++j) {
      const double x = normalised.x[j][lane];
      result.x[j] = x;
      result.opacity[j] = interval.opacity[0] * (1 - x) + interval.opacity[1] * x;
      result.clear[j] = interval.clear[0] * (1 - x) + interval.clear[1] * x;
    }
    append_opacity(result, 0, stretch.interval, buffers);
  } else {
    const std::size_t to = buffers.linear_count % lane_count;
    if (to == 0) buffers.pieces.emplace_back().length.fill(1);
    LinearPiece<Degree, Eight>& result = buffers.pieces.back();
    if (interval.is_linear) {
      for (std::size_t j = 0; j <= Degree; ++j) result.x[j][to] = normalised.x[j][lane];
      result.x_error[to] = normalised.x_error[lane];
    }
    result.extinction_at_0[to] = interval.at_0.extinction;
    result.extinction_at_1[to] = interval.at_1.extinction;
    result.length[to] = length;
    if (intervals_.units_per_length() > 0) buffers.sources.push_back({Source::Kind::linear, buffers.linear_count});
    ++buffers.linear_count;
    buffers.intervals.push_back(stretch.interval);
  }
  // What is outside counts once, whatever parts the stretch is done in.
  buffers.depth_errors.resize(buffers.intervals.size());
  buffers.color_errors.resize(buffers.intervals.size());
  buffers.depth_errors[first] = depth_error;
  buffers.color_errors[first] = color_error;
  if (intervals_.has_opaque_points()) {
    buffers.doubts.resize(buffers.intervals.size());
    if (may_end && !interval.is_opaque) {
      Doubt doubt{.kind = Doubt::Kind::may_end, .is_throughout = has_no_depth};
      if (ends[0].is_deadly != ends[1].is_deadly) {
        const Outside& deadly = ends[0].is_deadly ? ends[0] : ends[1];
        doubt.is_throughout = doubt.is_throughout || deadly.share >= 1;
        if (doubt.is_throughout || !deadly.is_early)
          doubt.interval = ends[0].is_deadly ? stretch.interval - 1 : stretch.interval + 1;
      }
      buffers.doubts.back() = doubt;
    }
  }
}

/// Appends an opacity piece, in parts on which 1 - a varies little enough for eight of them to be done side by side.
template <int Degree>
void RayIntegral::Parts::append_opacity(const OpacityPiece<Degree>& piece, int level, std::size_t interval,
                                        Buffers<Degree>& buffers) const {
  const auto [least, most] = std::minmax_element(piece.clear.begin(), piece.clear.end());
  if (*most > most_clear_ratio * *least) {
    if (is_undividable(piece, level)) {
      append(integrate(piece, emission_), interval, buffers);
      return;
    }
    const auto [front, back] = halves(piece);
    append_opacity(front, level + 1, interval, buffers);
    append_opacity(back, level + 1, interval, buffers);
    return;
  }
  const std::size_t to = buffers.opacity_count % lane_count;
  if (to == 0) {
    auto& eight = buffers.opacity_pieces.emplace_back();
    for (Eight& clear : eight.clear) clear.fill(1);
    eight.length.fill(1);
    eight.units.fill(1);
  }
  OpacityPiece<Degree, Eight>& result = buffers.opacity_pieces.back();
  for (std::size_t j = 0; j <= Degree; ++j) {
    result.x[j][to] = piece.x[j];
    result.opacity[j][to] = piece.opacity[j];
    result.clear[j][to] = piece.clear[j];
  }
  result.x_error[to] = piece.x_error;
  result.clear_error[to] = piece.clear_error;
  result.length[to] = piece.length;
  result.units[to] = piece.units;
  buffers.sources.push_back({Source::Kind::opacity, buffers.opacity_count++});
  buffers.intervals.push_back(interval);
}

/// Appends a stretch in an interval whose opacity is 1 at an end, in parts, from the scalar's distance to there. That
/// is carried in pairs: near 1 the rounding of x would hide it.
template <int Degree>
void RayIntegral::Parts::append_contact(const Piece<Degree>& piece, const PieceError& error, const KnotStretch& stretch,
                                        int& budget, Buffers<Degree>& buffers) const {
  const LinearInterval& interval = intervals_[stretch.interval];
  const bool is_at_top = interval.clear[1] == 0;
  const double knot = is_at_top ? interval.top : interval.bottom;
  const double width = interval.top - interval.bottom;
  Bernstein<Degree, DoubleDouble> distance;
  double reach = 0;
  bool is_inside = true;
  for (std::size_t j = 0; j <= Degree; ++j) {
    const double s = piece.polynomial.coefficients[j];
    distance.coefficients[j] = is_at_top ? two_sum(knot, -s) : two_sum(s, -knot);
    reach = std::max(reach, std::abs(distance.coefficients[j].high));
    // What adds to a coefficient's error is worth nothing at the piece's ends where those are exact.
    const bool is_exact = error.has_exact_ends && (j == 0 || j == Degree);
    is_inside = is_inside && distance.coefficients[j].high >= (is_exact ? 0 : error.signal);
  }
  // De Casteljau's steps in pairs, and all the halvings that may follow, err by less than 2^-94 of the largest
  // distance.
  const Contact<Degree> contact{.piece = piece,
                                .error = error,
                                .piece_index = stretch.piece,
                                .interval = stretch.interval,
                                .is_at_top = is_at_top,
                                .is_inside = is_inside,
                                .slope = interval.clear[is_at_top ? 0 : 1] / width,
                                .width = width,
                                .distance_error = slack * (error.signal + 0x1p-94 * reach)};
  append_contact_stretch(contact, {stretch.begin, stretch.end, distance.restricted(stretch.begin, stretch.end)}, 0,
                         budget, buffers);
}

template <int Degree>
void RayIntegral::Parts::append_contact_stretch(const Contact<Degree>& contact, const ContactStretch<Degree>& stretch,
                                                int level, int& budget, Buffers<Degree>& buffers) const {
  if (buffers.is_over) return;
  const double length = (stretch.end - stretch.begin) * contact.piece.length;
  OpacityPiece<Degree> piece{.clear_error = slack * contact.slope * contact.distance_error,
                             .length = length,
                             .units = length * intervals_.units_per_length()};
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (std::size_t j = 0; j <= Degree; ++j) {
    const double d = stretch.distance.coefficients[j].high;
    const double share = d / contact.width;
    piece.x[j] = contact.is_at_top ? 1 - share : share;
    piece.clear[j] = contact.slope * d;
    piece.opacity[j] = 1 - piece.clear[j];
    least = std::min(least, d);
    most = std::max(most, d);
    piece.x_error = std::max(piece.x_error, std::abs(share));
  }
  piece.x_error = slack * (4 * unit_roundoff * std::max(1.0, piece.x_error) + contact.distance_error / contact.width);
  // Small opacities come as 1 less their rest.
  if (contact.slope * most > 0.5) piece.clear_error += 4 * unit_roundoff;
  if (most < -contact.distance_error) {
    append_neighbour(contact, stretch, budget, buffers);
    return;
  }
  if (most <= most_clear_ratio * least) {
    append_opacity(piece, level, contact.interval, buffers);
    return;
  }
  const double middle = stretch.begin + (stretch.end - stretch.begin) / 2;
  ContactStretch<Degree> front{stretch.begin, middle, {}};
  ContactStretch<Degree> back{middle, stretch.end, stretch.distance};
  auto& points = back.distance.coefficients;
  for (std::size_t last = Degree; last > 0; --last) {
    front.distance.coefficients[Degree - last] = points[0];
    for (std::size_t i = 0; i < last; ++i) points[i] = (points[i] + points[i + 1]) * 0.5;
  }
  front.distance.coefficients[Degree] = points[0];
  const auto is_hidden = [&](const ContactStretch<Degree>& half) {
    return std::all_of(half.distance.coefficients.begin(), half.distance.coefficients.end(),
                       [&](const DoubleDouble& d) { return std::abs(d.high) <= 4 * contact.distance_error; });
  };
  if (is_undividable(piece, level) || is_hidden(front) || is_hidden(back)) {
    append_touching(piece, contact, buffers);
    return;
  }
  append_contact_stretch(contact, front, level + 1, budget, buffers);
  append_contact_stretch(contact, back, level + 1, budget, buffers);
}

/// Appends a stretch that is beyond the contact, in the neighbour's interval.
template <int Degree>
void RayIntegral::Parts::append_neighbour(const Contact<Degree>& contact, const ContactStretch<Degree>& stretch,
                                          int& budget, Buffers<Degree>& buffers) const {
  const std::size_t neighbour = contact.is_at_top ? contact.interval + 1 : contact.interval - 1;
  const KnotStretch beyond{contact.piece_index, stretch.begin, stretch.end, neighbour};
  Stretches<Degree> eight;
  set_stretch(eight, 0, contact.piece.polynomial, contact.error.signal, stretch.begin, stretch.end,
              intervals_[neighbour]);
  const auto normalised = kernels<Degree>().normalise(eight);
  if (intervals_[neighbour].is_opaque)
    append_opaque(neighbour, normalised, 0, true, true, buffers);
  else
    accept_or_halve(contact.piece, contact.error, beyond, normalised, 0, budget, buffers);
}

/// Appends a stretch so short that all that is known of it is bounds. Beyond the contact the neighbour's function
/// holds: another opacity that falls from 1, or anything less, or the ray ends.
template <int Degree>
void RayIntegral::Parts::append_touching(const OpacityPiece<Degree>& piece, const Contact<Degree>& contact,
                                         Buffers<Degree>& buffers) const {
  const LinearInterval& here = intervals_[contact.interval];
  const IntervalEnd& end = contact.is_at_top ? here.end_1 : here.end_0;
  PieceIntegral<> integral = crude(piece, emission_);
  const bool is_known = std::isfinite(integral.depth_error);
  if (!contact.is_inside) {
    const double ratio = contact.slope * contact.width / end.contact_slope;
    integral.depth_error += integral.depth + piece.units * std::max(0.0, std::log(ratio));
    integral.weight_error += std::abs(integral.weight_0) + std::abs(integral.weight_1);
  }
  if (!is_known) integral.depth_error = 0;
  append(integral, contact.interval, buffers);
  buffers.doubts.resize(buffers.intervals.size());
  const bool may_be_beyond = end.is_opaque_beyond && !contact.is_inside;
  if (is_known && !may_be_beyond) return;
  Doubt doubt{.kind = Doubt::Kind::may_end, .is_throughout = true};
  if (may_be_beyond) doubt.interval = contact.is_at_top ? contact.interval + 1 : contact.interval - 1;
  buffers.doubts.back() = doubt;
}

/// Appends what is opaque: the ray ends at its beginning, if it `is_certain` that it is there. Inside a piece, where it
/// `is_entered`, that is at a knot, whatever the rounded place of the crossing makes of the scalar.
template <int Degree>
void RayIntegral::Parts::append_opaque(std::size_t interval, const NormalisedStretches<Degree>& normalised,
                                       std::size_t lane, bool is_certain, bool is_entered,
                                       Buffers<Degree>& buffers) const {
  double x = 0;
  double x_error = 0;
  Doubt doubt{.kind = is_certain ? Doubt::Kind::has_ended : Doubt::Kind::may_go_on};
  if (intervals_[interval].is_linear) {
    x = normalised.x[0][lane];
    x_error = normalised.x_error[lane];
    const double knot = x < 0.5 ? 0 : 1;
    const double distance = std::abs(x - knot);
    if (distance < brief)
      doubt.interval = knot == 0 ? interval - 1 : interval + 1;
    else if (is_certain)
      doubt.kind = Doubt::Kind::none;
    if (distance < brief) {
      // The ray may have come through the knot a moment before.
      x_error = is_certain && is_entered ? 0 : x_error + distance;
      if (is_certain && is_entered) x = knot;
    }
  }
  const bool is_associated = emission_ == Emission::associated;
  append({.weight_0 = is_associated ? 1 - x : 0,
          .weight_1 = is_associated ? x : 0,
          .weight_error = slack * (x_error + 4 * unit_roundoff * std::max(1.0, std::abs(x))),
          .depth = beyond_opaque},
         interval, buffers);
  buffers.is_over = is_certain;
  buffers.doubts.resize(buffers.intervals.size());
  buffers.doubts.back() = doubt;
}

/// The integrals of all pieces, in their order along the ray.
template <int Degree>
void RayIntegral::Parts::find_integrals(Buffers<Degree>& buffers) const {
  buffers.integrals.clear();
  for (const auto& piece : buffers.pieces) buffers.integrals.push_back(integrate(piece, emission_));
  if (buffers.sources.empty()) return;
  const std::size_t linear_eights = buffers.pieces.size();
  for (const auto& piece : buffers.opacity_pieces) buffers.integrals.push_back(integrate(piece, emission_));
  buffers.in_order.assign((buffers.sources.size() + lane_count - 1) / lane_count, {});
  for (std::size_t i = 0; i < buffers.sources.size(); ++i) {
    const auto [kind, index] = buffers.sources[i];
    PieceIntegral<Eight>& to = buffers.in_order[i / lane_count];
    const std::size_t lane = i % lane_count;
    if (kind == Source::Kind::known) {
      set_lane(to, lane, buffers.known[index]);
    } else {
      const std::size_t eight = index / lane_count + (kind == Source::Kind::opacity ? linear_eights : 0);
      set_lane(to, lane, lane_of(buffers.integrals[eight], index % lane_count));
    }
  }
  std::swap(buffers.integrals, buffers.in_order);
}

/// Integrates the pieces and adds them to the sum.
template <int Degree>
void RayIntegral::Parts::integrate_pieces(Buffers<Degree>& buffers, Sum& sum) const {
  const std::size_t count = buffers.intervals.size();
  find_integrals(buffers);
  for (std::size_t first = 0; first < count; first += lane_count) {
    const PieceIntegral<Eight>& integrals = buffers.integrals[first / lane_count];
    const std::size_t used = std::min(lane_count, count - first);
    Eight depths{};
    Eight depth_errors{};
    for (std::size_t lane = 0; lane < used; ++lane) {
      depths[lane] = sum.depth.high;
      depth_errors[lane] = sum.depth_error + sum.depth.high * unit_roundoff;
      sum.depth = sum.depth + integrals.depth[lane];
      sum.depth_error = slack * (sum.depth_error + integrals.depth_error[lane] + buffers.depth_errors[first + lane]);
      sum.nodes += integrals.nodes[lane];
    }
    const Eight transmittances = kernels<Degree>().transmittances(depths);
    for (std::size_t lane = 0; lane < used; ++lane) {
      const LinearInterval& interval = intervals_[buffers.intervals[first + lane]];
      Vector3<double> color = integrals.weight_0[lane] * interval.at_0.color;
      double color_error = integrals.weight_error[lane] * interval.at_0.color.maxCoeff();
      if (interval.is_linear) {
        color += integrals.weight_1[lane] * interval.at_1.color;
        color_error += integrals.weight_error[lane] * interval.at_1.color.maxCoeff();
      }
      color_error += buffers.color_errors[first + lane];
      const double transmittance = transmittances[lane];
      const double drift = drift_of(depths[lane], transmittance, depth_errors[lane]);
      sum.color_error +=
          slack * (std::min(1.0, transmittance + drift) * color_error +
                   color.abs().maxCoeff() * (drift + transmittance * (exponential_error + 6 * unit_roundoff)));
      sum.add_color(transmittance * color);
      if (buffers.doubts.empty()) continue;
      const Doubt& doubt = buffers.doubts[first + lane];
      const double most_seen = std::min(1.0, transmittance + drift);
      sum.add_doubt(doubt, buffers.intervals[first + lane], most_seen);
    }
  }
  sum.pieces += count;
  buffers.clear_pieces();
}

/// What the unknown last bit of a ray's length costs where the opacity may be 1 just there.
template <int Degree>
void RayIntegral::Parts::add_end(const Chain<Degree>& signal, const SignalError& error, Sum& sum) const {
  sum.doubt = std::max(sum.doubt, sum.pending);
  if (signal.pieces.empty() || !(error.of_length + error.unclaimed > 0)) return;
  const auto& piece = signal.pieces.back();
  double steepest = 0;
  const auto& b = piece.polynomial.coefficients;
  for (std::size_t j = 0; j < Degree; ++j) steepest = std::max(steepest, std::abs(b[j + 1] - b[j]));
  const double reach = slack * (2 * Degree * steepest * error.of_length / piece.length) +
                       (error.of_pieces.empty() ? 0 : error.of_pieces.back());
  const double extinction = intervals_.most_extinction(b[Degree] - reach, b[Degree] + reach);
  const double most = most_mean_of_opaque * intervals_.units_per_length();
  sum.end_extinction = std::min(extinction, most);
  if (!(extinction <= most)) sum.doubt = std::max(sum.doubt, exponential(-sum.depth.high));
}

/// The whole ray: what the sums, an unknown end and what is hidden behind opaque matter add to the errors.
Answer RayIntegral::Parts::finish(const Sum& sum, double length, double hidden, const SignalError& error) const {
  const bool associated = emission_ == Emission::associated;
  const double most_color = intervals_.most_color();
  // The extinction has no bound where the opacity is 1; its means have one.
  const double most_extinction = intervals_.has_opaque_points() ? most_mean_of_opaque * intervals_.units_per_length()
                                                                : intervals_.most_extinction();
  const double end_extinction = intervals_.has_opaque_points() ? sum.end_extinction : most_extinction;
  const double unknown_depth = intervals_.has_opaque_points()
                                   ? end_extinction * error.of_length + most_extinction * error.unclaimed
                                   : most_extinction * (error.of_length + error.unclaimed);
  const double density = associated ? most_extinction * most_color : most_color;
  const double end_density = associated ? end_extinction * most_color : most_color;
  const double depth = sum.depth.high;
  const double depth_error = slack * (sum.depth_error + depth * unit_roundoff + unknown_depth);
  const double transmittance = exponential(-depth);
  const double drift = drift_of(depth, transmittance, depth_error);
  const double most_hidden = hidden > 0 ? exponential(-opaque_depth) : 0;

  Answer result;
  result.nodes = sum.nodes;
  result.light.color = sum.color + sum.color_rest;
  result.light.opacity = -std::expm1(-depth);
  const double brightest = result.light.color.maxCoeff();
  const double count = static_cast<double>(sum.pieces) + 1;
  const double summation = (2 + 2 * count * count * unit_roundoff) * unit_roundoff;
  result.color_error =
      sum.color_error + summation * brightest + std::min(1.0, transmittance + drift) * end_density * error.of_length +
      // Two things may be wrong, anywhere on the ray: the source there, and what is seen through it.
      (error.unclaimed > 0 ? density * (associated ? 2 : 1 + length * most_extinction) * error.unclaimed : 0) +
      most_hidden * (associated ? most_color : most_color * hidden) +
      sum.doubt * (associated ? most_color : most_color * length);
  result.opacity_error = drift + most_hidden + sum.doubt + 4 * unit_roundoff * result.light.opacity;
  return result;
}

/// The answer with one radius, of colour and opacity.
Certified RayIntegral::Parts::certified(const Answer& answer, double length, double tolerance) const {
  Certified result;
  result.color = answer.light.color;
  result.opacity = answer.light.opacity;
  result.radius = slack * std::max(answer.color_error, answer.opacity_error);
  result.evaluations = static_cast<std::int64_t>(answer.nodes);

  const double most_color = intervals_.most_color();
  const double scale = std::max(1.0, emission_ == Emission::associated ? most_color : most_color * length);
  // No light is brighter than this, no opacity above 1: more is known without any integral, or all is not a number.
  if (!(result.radius <= scale)) {
    result.color = Vector3<double>::Constant(0);
    result.opacity = 0.5;
    result.radius = scale;
  }
  if (!(result.radius <= tolerance * scale)) result.status = Status::not_converged;
  return result;
}

/// The integral in the units at hand, right as long as no number leaves the range of binary64.
template <int Degree>
Answer RayIntegral::Parts::integrate_ray(const Chain<Degree>& signal, const SignalError& error) {
  auto& buffers = std::get<Buffers<Degree>>(buffers_);
  Sum sum;
  double hidden = 0;  // length behind what is opaque
  for (std::size_t piece = 0; piece < signal.pieces.size(); ++piece) {
    cut_(intervals_, signal.pieces[piece].polynomial, piece, buffers.stretches);
    const bool is_last = piece + 1 == signal.pieces.size();
    if (buffers.stretches.size() < pieces_at_once && !is_last) continue;
    fit(signal, error, buffers);
    buffers.stretches.clear();
    integrate_pieces(buffers, sum);
    if (sum.is_opaque() && !is_last) {
      hidden = static_cast<double>(signal.end - signal.pieces[piece + 1].start);
      break;
    }
  }
  if (intervals_.has_opaque_points()) add_end(signal, error, sum);
  return finish(sum, signal.length(), hidden, error);
}

/// What all results below 2^-1022 together may have lost. Each errs by 2^-1075 at most, and a piece takes fewer than
/// 2^40 of them; on the way to the answer a length's is multiplied by an extinction and a colour, an extinction's by a
/// length and a colour, and that of x, where scalars are so small that there is one, by the scale of an interval and by
/// all of these.
template <int Degree>
double RayIntegral::Parts::underflow(const Chain<Degree>& signal) const {
  constexpr double smallest = 0x1p-300;  // differences of such scalars, and their ninth powers, are far above 2^-1022
  const double length = signal.length();
  const double extinction = std::max(1.0, intervals_.most_extinction());
  const double factor = 0x1p-1035 * static_cast<double>(signal.pieces.size()) * std::max(1.0, intervals_.most_color());
  const auto is_ordinary = [](double s) { return s == 0 || std::abs(s) >= smallest; };
  const auto& knots = intervals_.knots();
  const bool are_ordinary = knots.back() - knots.front() <= 1 / smallest &&
                            std::all_of(knots.begin(), knots.end(), is_ordinary) &&
                            std::all_of(signal.pieces.begin(), signal.pieces.end(), [&](const Piece<Degree>& piece) {
                              const auto& b = piece.polynomial.coefficients;
                              return std::all_of(b.begin(), b.end(), is_ordinary);
                            });
  const double of_x = are_ordinary ? 0 : intervals_.largest_scale() * extinction * std::max(1.0, length);
  return factor * (extinction + length + of_x);
}

/// Whether there is nothing along the ray but what lies in its unknown end, and that adds to the radius all it can.
template <int Degree>
bool RayIntegral::Parts::is_dark(const Chain<Degree>& signal, const SignalError& error) {
  constexpr double smallest = 0x1p-300;
  const double unknown = error.of_length + error.unclaimed;
  const double most = std::max(intervals_.most_extinction(), intervals_.most_color());
  if (unknown > 0 && most > 0 && std::min(1.0, most) * unknown < 0x1p-900) return false;
  bool are_coefficients_dark = true;
  for (std::size_t i = 0; i < signal.pieces.size() && are_coefficients_dark; ++i) {
    const auto& b = signal.pieces[i].polynomial.coefficients;
    const auto [low, high] = std::minmax_element(b.begin(), b.end());
    const double reach = error.of_pieces.empty() ? 0 : error.of_pieces[i];
    are_coefficients_dark = intervals_.are_dark(*low - reach, *high + reach, emission_);
  }
  if (are_coefficients_dark) return true;
  // What light there is beyond an interval would be seen in the errors, unless it is too little for binary64.
  if (signal.length() * intervals_.most_extinction() < smallest) return false;
  auto& buffers = std::get<Buffers<Degree>>(buffers_);
  for (std::size_t i = 0; i < signal.pieces.size(); ++i)
    cut_(intervals_, signal.pieces[i].polynomial, i, buffers.stretches);
  fit(signal, error, buffers);
  buffers.stretches.clear();
  const auto is_zero = [](double x) { return x == 0; };
  const bool is_dark = std::all_of(buffers.intervals.begin(), buffers.intervals.end(),
                                   [this](std::size_t interval) { return intervals_.is_dark(interval, emission_); }) &&
                       std::all_of(buffers.depth_errors.begin(), buffers.depth_errors.end(), is_zero) &&
                       std::all_of(buffers.color_errors.begin(), buffers.color_errors.end(), is_zero);
  buffers.clear_pieces();
  return is_dark;
}

/// Integrates where lengths, extinctions or colours are so small or so large that their products underflow or
/// overflow: all in units of their own, and what underflows even so is added to the errors.
template <int Degree>
Answer RayIntegral::Parts::integrate_in_other_units(const Chain<Degree>& signal, const SignalError& error) const {
  const Units units = units_for(transfer_, signal.length());
  Parts parts(in_units(transfer_, units), emission_);
  const Chain<Degree> chain = in_units(signal, units);
  Answer answer = parts.integrate_ray(chain, in_units(error, units));
  const double lost = parts.underflow(chain);
  const double brightest = answer.light.color.maxCoeff();
  if (units.depth() != 0) {
    // Proportional to the extinction, as `Units` says, which may have been rounded.
    answer.color_error += 4 * unit_roundoff * brightest;
    answer.opacity_error += 4 * unit_roundoff * answer.light.opacity;
  }
  const int of_color = units.color + (emission_ == Emission::associated ? units.depth() : units.length);
  const auto upwards = [lost](double x, int exponent) {
    // The answer is rounded once more where it is below 2^-1022.
    return std::nextafter(std::ldexp(slack * (x + lost), exponent), HUGE_VAL) + 0x1p-1074;
  };
  answer.color_error = intervals_.most_color() > 0 ? upwards(answer.color_error, of_color) : 0;
  answer.opacity_error = intervals_.most_extinction() > 0 ? upwards(answer.opacity_error, units.depth()) : 0;
  answer.light.color = answer.light.color.unaryExpr([&](double c) { return std::ldexp(c, of_color); });
  answer.light.opacity = std::ldexp(answer.light.opacity, units.depth());
  return answer;
}

template <int Degree>
Certified RayIntegral::Parts::operator()(const Chain<Degree>& signal, const SignalError& error, double tolerance) {
  const double length = signal.length();
  const Certified result = certified(integrate_ray(signal, error), length, tolerance);
  const bool is_at_hand = length <= longest_at_hand && length * intervals_.most_extinction() <= deepest_at_hand;
  if (is_at_hand && most_underflow(length, signal.pieces.size()) <= negligible_radius * result.radius) {
    if (result.status == Status::converged || !intervals_.has_jumps() || intervals_.has_opaque_points() ||
        !is_zero(error))
      return result;
    const Certified better = (*this)(precise_chain(signal), tolerance);
    return better.radius < result.radius ? better : result;
  }
  if (is_dark(signal, error)) return result;
  return certified(integrate_in_other_units(signal, error), length, tolerance);
}

template <int Degree>
Certified RayIntegral::Parts::operator()(const PreciseChain<Degree>& signal, double tolerance) {
  // Where the opacity is 1 a chain in binary64 is looked at in pairs of numbers anyway.
  if (intervals_.has_opaque_points()) {
    const auto [chain, error] = rounded(signal);
    return certified(integrate_ray(chain, error), chain.length(), tolerance);
  }
  auto& buffers = std::get<Buffers<Degree>>(buffers_);
  const auto length = static_cast<double>(signal.length);
  Sum sum;
  double hidden = 0;
  for (std::size_t piece = 0; piece < signal.pieces.size(); ++piece) {
    fit_precisely(signal.pieces[piece], buffers);
    integrate_pieces(buffers, sum);
    if (!sum.is_opaque() || piece + 1 == signal.pieces.size()) continue;
    hidden = length;
    break;
  }
  Answer answer =
      finish(sum, length, hidden, {.of_pieces = {}, .of_length = signal.of_length, .unclaimed = signal.unclaimed});
  const double lost = most_underflow(length, signal.pieces.size());
  answer.color_error += lost;
  answer.opacity_error += lost;
  return certified(answer, length, tolerance);
}

RayIntegral::RayIntegral(const PiecewiseLinear& transfer, Emission emission)
    : parts_(std::make_unique<Parts>(transfer, emission)) {}
RayIntegral::~RayIntegral() = default;
RayIntegral::RayIntegral(const RayIntegral& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
RayIntegral& RayIntegral::operator=(const RayIntegral& other) {
  if (this != &other) *parts_ = *other.parts_;
  return *this;
}
RayIntegral::RayIntegral(RayIntegral&&) noexcept = default;
RayIntegral& RayIntegral::operator=(RayIntegral&&) noexcept = default;

template <int Degree>
Certified RayIntegral::operator()(const Chain<Degree>& signal, const SignalError& error, double tolerance) {
  return (*parts_)(signal, error, tolerance);
}

template <int Degree>
Certified RayIntegral::operator()(const PreciseChain<Degree>& signal, double tolerance) {
  return (*parts_)(signal, tolerance);
}

template Certified RayIntegral::operator()(const Chain<3>&, const SignalError&, double);
template Certified RayIntegral::operator()(const Chain<largest_degree>&, const SignalError&, double);
template Certified RayIntegral::operator()(const PreciseChain<3>&, double);
template Certified RayIntegral::operator()(const PreciseChain<largest_degree>&, double);

}  // namespace raytruth
