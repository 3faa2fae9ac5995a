#include "raytruth/reference/integral_cases.hpp"

#include "raytruth/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raytruth {

namespace {

/// The largest opacity of random transfer functions that stay below 1.
constexpr double most_opacity = 0.99;

/// Numbers in a row that depend on seed and index alone.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t index) : seed_(seed), index_(index) {}

  /// Uniform in [0, 1).
  double uniform() {
    if (used_ == numbers_.size()) {
      numbers_ = random_numbers(seed_, RandomStream::cases, index_, repetition_++);
      used_ = 0;
    }
    return numbers_[used_++];
  }
  double uniform(double low, double high) { return low + uniform() * (high - low); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  /// 0 ... count - 1.
  int choice(int count) { return static_cast<int>(uniform() * count); }
  Vector3<double> color() { return {uniform(), uniform(), uniform()}; }

 private:
  std::uint64_t seed_;
  std::uint64_t index_;
  std::uint32_t repetition_ = 0;
  std::array<double, 4> numbers_{};
  std::size_t used_ = 4;
};

/// The polynomial of these Bernstein coefficients, at most Degree + 1, to rounding.
template <int Degree>
Bernstein<Degree> elevated(std::vector<double> control) {
  while (control.size() <= Degree) {
    const auto size = static_cast<double>(control.size());
    control.push_back(control.back());
    for (std::size_t i = control.size() - 2; i > 0; --i)
      control[i] += static_cast<double>(i) * (control[i - 1] - control[i]) / size;
  }
  Bernstein<Degree> result;
  std::copy(control.begin(), control.end(), result.coefficients.begin());
  return result;
}

PiecewiseLinear random_transfer(TransferShape shape, double m, Dice& dice) {
  const auto optics = [&] { return Optics{m * dice.uniform(), dice.color()}; };
  const Optics nothing;
  const Optics top{m, dice.color()};
  const auto slab = [&](double half_width) {
    const double centre = dice.uniform(0.2, 0.8);
    return PiecewiseLinear({{centre - half_width, nothing},
                            {centre - half_width, top},
                            {centre + half_width, top},
                            {centre + half_width, nothing}});
  };
  switch (shape) {
    case TransferShape::ramp:
      return PiecewiseLinear({{0, {0, dice.color()}}, {1, top}});
    case TransferShape::tent: {
      const double centre = dice.uniform(0.2, 0.8);
      return PiecewiseLinear({{centre - 0.01, nothing}, {centre, top}, {centre + 0.01, nothing}});
    }
    case TransferShape::box:
      return slab(dice.uniform(0.01, 0.2));
    case TransferShape::step: {
      const double s = dice.choice(2) == 0 ? 0.5 : dice.uniform(0.2, 0.8);
      return PiecewiseLinear({{s, nothing}, {s, top}});
    }
    case TransferShape::isoslab:
      return slab(1.0 / 512);
    case TransferShape::table: {
      std::vector<TransferPoint> points;
      for (int i = 0; i <= 256; ++i) points.push_back({i / 256.0, optics()});
      return PiecewiseLinear(std::move(points));
    }
    case TransferShape::points:
    case TransferShape::jumps: {
      std::vector<double> places(static_cast<std::size_t>(1 + dice.choice(6)));
      for (double& s : places) s = dice.uniform();
      std::sort(places.begin(), places.end());
      std::vector<TransferPoint> points;
      for (const double s : places) {
        points.push_back({s, optics()});
        if (shape == TransferShape::jumps) points.push_back({s, optics()});
      }
      return PiecewiseLinear(std::move(points));
    }
  }
  return PiecewiseLinear({{0, nothing}});
}

PiecewiseLinear random_opacity_transfer(OpacityShape shape, double unit_length, Dice& dice) {
  std::vector<OpacityPoint> points;
  const auto add = [&](double s, double opacity) { points.push_back({s, opacity, dice.color()}); };
  if (shape == OpacityShape::ramp) {
    add(0, most_opacity * dice.uniform());
    add(1, most_opacity);
  } else if (shape == OpacityShape::table) {
    for (int i = 0; i <= 256; ++i) add(i / 256.0, most_opacity * dice.uniform());
  } else {
    std::vector<double> places(static_cast<std::size_t>(3 + dice.choice(4)));
    for (double& s : places) s = dice.uniform();
    std::sort(places.begin(), places.end());
    const auto opaque = static_cast<std::size_t>(dice.choice(static_cast<int>(places.size()) - 1));
    for (std::size_t i = 0; i < places.size(); ++i) {
      double opacity = most_opacity * dice.uniform();
      if (shape == OpacityShape::contacts && i % 2 == 0) opacity = 1;
      if (shape == OpacityShape::opaque && (i == opaque || i == opaque + 1)) opacity = 1;
      add(places[i], opacity);
      if (shape == OpacityShape::jumps || (shape == OpacityShape::opaque && i == opaque + 1 && dice.choice(2) == 0))
        add(places[i], most_opacity * dice.uniform());
    }
  }
  return from_opacity(points, unit_length);
}

/// s, or one of its neighbours in binary64.
double beside(double s, Dice& dice) { return std::nextafter(s, s + dice.choice(3) - 1); }

/// Up to Degree + 1 Bernstein coefficients.
std::vector<double> random_control(SignalShape shape, const PiecewiseLinear& transfer, int degree, Dice& dice) {
  const auto& points = transfer.points();
  const double point = points[static_cast<std::size_t>(dice.choice(static_cast<int>(points.size())))].s;
  switch (shape) {
    case SignalShape::constant:
      return {dice.choice(3) == 0 ? dice.uniform() : beside(point, dice)};
    case SignalShape::tangent: {
      // point + (2 u - 1)^2 rise, or its mirror image; exact where three rises are added to the point without rounding.
      const double rise = std::ldexp(dice.choice(2) == 0 ? 1 : -1, -2 - dice.choice(6));
      const double top = beside(point, dice);
      return {top + 3 * rise, top - rise, top - rise, top + 3 * rise};
    }
    case SignalShape::level: {
      std::vector<double> control(static_cast<std::size_t>(dice.choice(degree + 1)) + 1);
      for (double& b : control) b = beside(point, dice);
      return control;
    }
    case SignalShape::random:
    case SignalShape::short_pieces:
      break;
  }
  // A table has many points: over all of them a ray would cross hundreds.
  const double reach = points.size() > 100 ? 0.05 : 0.6;
  const double centre = dice.uniform();
  std::vector<double> control(static_cast<std::size_t>(dice.choice(degree + 1)) + 1);
  for (double& b : control) b = centre + dice.uniform(-reach, reach);
  return control;
}

template <int Degree>
Chain<Degree> random_signal(SignalShape shape, const PiecewiseLinear& transfer, const std::vector<double>& lengths,
                            Dice& dice) {
  Chain<Degree> chain;
  for (const double length : lengths) {
    chain.pieces.push_back({chain.end, length, elevated<Degree>(random_control(shape, transfer, Degree, dice))});
    chain.end = chain.end + length;
  }
  return chain;
}

}  // namespace

