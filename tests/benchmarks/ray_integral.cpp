// The certified integral against quadrature in binary64 that certifies nothing (Boost, GSL) and against ball arithmetic
// that does (Arb); crossings of a transfer function's points against a scalar Newton method.

#include "raytruth/reference/ray_integral.hpp"
#include "paired.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/kernels/kernels.hpp"
#include "raytruth/reference/arb/arb_numbers.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/piece_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <acb_calc.h>
#include <fmt/format.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <boost/container/static_vector.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace raytruth {
namespace {

using benchmarks::Peer;

/// The coefficients of u^0, u^1, ... of the Bernstein form with these ones.
template <class Real>
std::array<Real, 4> powers_of(const std::array<Real, 4>& b) {
  return {b[0], 3 * (b[1] - b[0]), 3 * ((b[2] - b[1]) - (b[1] - b[0])),
          (b[3] - b[2]) - 2 * (b[2] - b[1]) + (b[1] - b[0])};
}

/// K = length integral_0^1 x tau T du, from which all channels of the colour follow, as a quadrature likes it best: in
/// powers of u, T by the antiderivative of tau.
template <class Real>
struct Integrand {
  explicit Integrand(const LinearPiece<3>& piece)
      : x(powers_of<Real>({piece.x[0], piece.x[1], piece.x[2], piece.x[3]})),
        extinction(Real(piece.length) * piece.extinction_at_0),
        slope(piece.length * (Real(piece.extinction_at_1) - piece.extinction_at_0)),
        depth(extinction + slope * (x[0] + (x[1] / 2 + (x[2] / 3 + x[3] / 4)))) {}

  Real operator()(Real u) const {
    const Real signal = x[0] + u * (x[1] + u * (x[2] + u * x[3]));
    const Real mean = x[0] + u * (x[1] / 2 + u * (x[2] / 3 + u * (x[3] / 4)));
    return signal * (extinction + slope * signal) * std::exp(-u * (extinction + slope * mean));
  }

  std::array<Real, 4> x;
  Real extinction;
  Real slope;
  Real depth;
};

/// The integral to some 18 digits.
double truth_of(const LinearPiece<3>& piece) {
  const Integrand<long double> integrand(piece);
  constexpr int parts = 16;
  using Rule = boost::math::quadrature::gauss<long double, 20>;
  long double sum = 0;
  for (int i = 0; i < parts; ++i)
    sum += Rule::integrate(integrand, static_cast<long double>(i) / parts, static_cast<long double>(i + 1) / parts);
  return static_cast<double>(sum);
}

/// Random cubic pieces of one optical depth, in the forms that they are integrated in.
struct Pieces {
  std::vector<LinearPiece<3>> single;
  std::vector<LinearPiece<3, Eight>> by_eight;
  std::vector<Integrand<double>> integrands;
  std::vector<double> truths;
};

Pieces random_pieces(double depth, std::size_t count) {
  Pieces pieces;
  pieces.by_eight.resize(count / lane_count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto signal = random_numbers(1, RandomStream::points, i, 0);
    const auto extinction = random_numbers(1, RandomStream::points, i, 1);
    const double mean_signal = (signal[0] + signal[1] + signal[2] + signal[3]) / 4;
    const double scale = depth / (extinction[0] + mean_signal * (extinction[1] - extinction[0]));
    const LinearPiece<3> piece{.x = {signal[0], signal[1], signal[2], signal[3]},
                               .extinction_at_0 = scale * extinction[0],
                               .extinction_at_1 = scale * extinction[1],
                               .length = 1};
    pieces.single.push_back(piece);
    pieces.integrands.emplace_back(piece);
    pieces.truths.push_back(truth_of(piece));
    auto& eight = pieces.by_eight[i / lane_count];
    const std::size_t lane = i % lane_count;
    for (std::size_t j = 0; j < 4; ++j) eight.x[j][lane] = piece.x[j];
    eight.extinction_at_0[lane] = piece.extinction_at_0;
    eight.extinction_at_1[lane] = piece.extinction_at_1;
    eight.length[lane] = piece.length;
  }
  return pieces;
}

/// Sums up what a quadrature makes of all pieces: K, and O - K, what the colour takes from the other end, with the
/// opacity O in closed form.
template <class Quadrature>
double sum_over(const Pieces& pieces, Quadrature&& quadrature) {
  double sum_0 = 0;
  double sum_1 = 0;
  for (const Integrand<double>& integrand : pieces.integrands) {
    const double weight_1 = quadrature(integrand);
    sum_0 += -std::expm1(-integrand.depth) - weight_1;
    sum_1 += weight_1;
  }
  return sum_0 + sum_1;
}

template <class Quadrature>
double largest_error(const Pieces& pieces, Quadrature&& quadrature) {
  double largest = 0;
  for (std::size_t i = 0; i < pieces.integrands.size(); ++i)
    largest = std::max(largest, std::abs(quadrature(pieces.integrands[i]) - pieces.truths[i]));
  return largest;
}

/// The quadrature with the fewest evaluations, of those with tolerances 1e-3, 1e-4, ... 1e-15 that are as accurate as
/// asked for.
class Choice {
 public:
  Choice(const Pieces& pieces, double accuracy) : pieces_(pieces), accuracy_(accuracy) {}

