#include "raytruth/reference/ray_integral.hpp"

#include "raytruth/core/double_double.hpp"
#include "raytruth/kernels/exponential.hpp"
#include "raytruth/kernels/gauss_legendre.hpp"
#include "raytruth/kernels/kernels.hpp"
#include "raytruth/reference/knot_cut.hpp"
#include "raytruth/reference/linear_interval.hpp"
#include "raytruth/reference/piece_integral.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace raytruth {

namespace {

constexpr double slack = 1 + 0x1p-20;   // second-order terms, and the rounding of the error bounds themselves
constexpr double negligible = 0x1p-48;  // share of an interval's extinction or colour: some roundings of x
constexpr double brief = 0x1p-20;       // share of a stretch outside its interval that halving cannot much improve
constexpr double shortest = 0x1p-45;    // in a piece's unit coordinate
constexpr int most_refinements = 400;   // of one piece
constexpr std::size_t pieces_at_once = 256;

/// How wrong an interval's linear functions are on a stretch that leaves it: by how much at most, and on what share.
struct Outside {
  double share = 0;
  double extinction = 0;
  double color = 0;
  bool is_settled = true;  ///< halving the stretch would not help
};

/// How wrong they are beyond one end of the interval. For degrees n >= 3, e and f the excess at the two ends, g what is
/// inside, x(u) >= -e (1-u)^n - f u^n + g (1 - (1-u)^n - u^n) and (1-u)^n + u^n <= 1 - 3 u (1-u), so for max(e,
/// f) <= g/64 x is negative on at most (e + f) / (2.9 g) of the stretch.
Outside beyond(const IntervalEnd& end, double at_begin, double at_end, double inside, const LinearInterval& interval,
               const LinearIntervals& intervals) {
  const double e = std::max(0.0, -at_begin);
  const double f = std::max(0.0, -at_end);
  if (e == 0 && f == 0 && inside >= 0) return {};
  const double excess = std::max({e, f, -inside});
  Outside outside{.share = 64 * std::max(e, f) <= inside ? slack * (e + f) / (2.9 * inside) : 1};
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
      outside.share <= brief || (outside.share * outside.extinction <= negligible * interval.most_extinction &&
                                 outside.share * outside.color <= negligible * interval.most_color);
  return outside;
}

/// How far exp(-D) can be from its value at hand, for |D - depth| <= depth_error: e^d - 1 <= 2 d up to d = 1. Depths
/// above 700 count as 700.
double drift_of(double depth, double transmittance, double depth_error) {
  if (depth_error >= 1) return 1;
  return transmittance * 2 * depth_error + (depth < 690 ? 0 : 0x1p-990);
}

/// The part of a ray that has been integrated.
struct Sum {
  DoubleDouble depth;
  double depth_error = 0;
  Vector3<double> color = Vector3<double>::Constant(0);
  Vector3<double> color_rest = Vector3<double>::Constant(0);  ///< what the sums rounded away
  double color_error = 0;
  double nodes = 0;
  std::size_t pieces = 0;

  [[nodiscard]] bool is_opaque() const { return depth.high - depth_error > opaque_depth; }

  void add_color(const Vector3<double>& color_here) {
    for (int channel = 0; channel < 3; ++channel) {
      const DoubleDouble exact = two_sum(color[channel], color_here[channel]);
      color[channel] = exact.high;
      color_rest[channel] += exact.low;
    }
  }
};

/// What a ray of a degree leaves behind for the next one: memory.
template <int Degree>
struct Buffers {
  std::vector<KnotStretch> stretches;
  std::vector<LinearPiece<Degree, Eight>> pieces;  ///< the first `count` lanes are in use
  std::vector<PieceIntegral<Eight>> integrals;
  std::vector<std::size_t> intervals;
  std::vector<double> depth_errors;  ///< by what the scalar does outside its interval
  std::vector<double> color_errors;
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

}  // namespace

struct RayIntegral::Parts {
  Parts(const PiecewiseLinear& transfer, Emission its_emission) : intervals_(transfer), emission_(its_emission) {}