namespace {

/// One polynomial over a length of 1/4 to 2, of degree 3 or up to 9, its coefficients in [0, 1]; `make` finds a
/// transfer function for that length and for the polynomial's mean.
template <class Make>
IntegralCase one_piece(std::uint64_t seed, std::uint64_t index, const Make& make) {
  Dice dice(seed, index);
  const auto piece = [&]<int Degree>(std::integral_constant<int, Degree>, int degree) {
    Chain<Degree> chain;
    std::vector<double> control(static_cast<std::size_t>(degree) + 1);
    for (double& b : control) b = dice.uniform();
    const double length = dice.uniform(0.25, 2);
    chain.pieces.push_back({0.0, length, elevated<Degree>(std::move(control))});
    chain.end = length;
    return IntegralCase{chain, make(length, chain.pieces[0].polynomial.integral(), dice)};
  };
  if (dice.choice(2) == 0) return piece(std::integral_constant<int, 3>{}, 3);
  return piece(std::integral_constant<int, 9>{}, dice.choice(10));
}

}  // namespace

IntegralCase smooth_piece(std::uint64_t seed, std::uint64_t index) {
  return one_piece(seed, index, [](double length, double mean_signal, Dice& dice) {
    const double front = dice.uniform();
    const double back = dice.uniform();
    const double mean = front + mean_signal * (back - front);
    const double m = dice.log_uniform(1e-3, 30) / (length * mean);
    return PiecewiseLinear({{0, {m * front, dice.color()}}, {1, {m * back, dice.color()}}});
  });
}