  /// `make(tolerance)` gives a quadrature: of any function of u, to a number.
  template <class Make>
  void consider(Make&& make) {
    for (int digits = 3; digits <= 15; ++digits) {
      const auto quadrature = make(std::pow(10.0, -digits));
      if (largest_error(pieces_, quadrature) > accuracy_) continue;
      std::size_t evaluations = 0;
      for (const Integrand<double>& integrand : pieces_.integrands)
        quadrature([&](double u) { return ++evaluations, integrand(u); });
      if (work_ && evaluations >= evaluations_) return;
      evaluations_ = evaluations;
      work_ = [&pieces = pieces_, quadrature] { return sum_over(pieces, quadrature); };
      return;
    }
  }

  [[nodiscard]] const std::function<double()>& work() const { return work_; }

 private:
  const Pieces& pieces_;
  double accuracy_;
  std::size_t evaluations_ = 0;
  std::function<double()> work_;
};

template <unsigned Points>
auto boost_quadrature(double tolerance) {
  return [tolerance](const auto& function) {
    return boost::math::quadrature::gauss_kronrod<double, Points>::integrate(function, 0.0, 1.0, 15, tolerance);
  };
}

auto gsl_quadrature(int key, double tolerance) {
  constexpr std::size_t most_intervals = 100;
  const std::shared_ptr<gsl_integration_workspace> workspace(gsl_integration_workspace_alloc(most_intervals),
                                                             gsl_integration_workspace_free);
  return [=](const auto& function) {
    using Function = std::remove_cvref_t<decltype(function)>;
    gsl_function adapter{[](double u, void* f) { return (*static_cast<const Function*>(f))(u); },
                         const_cast<Function*>(&function)};
    double result = 0;
    double error = 0;
    gsl_integration_qag(&adapter, 0, 1, tolerance, 0, most_intervals, key, workspace.get(), &result, &error);
    return result;
  };
}

/// The peers that reach an accuracy.
std::vector<Peer> uncertified_peers(const Pieces& pieces, double accuracy) {
  gsl_set_error_handler_off();  // where rounding keeps qag from its tolerance its result is judged all the same
  Choice boost_31(pieces, accuracy);
  boost_31.consider(boost_quadrature<31>);
  Choice boost_61(pieces, accuracy);
  boost_61.consider(boost_quadrature<61>);
  Choice gsl(pieces, accuracy);
  for (int key = GSL_INTEG_GAUSS15; key <= GSL_INTEG_GAUSS61; ++key)
    gsl.consider([key](double tolerance) { return gsl_quadrature(key, tolerance); });
  std::vector<Peer> peers;
  for (const auto& [name, choice] : {std::pair("boost_31", &boost_31), {"boost_61", &boost_61}, {"gsl_qag", &gsl}})
    if (choice->work()) peers.push_back({name, choice->work()});
  return peers;
}

enum class Mode { batch, single, scalar };

/// visit(i, K, its error, nodes) for every piece.
template <class Visit>
void integrate_all(Mode mode, const Pieces& pieces, Visit&& visit) {
  constexpr auto emission = Emission::associated;
  if (mode == Mode::batch)
    for (std::size_t i = 0; i < pieces.by_eight.size(); ++i) {
      const PieceIntegral<Eight> integrals = integrate(pieces.by_eight[i], emission);
      for (std::size_t lane = 0; lane < lane_count; ++lane)
        visit(lane_count * i + lane, integrals.weight_1[lane], integrals.weight_error[lane], integrals.nodes[lane]);
    }
  else
    for (std::size_t i = 0; i < pieces.single.size(); ++i) {
      const PieceIntegral<> integral =
          mode == Mode::single ? integrate(pieces.single[i], emission) : integrate_scalar(pieces.single[i], emission);
      visit(i, integral.weight_1, integral.weight_error, integral.nodes);
    }
}

double sum_of_integrals(Mode mode, const Pieces& pieces) {
  double sum = 0;
  integrate_all(mode, pieces, [&](std::size_t, double integral, double, double) { sum += integral; });
  return sum;
}

/// What the pieces have in common.
struct Summary {
  double radius = 0;      ///< the largest
  double mean_nodes = 0;  ///< evaluations per piece
};

/// Nothing where a radius does not hold.
std::optional<Summary> summary_of(Mode mode, const Pieces& pieces) {
  Summary summary;
  bool all_hold = true;
  integrate_all(mode, pieces, [&](std::size_t i, double integral, double error, double nodes) {
    // And half an ulp for the truth's own rounding.
    all_hold &= std::abs(integral - pieces.truths[i]) <= error + 0x1p-53 * pieces.truths[i];
    summary.radius = std::max(summary.radius, error);
    summary.mean_nodes += nodes / static_cast<double>(pieces.single.size());
  });
  return all_hold ? std::optional(summary) : std::nullopt;
}

void report(benchmark::State& state, const Pieces& pieces, const Summary& summary) {
  state.counters["radius"] = summary.radius;
  state.counters["nodes"] = summary.mean_nodes;
  state.counters["nanoseconds_per_piece"] =
      1e9 * state.counters["subject_seconds"] / static_cast<double>(pieces.single.size());
}

/// Both integrals of each piece and its optical depth, with radii, against both integrals by quadratures of K that are
/// as accurate as those radii. What bounds them is arithmetic: the time grows by equal steps with `nodes`, and a node
/// of eight pieces side by side has 23 products, with or without a sum, of which a core makes two at once. What does
/// not grow is as long as eleven nodes, half of it the bound of their number.
void pieces_against_boost_and_gsl(benchmark::State& state, Mode mode, double depth) {
  const Pieces pieces = random_pieces(depth, 512);
  const auto summary = summary_of(mode, pieces);
  if (!summary) return state.SkipWithError("a radius does not hold");
  const auto peers = uncertified_peers(pieces, summary->radius);
  if (peers.empty()) return state.SkipWithError("no peer is as accurate");
  benchmarks::run_against_fastest(
      state, [&] { return sum_of_integrals(mode, pieces); }, peers);
  report(state, pieces, *summary);
}

/// K in ball arithmetic; its polynomials are made in advance.
class ArbIntegrand {
 public:
  explicit ArbIntegrand(const LinearPiece<3>& piece) {
    const arb::Ball length = piece.length;
    arb::Polynomial signal;
    std::array<arb::Ball, 4> b{piece.x[0], piece.x[1], piece.x[2], piece.x[3]};
    const arb::Ball three = 3.0;
    signal.set(0, b[0]);
    signal.set(1, three * (b[1] - b[0]));
    signal.set(2, three * ((b[2] - b[1]) - (b[1] - b[0])));
    signal.set(3, (b[3] - b[0]) - three * (b[2] - b[1]));
    const arb::Polynomial extinction =
        length * (arb::Polynomial(piece.extinction_at_0) +
                  (arb::Ball(piece.extinction_at_1) - arb::Ball(piece.extinction_at_0)) * signal);
    acb_poly_init(emitted_);
    acb_poly_init(depth_);
    acb_poly_set_arb_poly(emitted_, (signal * extinction).get());
    acb_poly_set_arb_poly(depth_, extinction.antiderivative().get());
  }
  ArbIntegrand(const ArbIntegrand&) = delete;
  ArbIntegrand& operator=(const ArbIntegrand&) = delete;
  ~ArbIntegrand() {
    acb_poly_clear(emitted_);
    acb_poly_clear(depth_);
  }