  template <int Degree>
  Certified integrate_ray(const Chain<Degree>& signal, const SignalError& error, double tolerance);

 private:
  template <int Degree>
  void fit(const Chain<Degree>& signal, const SignalError& error, Buffers<Degree>& buffers) const;
  template <int Degree>
  void accept_or_halve(const Piece<Degree>& piece, double signal_error, const KnotStretch& stretch,
                       const NormalisedStretches<Degree>& normalised, std::size_t lane, int& budget,
                       Buffers<Degree>& buffers) const;
  template <int Degree>
  void integrate_pieces(Buffers<Degree>& buffers, Sum& sum) const;
  [[nodiscard]] Certified finish(const Sum& sum, double length, double hidden, const SignalError& error,
                                 double tolerance) const;

  LinearIntervals intervals_;
  Emission emission_;
  KnotCut cut_;
  std::tuple<Buffers<3>, Buffers<largest_degree>> buffers_;
};

/// Makes pieces of the stretches, front to back.
template <int Degree>
void RayIntegral::Parts::fit(const Chain<Degree>& signal, const SignalError& error, Buffers<Degree>& buffers) const {
  const auto error_of = [&error](std::size_t piece) { return error.of_pieces.empty() ? 0.0 : error.of_pieces[piece]; };
  const auto& stretches = buffers.stretches;
  Stretches<Degree> eight;
  for (std::size_t first = 0; first < stretches.size(); first += lane_count) {
    const std::size_t used = std::min(lane_count, stretches.size() - first);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const KnotStretch& stretch = stretches[first + std::min(lane, used - 1)];
      set_stretch(eight, lane, signal.pieces[stretch.piece].polynomial, error_of(stretch.piece), stretch.begin,
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

/// Appends a stretch that is inside its interval but for what its errors cover; else its two halves.
template <int Degree>
void RayIntegral::Parts::accept_or_halve(const Piece<Degree>& piece, double signal_error, const KnotStretch& stretch,
                                         const NormalisedStretches<Degree>& normalised, std::size_t lane, int& budget,
                                         Buffers<Degree>& buffers) const {
  const LinearInterval& interval = intervals_[stretch.interval];
  const auto beyond_end = [&](const IntervalEnd& end, const Margins& margins) {
    return beyond(end, margins.at_begin[lane], margins.at_end[lane], margins.inside[lane], interval, intervals_);
  };
  const std::array ends{beyond_end(interval.end_0, normalised.from_0), beyond_end(interval.end_1, normalised.from_1)};
  const double width = stretch.end - stretch.begin;
  const bool is_settled = ends[0].is_settled && ends[1].is_settled;
  if (!is_settled && width > shortest && budget > 0 && !is_noise(normalised, lane)) {
    --budget;
    const double middle = stretch.begin + width / 2;
    for (const auto& [begin, end] : {std::pair{stretch.begin, middle}, {middle, stretch.end}}) {
      const double value = piece.polynomial.value(begin + (end - begin) / 2);
      const auto& knots = intervals_.knots();
      const auto above = std::upper_bound(knots.begin(), knots.end(), value);
      const KnotStretch half{stretch.piece, begin, end, static_cast<std::size_t>(above - knots.begin())};
      Stretches<Degree> eight;
      set_stretch(eight, 0, piece.polynomial, signal_error, begin, end, intervals_[half.interval]);
      accept_or_halve(piece, signal_error, half, kernels<Degree>().normalise(eight), 0, budget, buffers);
    }
    return;
  }

  const double length = width * piece.length;
  double depth_error = 0;
  double color_error = 0;
  for (const Outside& outside : ends) {
    if (outside.share == 0) continue;
    const double stretch_outside = slack * length * outside.share;
    const double color = interval.most_color + outside.color;
    depth_error += stretch_outside * outside.extinction;
    // Two things may be wrong: the source there, and all that is seen through the stretch.
    if (emission_ == Emission::associated)
      color_error += stretch_outside * (2 * outside.extinction * color + interval.most_extinction * outside.color);
    else
      color_error += stretch_outside * (outside.color + length * outside.extinction * color);
  }
  const std::size_t to = buffers.intervals.size() % lane_count;
  if (to == 0) buffers.pieces.emplace_back().length.fill(1);
  LinearPiece<Degree, Eight>& result = buffers.pieces.back();
  if (interval.is_linear) {
    for (std::size_t j = 0; j <= Degree; ++j) result.x[j][to] = normalised.x[j][lane];
    result.x_error[to] = normalised.x_error[lane];
  }
  result.extinction_at_0[to] = interval.at_0.extinction;
  result.extinction_at_1[to] = interval.at_1.extinction;
  result.length[to] = length;
  buffers.intervals.push_back(stretch.interval);
  buffers.depth_errors.push_back(depth_error);
  buffers.color_errors.push_back(color_error);
}

/// Integrates the pieces and adds them to the sum.
template <int Degree>
void RayIntegral::Parts::integrate_pieces(Buffers<Degree>& buffers, Sum& sum) const {
  const std::size_t count = buffers.intervals.size();
  buffers.integrals.clear();
  for (const auto& piece : buffers.pieces) buffers.integrals.push_back(integrate(piece, emission_));
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
    }
  }
  sum.pieces += count;
  buffers.pieces.clear();
  buffers.intervals.clear();
  buffers.depth_errors.clear();
  buffers.color_errors.clear();
}

/// The whole ray: what the sums, an unknown end and what is hidden behind opaque matter add to the radius.
Certified RayIntegral::Parts::finish(const Sum& sum, double length, double hidden, const SignalError& error,
                                     double tolerance) const {
  const bool associated = emission_ == Emission::associated;
  const double most_color = intervals_.most_color();
  const double most_extinction = intervals_.most_extinction();
  const double density = associated ? most_extinction * most_color : most_color;
  const double depth = sum.depth.high;
  const double depth_error =
      slack * (sum.depth_error + depth * unit_roundoff + most_extinction * (error.of_length + error.unclaimed));
  const double transmittance = exponential(-depth);
  const double drift = drift_of(depth, transmittance, depth_error);
  const double most_hidden = hidden > 0 ? exponential(-opaque_depth) : 0;

  Certified result;
  result.color = sum.color + sum.color_rest;
  result.opacity = -std::expm1(-depth);
  const double brightest = result.color.maxCoeff();
  const double count = static_cast<double>(sum.pieces) + 1;
  const double summation = (2 + 2 * count * count * unit_roundoff) * unit_roundoff;
  const double color_error = sum.color_error + summation * brightest +
                             std::min(1.0, transmittance + drift) * density * error.of_length +
                             // Two things may be wrong, anywhere on the ray: the source there, and what is seen through
                             // it.
                             density * (associated ? 2 : 1 + length * most_extinction) * error.unclaimed +
                             most_hidden * (associated ? most_color : most_color * hidden);
  const double opacity_error = drift + most_hidden + 4 * unit_roundoff * result.opacity;
  result.radius = slack * std::max(color_error, opacity_error);
  result.evaluations = static_cast<std::int64_t>(sum.nodes);

  const double scale = std::max(1.0, associated ? most_color : most_color * length);
  // No light is brighter than this, no opacity above 1: more is known without any integral, or all is not a number.
  if (!(result.radius <= scale)) {
    result.color = Vector3<double>::Constant(0);
    result.opacity = 0.5;
    result.radius = scale;
  }
  if (!(result.radius <= tolerance * scale)) result.status = Status::not_converged;
  return result;
}

template <int Degree>
Certified RayIntegral::Parts::integrate_ray(const Chain<Degree>& signal, const SignalError& error, double tolerance) {
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
  return finish(sum, signal.length(), hidden, error, tolerance);
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
  return parts_->integrate_ray(signal, error, tolerance);
}

template Certified RayIntegral::operator()(const Chain<3>&, const SignalError&, double);
template Certified RayIntegral::operator()(const Chain<largest_degree>&, const SignalError&, double);

}  // namespace raytruth