IntegralCase smooth_opacity_piece(std::uint64_t seed, std::uint64_t index) {
  return one_piece(seed, index, [](double length, double mean_signal, Dice& dice) {
    const double front = most_opacity * dice.uniform();
    const double back = most_opacity * dice.uniform();
    const double mean = front + mean_signal * (back - front);
    const double unit_length = -std::log1p(-mean) * length / dice.log_uniform(1e-3, 30);
    return from_opacity(std::vector<OpacityPoint>{{0, front, dice.color()}, {1, back, dice.color()}}, unit_length);
  });
}

namespace {

std::vector<double> random_lengths(SignalShape signal, bool is_table, Dice& dice) {
  const int most_pieces = is_table ? 3 : 10;
  std::vector<double> lengths(static_cast<std::size_t>(1 + dice.choice(most_pieces)));
  for (double& length : lengths)
    length = signal == SignalShape::short_pieces ? dice.log_uniform(1e-9, 1) : dice.uniform(0.1, 2);
  return lengths;
}

IntegralCase random_ray(SignalShape signal, const PiecewiseLinear& transfer, const std::vector<double>& lengths,
                        Dice& dice) {
  if (dice.choice(2) == 0) return {random_signal<3>(signal, transfer, lengths, dice), transfer};
  return {random_signal<9>(signal, transfer, lengths, dice), transfer};
}

double sum_of(const std::vector<double>& lengths) {
  double whole = 0;
  for (const double length : lengths) whole += length;
  return whole;
}

}  // namespace

IntegralCase random_case(SignalShape signal, TransferShape transfer, std::uint64_t seed, std::uint64_t index) {
  Dice dice(seed, index);
  const std::vector<double> lengths = random_lengths(signal, transfer == TransferShape::table, dice);
  const PiecewiseLinear function = random_transfer(transfer, dice.log_uniform(1e-9, 1e5) / sum_of(lengths), dice);
  return random_ray(signal, function, lengths, dice);
}

IntegralCase random_opacity_case(SignalShape signal, OpacityShape transfer, std::uint64_t seed, std::uint64_t index) {
  Dice dice(seed, index);
  const std::vector<double> lengths = random_lengths(signal, transfer == OpacityShape::table, dice);
  const PiecewiseLinear function =
      random_opacity_transfer(transfer, sum_of(lengths) / dice.log_uniform(1e-3, 30), dice);
  return random_ray(signal, function, lengths, dice);
}

double difference_in_radii(const Certified& a, const Certified& b) {
  // Extended, so that no violation hides in the rounding of a difference.
  using Extended = long double;
  Extended largest = 0;
  const auto compare = [&](double x, double y) {
    const Extended difference = std::abs(static_cast<Extended>(x) - y);
    if (difference == 0) return;
    const Extended radii = static_cast<Extended>(a.radius) + b.radius;
    const bool is_number = std::isfinite(difference) && radii > 0;
    largest = std::max(largest, is_number ? difference / radii : std::numeric_limits<Extended>::infinity());
  };
  for (Eigen::Index i = 0; i < 3; ++i) compare(a.color[i], b.color[i]);
  compare(a.opacity, b.opacity);
  const auto rounded = static_cast<double>(largest);
  return rounded <= 1 && largest > 1 ? std::nextafter(1.0, 2.0) : rounded;
}

}  // namespace raytruth