  [[nodiscard]] arb::Ball integral() const {
    constexpr slong bits = 64;
    constexpr slong goal = 50;
    mag_t tolerance;
    acb_t zero;
    acb_t one;
    acb_t result;
    mag_init(tolerance);
    mag_set_ui_2exp_si(tolerance, 1, -goal);
    acb_init(zero);
    acb_init(one);
    acb_one(one);
    acb_init(result);
    acb_calc_integrate(result, value, const_cast<ArbIntegrand*>(this), zero, one, goal, tolerance, nullptr, bits);
    arb::Ball integral;
    arb_set(integral.get(), acb_realref(result));
    mag_clear(tolerance);
    acb_clear(zero);
    acb_clear(one);
    acb_clear(result);
    return integral;
  }

 private:
  /// An entire function: nothing to be done about `order`, with which Arb asks for an analytic one.
  static int value(acb_ptr result, const acb_t u, void* integrand, slong /*order*/, slong bits) {
    const auto& [emitted, depth] = *static_cast<const ArbIntegrand*>(integrand);
    acb_t factor;
    acb_init(factor);
    acb_poly_evaluate(factor, depth, u, bits);
    acb_neg(factor, factor);
    acb_exp(factor, factor, bits);
    acb_poly_evaluate(result, emitted, u, bits);
    acb_mul(result, result, factor, bits);
    acb_clear(factor);
    return 0;
  }

