#include "raytruth/shading/highlight.hpp"

#include "raytruth/rules/rules.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace raytruth {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The root of a continuous function that has one between `low` and `high`, to rounding.
template <class Function>
double root_between(const Function& function, double low, double high) {
  std::uintmax_t iterations = 200;
  const auto [left, right] =
      boost::math::tools::toms748_solve(function, low, high, boost::math::tools::eps_tolerance<double>(53), iterations);
  return left + (right - left) / 2;
}

/// log(cosine) (n - excess) for n, excess = 0 or 1.
double log_lobe(double fall, double shininess, double excess) {
  return shininess == infinity ? -fall : (shininess - excess) * std::log1p(-fall / shininess);
}

/// The most positive and the most negative deviation of a family's member from the lobe.
struct Extremes {
  LargestDeviation highest;
  LargestDeviation lowest;
};

Extremes extremes(double ratio, double shininess, int degree) {
  const double foot = std::min(degree / ratio, shininess);
  const auto deviation = [=](double fall) {
    return std::pow(std::max(0.0, 1 - ratio * fall / degree), degree) - std::exp(log_lobe(fall, shininess, 0));
  };
  const auto log_slopes = [=](double fall) {
    return std::log(ratio) + (degree - 1) * std::log1p(-ratio * fall / degree) - log_lobe(fall, shininess, 1);
  };
  Extremes result;
  const auto visit = [&](double fall) {
    const LargestDeviation here{.deviation = deviation(fall), .fall = fall};
    if (here.deviation > result.highest.deviation) result.highest = here;
    if (here.deviation < result.lowest.deviation) result.lowest = here;
  };
  visit(foot);
  const double turn = shininess == infinity
                          ? degree / ratio - (degree - 1)
                          : (degree * (shininess - 1) / ratio - shininess * (degree - 1)) / (shininess - degree);
  const double end =
      foot * (1 - std::numeric_limits<double>::epsilon());  // the slopes' logarithms are infinite at the foot
  const double middle = std::clamp(turn, 0.0, end);
  for (const auto& [low, high] : {std::pair{0.0, middle}, std::pair{middle, end}})
    if (low < high && (log_slopes(low) < 0) != (log_slopes(high) < 0)) visit(root_between(log_slopes, low, high));
  return result;
}

double one(double /*shininess*/) { return 1; }

template <int Degree>
double nearest(double shininess) {
  return minimax_ratio(shininess, Degree);
}

std::vector<Highlight> make_highlights() {
  constexpr Highlight::ClosedForm n;
  return {
      {"lobe", "cosine^n", "Blinn 1977", 0, one, n},
      {"cone", "max(0, 1 + n (cosine - 1))", "Guetat 2010, section 5.2", 1, one, n},
      {"cone_energy", "the cone that reflects as much light as the lobe, exponent (n + 1)/2", "this project", 1,
       [](double shininess) { return (1 + 1 / shininess) / 2; }, Highlight::ClosedForm{.addend = 1, .divisor = 2}},
      {"cone_minimax", "the cone with the least largest deviation from the lobe", "this project", 1, nearest<1>},
      {"square", "max(0, 1 + n/2 (cosine - 1))^2", "this project", 2, one, n},
      {"square_minimax", "the square with the least largest deviation from the lobe", "this project", 2, nearest<2>},
      {"cube", "max(0, 1 + n/3 (cosine - 1))^3", "this project", 3, one, n},
      {"cube_minimax", "the cube with the least largest deviation from the lobe", "this project", 3, nearest<3>},
  };
}

}  // namespace

double Highlight::value(double cosine, double shininess) const {
  return value_at_exponent(cosine, exponent(shininess));
}

double Highlight::value_at_exponent(double cosine, double exponent) const {
  return degree == 0 ? Rules<double>{}.highlight_lobe(cosine, exponent)
                     : Rules<double>{}.highlight_family(cosine, exponent, degree);
}

double Highlight::threshold(double shininess) const { return degree == 0 ? 0 : 1 - degree / exponent(shininess); }

double minimax_ratio(double shininess, int degree) {
  if (shininess == degree) return 1;  // the lobe itself
  // At ratio 1 deviations have one sign; towards the other end of the bracket they get the other one.
  const double other = shininess > degree ? 0.125 : degree / shininess;
  const auto imbalance = [=](double ratio) {
    const auto [highest, lowest] = extremes(ratio, shininess, degree);
    return highest.deviation + lowest.deviation;
  };
  return root_between(imbalance, std::min(1.0, other), std::max(1.0, other));
}

LargestDeviation largest_deviation(const Highlight& highlight, double shininess) {
  const auto [highest, lowest] = extremes(highlight.ratio(shininess), shininess, highlight.degree);
  constexpr double rounding = 1e-12;  // of minimax members both are the largest: the one in the flank is told
  return highest.deviation >= -lowest.deviation * (1 - rounding) ? highest : lowest;
}

namespace catalogue {

const std::vector<Highlight>& highlights() {
  static const std::vector<Highlight> list = make_highlights();
  return list;
}

}  // namespace catalogue

}  // namespace raytruth
