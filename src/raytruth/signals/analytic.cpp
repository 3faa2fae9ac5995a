#include "raytruth/signals/analytic.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raytruth {

namespace {

using std::numbers::pi;

constexpr int degree = 9;
using Values = Eigen::Matrix<long double, degree + 1, 1>;
using Matrix = Eigen::Matrix<long double, degree + 1, degree + 1>;

/// The i-th of `count` Chebyshev points of the first kind on [0, 1].
long double chebyshev_point(int i, int count) {
  return (1 - std::cos(std::numbers::pi_v<long double> * (2 * i + 1) / (2 * count))) / 2;
}

/// The matrix from the values at the ten Chebyshev points to Bernstein coefficients: the inverse of B_j(u_i), made in
/// extended precision, since its condition number is about 10^3.
const Matrix& bernstein_from_values() {
  static const Matrix inverse = [] {
    Matrix matrix;
    for (int i = 0; i <= degree; ++i) {
      const long double u = chebyshev_point(i, degree + 1);
      long double binomial = 1;
      for (int j = 0; j <= degree; ++j) {
        matrix(i, j) =
            binomial * std::pow(u, static_cast<long double>(j)) * std::pow(1 - u, static_cast<long double>(degree - j));
        binomial = binomial * (degree - j) / (j + 1);
      }
    }
    return Matrix(matrix.inverse());
  }();
  return inverse;
}

class Expansion {
 public:
  Expansion(const std::function<double(double)>& value, double length) : value_(value), length_(length) {
    for (int i = 0; i <= 64; ++i)
      tolerance_ = std::max(tolerance_, expansion_tolerance * std::abs(value(length * i / 64)));
  }

  void add(double begin, double end) {
    const auto at = [&](long double u) {
      const double value = value_(static_cast<double>(begin + u * (end - begin)));
      if (!std::isfinite(value)) throw InputError(fmt::format("the signal is {} at t = {}", value, begin));
      return value;
    };
    Values values;
    for (int i = 0; i <= degree; ++i) values[i] = at(chebyshev_point(i, degree + 1));
    const Values coefficients = bernstein_from_values() * values;
    Bernstein<degree> polynomial;
    for (int i = 0; i <= degree; ++i)
      polynomial.coefficients[static_cast<std::size_t>(i)] = static_cast<double>(coefficients[i]);

    double deviation = 0;
    for (int i = 0; i <= degree + 1; ++i) {
      const long double u = chebyshev_point(i, degree + 2);
      deviation = std::max(deviation, std::abs(polynomial.value(static_cast<double>(u)) - at(u)));
    }
    if (deviation > tolerance_ && end - begin > 0x1p-20 * length_) {
      const double middle = begin + (end - begin) / 2;
      add(begin, middle);
      add(middle, end);
    } else {
      chain_.pieces.push_back({begin, end - begin, polynomial});
      chain_.end = end;
    }
  }

  Chain<degree> chain() { return std::move(chain_); }

 private:
  const std::function<double(double)>& value_;
  double length_;
  double tolerance_ = 0;
  Chain<degree> chain_;
};

}  // namespace

const std::vector<AnalyticSignal>& analytic_signals() {
  static const std::vector<AnalyticSignal> signals{
      {"sine_slow",
       "as smooth as it looks: 16 samples a period at step 1",
       16,
       {0},
       [](double t) { return 0.5 + 0.5 * std::sin(2 * pi * t / 16); }},
      {"sine_near_nyquist",
       "faithful only below step 1: 2.5 samples a period there",
       16,
       {0},
       [](double t) { return 0.5 + 0.5 * std::sin(2 * pi * t / 2.5); }},
      {"gaussian_wide",
       "a smooth bump, deviation 2",
       16,
       {0},
       [](double t) { return std::exp(-(t - 7.3) * (t - 7.3) / 8); }},
      {"gaussian_narrow",
       "a bump that samples at step 1 can miss, deviation 0.2",
       16,
       {0},
       [](double t) { return std::exp(-(t - 7.3) * (t - 7.3) / 0.08); }},
      {"chirp_past_nyquist",
       "a sine whose frequency rises linearly to 1 per unit: no step is fine everywhere",
       16,
       {0},
       [](double t) { return 0.5 + 0.5 * std::sin(pi * t * t / 16); }},
      {"step_between_samples",
       "a jump from 0 to 1 at 7.3: order 1 at best, whatever the scheme",
       16,
       {7.3},
       [](double t) { return t < 7.3 ? 0.0 : 1.0; }},
      {"kink_between_samples",
       "not as smooth as it looks: a corner at 7.3, as at the border of a cell",
       16,
       {7.3},
       [](double t) { return std::abs(t - 7.3) / 10; }},
  };
  return signals;
}

Chain<9> expand(const std::function<double(double)>& value, const std::vector<double>& breaks, double length) {
  Expansion expansion(value, length);
  double begin = 0;
  for (const double end : breaks) {
    expansion.add(begin, end);
    begin = end;
  }
  if (begin < length) expansion.add(begin, length);
  return expansion.chain();
}

Chain<9> expand(const AnalyticSignal& signal) {
  const bool has_break = signal.breaks[0] > 0;
  return expand(signal.value, has_break ? std::vector{signal.breaks[0]} : std::vector<double>{}, signal.length);
}

}  // namespace raytruth