  acb_poly_t emitted_{};
  acb_poly_t depth_{};
};

/// Pieces in batches against certified integration at 64 bits.
void pieces_against_arb(benchmark::State& state, double depth) {
  const Pieces pieces = random_pieces(depth, 32);
  const auto summary = summary_of(Mode::batch, pieces);
  if (!summary) return state.SkipWithError("a radius does not hold");
  std::vector<std::unique_ptr<ArbIntegrand>> integrands;
  double arb_radius = 0;
  for (std::size_t i = 0; i < pieces.single.size(); ++i) {
    integrands.push_back(std::make_unique<ArbIntegrand>(pieces.single[i]));
    const arb::Ball integral = integrands.back()->integral();
    const double own_radius = integral.radius().upper_double();
    if (!(std::abs(integral.nearest() - pieces.truths[i]) <= own_radius + 0x1p-52 * pieces.truths[i]))
      return state.SkipWithError("Arb integrates something else");
    arb_radius = std::max(arb_radius, own_radius);
  }
  benchmarks::run_paired(
      state, [&] { return sum_of_integrals(Mode::batch, pieces); },
      [&] {
        double sum = 0;
        for (const auto& integrand : integrands) sum += integrand->integral().nearest();
        return sum;
      });
  report(state, pieces, *summary);
  state.counters["arb_radius"] = arb_radius;
}

/// Cubics over a transfer function with points at multiples of 1/256 between 0 and 1.
struct Cubic {
  Bernstein<3> bernstein;
  std::array<double, 4> powers{};
};

constexpr std::size_t interval_count = 256;

std::vector<double> knots() {
  std::vector<double> result;
  for (std::size_t i = 0; i <= interval_count; ++i)
    result.push_back(static_cast<double>(i) / static_cast<double>(interval_count));
  return result;
}

double value_of(const std::array<double, 4>& powers, double u) {
  return powers[0] + u * (powers[1] + u * (powers[2] + u * powers[3]));
}

/// 0, where the cubic turns, and 1.
boost::container::static_vector<double, 4> ends_of_runs(const std::array<double, 4>& powers) {
  boost::container::static_vector<double, 4> ends{0};
  const double a = 3 * powers[3];
  const double half_b = powers[2];
  const double c = powers[1];
  const double discriminant = half_b * half_b - a * c;
  if (discriminant > 0) {
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    const auto [first, second] = std::minmax({q / a, c / q});
    for (const double u : {first, second})
      if (0 < u && u < 1) ends.push_back(u);
  }
  ends.push_back(1);
  return ends;
}

/// Every stretch of a cubic on which it is monotone: visit(begin, end, first, count) with the knots strictly between
/// its values.
template <class Visit>
void for_each_run(const Cubic& cubic, const std::vector<double>& knots, Visit&& visit) {
  const auto ends = ends_of_runs(cubic.powers);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const auto [low, high] = std::minmax({value_of(cubic.powers, ends[i]), value_of(cubic.powers, ends[i + 1])});
    const auto first = std::upper_bound(knots.begin(), knots.end(), low);
    const auto last = std::lower_bound(first, knots.end(), high);
    visit(ends[i], ends[i + 1], static_cast<std::size_t>(first - knots.begin()),
          static_cast<std::size_t>(last - first));
  }
}

/// Random cubics that meet `crossings` knots on average.
std::vector<Cubic> random_cubics(double crossings, std::size_t count) {
  std::vector<Cubic> cubics;
  for (std::size_t i = 0; i < count; ++i) {
    const auto shape = random_numbers(2, RandomStream::points, i, 0);
    const auto place = random_numbers(2, RandomStream::points, i, 1);
    const auto powers = powers_of(shape);
    const auto ends = ends_of_runs(powers);
    double low = 1;
    double high = 0;
    double variation = 0;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const double value = value_of(powers, ends[k]);
      low = std::min(low, value);
      high = std::max(high, value);
      if (k > 0) variation += std::abs(value - value_of(powers, ends[k - 1]));
    }
    const double scale = crossings / static_cast<double>(interval_count) / variation;
    const double offset = place[0] * (1 - scale * (high - low)) - scale * low;
    Cubic& cubic = cubics.emplace_back();
    for (std::size_t j = 0; j < 4; ++j) cubic.bernstein.coefficients[j] = offset + scale * shape[j];
    cubic.powers = powers_of(cubic.bernstein.coefficients);
  }
  return cubics;
}

/// Where a cubic, monotone on [low, high], takes a value: Newton's method, and bisection where it would leave the
/// bracket.
double crossing_by_newton(const std::array<double, 4>& p, double target, double low, double high) {
  const double tolerance = 0x1p-30 * (high - low);
  const double value_low = value_of(p, low) - target;
  const double value_high = value_of(p, high) - target;
  const bool ascends = value_low < value_high;
  double u = low + (high - low) * value_low / (value_low - value_high);
  for (int step = 0; step < 64; ++step) {
    const double value = value_of(p, u) - target;
    const double slope = p[1] + u * (2 * p[2] + u * 3 * p[3]);
    (value < 0) == ascends ? low = u : high = u;
    double next = u - value / slope;
    if (!(low < next && next < high)) next = (low + high) / 2;
    const double moved = std::abs(next - u);
    u = next;
    if (moved <= tolerance) break;
  }
  return u;
}

void find_by_newton(const Cubic& cubic, const std::vector<double>& knots, std::vector<double>& found) {
  for_each_run(cubic, knots, [&](double begin, double end, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i)
      found.push_back(crossing_by_newton(cubic.powers, knots[i], begin, end));
  });
}

void find_by_kernel(const Cubic& cubic, const std::vector<double>& knots, std::vector<double>& found) {
  for_each_run(cubic, knots, [&](double begin, double end, std::size_t first, std::size_t count) {
    found.resize(found.size() + count);
    kernels<3>().crossings(cubic.bernstein.coefficients, begin, end, &knots[first], count, false,
                           found.data() + (found.size() - count));
  });
}

template <class Find>
std::size_t find_all(const std::vector<Cubic>& cubics, const std::vector<double>& knots, std::vector<double>& found,
                     Find&& find) {
  found.clear();
  for (const Cubic& cubic : cubics) find(cubic, knots, found);
  return found.size();
}

/// All crossings of cubics with a table's points, eight at a time, against one at a time.
void crossings_against_scalar_newton(benchmark::State& state) {
  const auto cubics = random_cubics(static_cast<double>(state.range(0)), 256);
  const auto table = knots();
  std::vector<double> ours;
  std::vector<double> theirs;
  const std::size_t count = find_all(cubics, table, ours, find_by_kernel);
  if (find_all(cubics, table, theirs, find_by_newton) != count) return state.SkipWithError("crossings differ");
  for (std::size_t i = 0; i < count; ++i)
    if (!(std::abs(ours[i] - theirs[i]) <= 1e-7)) return state.SkipWithError("crossings differ");
  benchmarks::run_paired(
      state, [&] { return find_all(cubics, table, ours, find_by_kernel); },
      [&] { return find_all(cubics, table, theirs, find_by_newton); });
  state.counters["crossings"] = static_cast<double>(count) / static_cast<double>(cubics.size());
  state.counters["nanoseconds_per_crossing"] = 1e9 * state.counters["subject_seconds"] / static_cast<double>(count);
}
BENCHMARK(crossings_against_scalar_newton)->ArgName("crossings")->Arg(1)->Arg(3)->Arg(14)->Arg(139)->UseManualTime();

/// A table of random extinctions and colours.
PiecewiseLinear random_transfer(double largest_extinction) {
  std::vector<TransferPoint> points;
  for (const double s : knots()) {
    const auto u = random_numbers(3, RandomStream::points, points.size());
    points.push_back({s, {largest_extinction * u[0], {u[1], u[2], u[3]}}});
  }
  return PiecewiseLinear(points);
}

/// The volume rendering integral as a careful user of Boost computes it: crossings by Newton's method, between two of
/// them K by 31 points, the opacity in closed form.
class RayByQuadrature {
 public:
  explicit RayByQuadrature(const PiecewiseLinear& transfer) : points_(transfer.points()), knots_(knots()) {}

  Vector3<double> color(const std::vector<Cubic>& cubics, double length) {
    Vector3<double> color = Vector3<double>::Constant(0);
    double transmittance = 1;
    for (const Cubic& cubic : cubics)
      for_each_run(cubic, knots_, [&](double begin, double end, std::size_t first, std::size_t count) {
        const bool ascends = value_of(cubic.powers, begin) < value_of(cubic.powers, end);
        double from = begin;
        for (std::size_t i = 0; i <= count; ++i) {
          const std::size_t above = ascends ? first + i : first + count - i;  // the knot at the interval's upper end
          const double to =
              i == count ? end : crossing_by_newton(cubic.powers, knots_[ascends ? above : above - 1], begin, end);
          add(cubic.powers, length, from, to, above, color, transmittance);
          from = to;
        }
      });
    return color;
  }

 private:
  void add(const std::array<double, 4>& p, double length, double from, double to, std::size_t above,
           Vector3<double>& color, double& transmittance) const {
    const TransferPoint& a = points_[above - 1];
    const TransferPoint& b = points_[above];
    const double scale = 1 / (b.s - a.s);
    const double slope = b.optics.extinction - a.optics.extinction;
    const auto x_at = [&](double u) { return (value_of(p, u) - a.s) * scale; };
    const auto depth_at = [&](double u) {
      const double mean = p[0] + u * (p[1] / 2 + u * (p[2] / 3 + u * (p[3] / 4)));
      return length * u * (a.optics.extinction + slope * scale * (mean - a.s));
    };
    const double depth_before = depth_at(from);
    const double emitted = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double u) {
          const double x = x_at(u);
          return length * x * (a.optics.extinction + slope * x) * std::exp(depth_before - depth_at(u));
        },
        from, to, 15, 1e-9);
    const double opacity = -std::expm1(depth_before - depth_at(to));
    color += transmittance * (a.optics.color * (opacity - emitted) + b.optics.color * emitted);
    transmittance *= 1 - opacity;
  }

  std::vector<TransferPoint> points_;
  std::vector<double> knots_;
};

/// Rays of 64 cubics, crossings and colour and radius, against Boost's 31 points between crossings.
void rays_against_boost(benchmark::State& state) {
  constexpr double length = 0.125;
  const auto cubics = random_cubics(static_cast<double>(state.range(0)), 64);
  const PiecewiseLinear transfer = random_transfer(1);
  Chain<3> chain;
  for (const Cubic& cubic : cubics) {
    chain.pieces.push_back({chain.end, length, cubic.bernstein});
    chain.end = chain.end + length;
  }
  RayIntegral integral(transfer, Emission::associated);
  RayByQuadrature quadrature(transfer);
  const Certified certified = integral(chain);
  const double difference = (quadrature.color(cubics, length) - certified.color).abs().maxCoeff();
  if (!(difference <= certified.radius + 1e-12)) return state.SkipWithError("the colours differ");
  benchmarks::run_paired(
      state, [&] { return integral(chain).opacity; }, [&] { return quadrature.color(cubics, length)[0]; });
  state.counters["radius"] = certified.radius;
  state.counters["difference"] = difference;
  state.counters["nanoseconds_per_cubic"] =
      1e9 * state.counters["subject_seconds"] / static_cast<double>(cubics.size());
}
BENCHMARK(rays_against_boost)->ArgName("crossings")->Arg(1)->Arg(3)->Arg(14)->Arg(139)->UseManualTime();

/// What an opacity that is linear between points costs beside an extinction that is: the same cubics, from 0 to an
/// opacity of `most`, against the extinctions of the two ends. A price is 1 over the speedup.
void opacity_rays_against_linear(benchmark::State& state, double most) {
  Chain<3> chain;
  for (std::uint64_t i = 0; i < 64; ++i) {
    const auto scalars = random_numbers(5, RandomStream::points, i);
    chain.pieces.push_back({chain.end, 0.25, {{scalars[0], scalars[1], scalars[2], scalars[3]}}});
    chain.end = chain.end + 0.25;
  }
  const Vector3<double> red{1, 0, 0};
  const Vector3<double> blue{0, 0, 1};
  constexpr double unit_length = 8;
  const PiecewiseLinear opacity = from_opacity({{0, 0, red}, {1, most, blue}}, unit_length);
  const PiecewiseLinear linear({{0, {0, red}}, {1, {opacity.at(most < 1 ? 1 : 0.99).extinction, blue}}});
  RayIntegral of_opacity(opacity, Emission::associated);
  RayIntegral of_linear(linear, Emission::associated);
  benchmarks::run_paired(
      state, [&] { return of_opacity(chain).opacity; }, [&] { return of_linear(chain).opacity; });
  state.counters["radius"] = of_opacity(chain).radius;
  state.counters["price"] = 1 / state.counters["speedup"];
  state.counters["nanoseconds_per_cubic"] =
      1e9 * state.counters["subject_seconds"] / static_cast<double>(chain.pieces.size());
}

/// Depths are no integers, which is all that BENCHMARK's arguments may be.
[[maybe_unused]] const bool are_registered = [] {
  for (const double depth : {0.01, 0.3, 3.0, 30.0}) {
    for (const auto& [name, mode] :
         {std::pair("batch", Mode::batch), {"single", Mode::single}, {"scalar", Mode::scalar}})
      benchmark::RegisterBenchmark(fmt::format("pieces_against_boost_and_gsl/{}/depth:{}", name, depth).c_str(),
                                   pieces_against_boost_and_gsl, mode, depth)
          ->UseManualTime();
    benchmark::RegisterBenchmark(fmt::format("pieces_against_arb/depth:{}", depth).c_str(), pieces_against_arb, depth)
        ->UseManualTime();
  }
  for (const double most : {0.5, 0.9, 0.99, 1.0})
    benchmark::RegisterBenchmark(fmt::format("opacity_rays_against_linear/most:{}", most).c_str(),
                                 opacity_rays_against_linear, most)
        ->UseManualTime();
  return true;
}();

}  // namespace
}  // namespace raytruth
