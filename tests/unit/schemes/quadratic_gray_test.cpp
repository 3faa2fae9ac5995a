#include "raytruth/schemes/quadratic_gray.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/schemes/quadratic_gray_printed.hpp"
#include "raytruth/tables/second_order.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace raytruth {
namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::array both{Emission::associated, Emission::plain};
constexpr TableAxes grays{.size = 256, .low = 0, .high = largest_gray, .length = 1};

PiecewiseLinear random_transfer(std::size_t count, double scale, std::uint64_t seed = 3) {
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto random = random_numbers(seed, RandomStream::points, i);
    points.push_back({largest_gray * static_cast<double>(i) / static_cast<double>(count - 1),
                      {scale * random[0], {random[1], random[2], random[3]}}});
  }
  return PiecewiseLinear(points);
}

/// With jumps, one of them at 0.
PiecewiseLinear stepped_transfer() {
  return PiecewiseLinear({{0, {0.5, {1, 0, 0}}},
                          {0, {0, {0, 1, 0}}},
                          {60, {0.1, {1, 1, 0}}},
                          {60, {2, {0.2, 0.4, 1}}},
                          {200, {0, {1, 1, 1}}},
                          {255, {3, {0, 0.5, 1}}}});
}

/// Front, middle and back scalars of all courses and of their borders, D = 1.
std::vector<std::array<double, 3>> slabs() {
  std::vector<std::array<double, 3>> list;
  for (std::uint64_t i = 0; i < 400; ++i) {
    const auto random = random_numbers(7, RandomStream::points, i);
    list.push_back({255 * random[0], 255 * random[1], 255 * random[2]});
    list.push_back({std::floor(255 * random[0]), std::floor(255 * random[1]), std::floor(255 * random[2])});
  }
  for (const double a : {16.0, -16.0, 1e-3, -1e-3, 1e-9, -1e-9, 1e-300, 0.0}) {
    const auto of_rise = [&](double front, double rise) {
      list.push_back({front, front + 0.5 * rise - 0.25 * a, front + rise});
    };
    of_rise(60, a);        // b' = 0, from an extremum on a jump
    of_rise(60, -a);       // b' = -2 D', up to it
    of_rise(60, 0);        // the same scalar at both ends
    of_rise(100.25, 0.5);  // its extremum inside
    of_rise(64, 0.25 * a);
    of_rise(200, -40);
  }
  list.push_back({0, 0, 0});
  list.push_back({255, 255, 255});
  list.push_back({60, 60, 60});
  list.push_back({250, 300, 250});  // beyond the data
  list.push_back({5, -40, 5});
  return list;
}

TEST(QuadraticGray, IsTheSlabOfOrder2) {
  for (const PiecewiseLinear& transfer :
       {random_transfer(256, 0.5), random_transfer(17, 40), random_transfer(256, 1e-9), stepped_transfer()})
    for (const Emission emission : both) {
      QuadraticGraySlabs model(clamped(transfer, grays.low, grays.high), emission);
      SecondOrderSlabs certified(transfer, grays, emission);
      for (const auto& [front, middle, back] : slabs()) {
        const Certified truth = certified.certified({front, middle, back});
        const Vec4 found = model(QuadraticGray::of_samples(front, middle, back, 1));
        EXPECT_LE((found - truth.rgba()).abs().maxCoeff(), 1e-12 + truth.radius)
            << front << " " << middle << " " << back;
      }
    }
}

TEST(QuadraticGray, HasItsClosedForms) {
  Rules<double> rules;
  for (const auto& [front, middle, back] : slabs()) {
    const QuadraticGray slab = QuadraticGray::of_samples(front, middle, back, 1);
    EXPECT_NEAR(slab.value(slab.scaled_length), back, 1e-10);
    EXPECT_NEAR(slab.value(0.5 * slab.scaled_length), middle, 1e-10);
    EXPECT_NEAR(slab.radius * slab.scaled_length, 1, 1e-14);
    for (int i = 0; i <= 8; ++i) {
      const double z = slab.scaled_length * i / 8;
      const double speed = slab.slope + 2 * slab.orientation * z;
      if (std::abs(speed) < 1e-3 * (std::abs(slab.slope) + slab.scaled_length)) continue;  // the extremum
      const double found =
          rules.quadratic_gray_place(slab.value(z) - front, slab.slope, slab.orientation, speed > 0 ? 1 : -1);
      // The scalar that is passed is rounded.
      EXPECT_NEAR(found, z, 1e-9 * slab.scaled_length + 1e-13 * (1 + std::abs(front)) / std::abs(speed))
          << front << " " << middle << " " << back;
    }
    if (slab.turns()) {
      const double turn = -0.5 * slab.orientation * slab.slope;
      EXPECT_GT(turn, 0);
      EXPECT_LT(turn, slab.scaled_length);
      EXPECT_NEAR(slab.value(turn), slab.extremum(), 1e-12 * (1 + std::abs(slab.extremum())));
    }
  }
}

TEST(QuadraticGray, IsMirroredWithItsTransferFunction) {
  const PiecewiseLinear transfer = random_transfer(33, 0.5);
  std::vector<TransferPoint> upside_down;
  for (auto point = transfer.points().rbegin(); point != transfer.points().rend(); ++point)
    upside_down.push_back({largest_gray - point->s, point->optics});
  QuadraticGraySlabs slab(transfer, Emission::associated);
  QuadraticGraySlabs mirrored(PiecewiseLinear(upside_down), Emission::associated);
  for (const auto& [front, middle, back] : slabs()) {
    const Vec4 one = slab(QuadraticGray::of_samples(front, middle, back, 1));
    const Vec4 other = mirrored(QuadraticGray::of_samples(255 - front, 255 - middle, 255 - back, 1));
    EXPECT_LE((one - other).abs().maxCoeff(), 1e-12);
    // Opacity is symmetric in its ends.
    EXPECT_NEAR(slab(QuadraticGray::of_samples(back, middle, front, 1))[3], one[3], 1e-13);
  }
}

TEST(QuadraticGray, HasFiniteLimits) {
  QuadraticGraySlabs slab(random_transfer(256, 0.5), Emission::associated);
  double opacity = 1;
  for (int k = 40; k >= -60; --k) {  // D' from 2^40 to 2^-60 at a = 1
    const Vec4 found = slab(QuadraticGray::of_curvature(80, 80, 1, std::ldexp(1.0, k)));
    ASSERT_TRUE(found.isFinite().all()) << k;
    EXPECT_LE(found[3], opacity) << k;
    opacity = found[3];
  }
  EXPECT_LT(opacity, 1e-17);
  // a -> 0 is the linear model.
  const Vec4 line = slab(QuadraticGray::of_curvature(20, 200, 0, 1));
  double distance = 1;
  for (int k = 4; k >= -40; k -= 4) {
    const Vec4 found = slab(QuadraticGray::of_curvature(20, 200, std::ldexp(1.0, k), 1));
    const double here = (found - line).abs().maxCoeff();
    EXPECT_LE(here, distance + 1e-15);
    distance = here;
  }
  EXPECT_LT(distance, 1e-12);
}

/// The light of a slab by half a million midpoints.
Vec4 lit_by_steps(const PiecewiseLinear& transfer, const QuadraticGray& slab, const GradientLight& light) {
  constexpr int steps = 400'000;
  const double step = slab.scaled_length / steps;
  Vec4 sum = Vec4::Zero();
  double depth = 0;
  for (int i = 0; i < steps; ++i) {
    const double z = (i + 0.5) * step;
    const double s = slab.value(z);
    const Optics optics = transfer.at(s);
    const double slope = (transfer.at(s + 1e-7).extinction - transfer.at(s - 1e-7).extinction) / 2e-7;
    double weight = light.front + (light.back - light.front) * z / slab.scaled_length;
    double strength = std::pow(slope, light.slope_power);
    if (light.is_corrected) {
      weight = std::max(slope > 0 ? weight : -weight, 0.0);
      strength = std::abs(slope) > 1e-9 ? 1 : 0;
    }
    const double here = slab.radius * step * optics.extinction;
    const double seen = std::exp(-depth - 0.5 * here);
    sum.head<3>() += slab.radius * step * strength * std::pow(weight, light.weight_power) * seen * optics.color;
    depth += here;
  }
  sum[3] = -std::expm1(-depth);
  return sum;
}

TEST(QuadraticGray, IsLitByTheGradientOfItsOpacity) {
  const PiecewiseLinear transfer(
      {{0, {0, {1, 0, 0}}}, {80, {2, {1, 1, 0}}}, {120, {0.2, {0.2, 0.4, 1}}}, {255, {3, {0, 0.5, 1}}}});
  QuadraticGraySlabs slabs(transfer, Emission::associated);
  const auto expect = [&](const QuadraticGray& slab, const GradientLight& light) {
    const Vec4 truth = lit_by_steps(transfer, slab, light);
    EXPECT_LE((slabs(slab, light) - truth).abs().maxCoeff(), 1e-5 * (1 + truth.abs().maxCoeff()))
        << slab.front << " " << slab.orientation << " " << light.slope_power << " " << light.front << " " << light.back
        << " " << light.is_corrected << " " << truth.transpose() << " found " << slabs(slab, light).transpose();
  };
  for (const QuadraticGray& slab :
       {QuadraticGray::of_curvature(20, 200, 30, 1), QuadraticGray::of_curvature(150, 60, -200, 1),
        QuadraticGray::of_curvature(90, 100, 0, 2)}) {
    expect(slab, {});
    expect(slab, {.front = 0, .back = slab.scaled_length});
    expect(slab, {.slope_power = 3, .weight_power = 3, .front = 1, .back = 0.25});
    expect(slab, {.front = -0.5, .back = 0.75, .is_corrected = true});
    expect(slab, {.slope_power = 7.5, .weight_power = 7.5, .front = 1, .back = 0.5, .is_corrected = true});
  }
  // As printed a falling extinction has no power that is not whole.
  EXPECT_THROW(slabs(QuadraticGray::of_curvature(90, 100, 0, 1), {.slope_power = 2.5, .weight_power = 2.5}),
               InputError);
  QuadraticGraySlabs stepped(stepped_transfer(), Emission::associated);
  EXPECT_THROW(stepped(QuadraticGray::of_curvature(50, 70, 0, 1), GradientLight{}), InputError);
  EXPECT_NO_THROW(stepped(QuadraticGray::of_curvature(61, 70, 0, 1), GradientLight{}));
}

TEST(QuadraticGray, RefusesLinearOpacities) {
  EXPECT_THROW(QuadraticGraySlabs(from_opacity({{0, 0, {1, 1, 1}}, {1, 0.5, {1, 1, 1}}}, 1), Emission::associated),
               InputError);
}

// --- As printed ---

/// The slab at whole gray values by the exact model, linear between the items.
Vec4 exact(const PiecewiseLinear& transfer, Emission emission, double front, double back, double curvature) {
  return QuadraticGraySlabs(transfer, emission)(QuadraticGray::of_curvature(front, back, curvature, 1));
}

struct Entry {
  std::size_t front;
  std::size_t back;
  double curvature;
};

std::vector<Entry> entries() {
  std::vector<Entry> list;
  for (std::uint64_t i = 0; i < 120; ++i) {
    const auto random = random_numbers(11, RandomStream::points, i);
    const double size = std::exp2(12 * random[2] - 6);
    list.push_back({static_cast<std::size_t>(256 * random[0]), static_cast<std::size_t>(256 * random[1]),
                    random[3] < 0.5 ? size : -size});
  }
  for (const double a : {4.0, -4.0, 0.25, 64.0}) {
    list.push_back({100, 104, a});  // where a = 4 begins at its minimum
    list.push_back({104, 100, a});
    list.push_back({30, 30, a});
    list.push_back({2, 5, a});  // M < 0 where a = 64
    list.push_back({0, 255, a});
  }
  return list;
}

TEST(QuadraticGrayPrinted, IsTheIntegralWhereItIsRepaired) {
  const PiecewiseLinear transfer = random_transfer(256, 0.5);
  for (const Emission emission : both) {
    QuadraticGrayPrinted printed(transfer, 0, 255, 1, emission, QuadraticGrayPrint::repaired());
    for (const auto& [front, back, a] : entries()) {
      const Vec4 truth = exact(transfer, emission, static_cast<double>(front), static_cast<double>(back), a);
      EXPECT_LE((printed.entry(front, back, a) - truth).abs().maxCoeff(), 1e-11) << front << " " << back << " " << a;
    }
  }
}

/// Algorithms 9 to 11, to the letter but for the loops over tables, R = 1 / sqrt(a), D = 1.
class Letter {
 public:
  Letter(const std::array<double, 256>& items, bool inclusive, bool nested)
      : items_(items), more_(inclusive ? 1 : 0), nested_(nested) {}

  double operator()(int f, int b, double a) const {
    const double d = std::sqrt(a);
    const double alpha = (b - f) / d - d;
    const double m = f - 0.25 * alpha * alpha;
    double res = 0;
    const auto sum = [&](int from, int to) {
      double result = 0;
      for (int i = from; i < to + more_; ++i) result += att_quad(m, i);
      return result;
    };
    const auto steps = [&](double inf, double sup, double h) {
      double result = 0;
      for (int kk = 1; kk < 10 + more_; ++kk) result += opt(m, inf + kk * h);
      return h * (result + 0.5 * (opt(m, inf) + opt(m, sup)));
    };
    if (std::abs(alpha) < 1e-9) return steps(f + 0.1, f + 1.0, 0.1) + sum(f + 1, b);
    if (alpha > 0) return sum(f, b);
    if (m < 0) return sum(0, f) + sum(0, b);
    const int index = static_cast<int>(std::ceil(m));
    const bool is_whole = index - m < 1e-9;
    if (!is_whole) {
      if (index - m >= 1e-3) {
        const double h = (index - m) * 0.1;
        res += steps(m + h, index, h);
      }
      res += sum(index, f);
      res *= 2;
      res += sum(f, b);
    }
    if (is_whole || nested_) {
      res += sum(index + 1, f);
      res *= 2;
      res += sum(f, b);
    }
    return res;
  }

 private:
  [[nodiscard]] double opt(double m, double t) const {
    t = std::min(t, 255.0);  // the print reads behind its list
    double tn = t + 0.5;
    const int i = std::min(static_cast<int>(tn), 255);
    const double f0 = items_[static_cast<std::size_t>(i == 0 ? 1 : i - 1)];
    const double f1 = items_[static_cast<std::size_t>(i)];
    const double f2 = items_[static_cast<std::size_t>(i == 255 ? 254 : i + 1)];
    tn -= i;
    double res = 0.5 * (f2 + f0) - f1;
    res *= tn * tn;
    res += tn * (f1 - f0);
    res += 0.5 * (f1 + f0);
    return res / (2.0 * std::sqrt(t - m));
  }
  [[nodiscard]] double att_quad(double m, int i) const {
    return (opt(m, i) + 4 * opt(m, i + 0.5) + opt(m, i + 1.0)) / 6;
  }

  std::array<double, 256> items_;
  int more_;
  bool nested_;
};

TEST(QuadraticGrayPrinted, IsAlgorithm9) {
  const PiecewiseLinear transfer = random_transfer(256, 0.5);
  std::array<double, 256> items{};
  for (std::size_t i = 0; i < 256; ++i) items[i] = transfer.at(static_cast<double>(i)).extinction;
  for (const bool inclusive : {false, true})
    for (const bool nested : {false, true}) {
      QuadraticGrayPrint print;
      print.inclusive_loops = inclusive;
      print.nested_end_if = nested;
      QuadraticGrayPrinted printed(transfer, 0, 255, 1, Emission::associated, print);
      const Letter letter(items, inclusive, nested);
      for (const auto& [front, back, a] : entries()) {
        if (a < 0 || (inclusive && std::max(front, back) == 255)) continue;
        const double by_letter =
            letter(static_cast<int>(std::min(front, back)), static_cast<int>(std::max(front, back)), a);
        EXPECT_NEAR(printed.omega(front, back, a), by_letter, 1e-12 * std::max(1.0, by_letter))
            << front << " " << back << " " << a << " " << inclusive << nested;
      }
    }
}

QuadraticGrayPrint only(void (*set)(QuadraticGrayPrint&)) {
  QuadraticGrayPrint print = QuadraticGrayPrint::repaired();
  set(print);
  return print;
}

TEST(QuadraticGrayPrinted, LosesWhatItsSumsLeaveOut) {
  // Constant extinction 1/2: omega is D' / 2, and what is left out is a stretch of y = sqrt(s - M).
  const PiecewiseLinear transfer({{0, {0.5, {1, 1, 1}}}});
  const auto opacity = [&](const QuadraticGrayPrint& print, std::size_t front, std::size_t back, double a) {
    return QuadraticGrayPrinted(transfer, 0, 255, 1, Emission::associated, print).entry(front, back, a)[3];
  };
  const auto of_length = [](double length) { return -std::expm1(-0.5 * length); };
  const QuadraticGrayPrint dropped = only([](QuadraticGrayPrint& print) { print.minimum = AroundMinimum::dropped; });
  // a = 9, rise 3: slope 1 - 3 = -2, M = front - 1; a = 9, rise 0: slope -3, M = front - 9/4, ceil(M) - M = 1/4.
  EXPECT_NEAR(opacity(dropped, 50, 50, 9), of_length((3 - 2 * 0.5) / 3), 1e-14);
  const QuadraticGrayPrint negative = only([](QuadraticGrayPrint& print) { print.drops_negative = true; });
  // a = 64, ends 2: M = 2 - 16 = -14, below 0 is sqrt(14) on either side.
  EXPECT_NEAR(opacity(negative, 2, 2, 64), of_length((8 - 2 * std::sqrt(14.0)) / 8), 1e-14);
  // Simpson's rule between gray values 1 and 2 above M = front - 1.
  const QuadraticGrayPrint simpson = only([](QuadraticGrayPrint& print) { print.simpson = true; });
  const auto rule = [](double offset) {
    return (1 / (2 * std::sqrt(offset)) + 4 / (2 * std::sqrt(offset + 0.5)) + 1 / (2 * std::sqrt(offset + 1))) / 6;
  };
  // The first interval is behind a minimum on a gray value, and exact here.
  EXPECT_NEAR(opacity(simpson, 50, 53, 9), of_length((1 + 1 + rule(1) + rule(2) + rule(3)) / 3), 1e-14);
}

TEST(QuadraticGrayPrinted, TakesDownwardParabolasForLines) {
  const PiecewiseLinear transfer = random_transfer(256, 0.5);
  QuadraticGrayPrinted printed(transfer, 0, 255, 1, Emission::associated);
  QuadraticGraySlabs model(transfer, Emission::associated);
  const Vec4 line = model(QuadraticGray::of_curvature(30, 90, 0, 1));
  EXPECT_LE((printed(30, 90, -20) - line).abs().maxCoeff(), 1e-14);
  EXPECT_LE((printed(30, 90, 1.0 / 65) - line).abs().maxCoeff(), 1e-14);
  EXPECT_GE((printed(30, 90, 20) - line).abs().maxCoeff(), 1e-5);
}

TEST(QuadraticGrayPrinted, SmoothsTheTransferFunction) {
  // A single item: its B-spline is 3/4 high and reaches three halves to both sides, linear it is a tent.
  std::vector<TransferPoint> points;
  for (int i = 0; i < 256; ++i) points.push_back({static_cast<double>(i), {i == 100 ? 1.0 : 0.0, {1, 1, 1}}});
  const PiecewiseLinear transfer(points);
  const QuadraticGrayPrint smoothed = only([](QuadraticGrayPrint& print) { print.smoothed = true; });
  QuadraticGrayPrinted printed(transfer, 0, 255, 1, Emission::associated, smoothed);
  // Nearly constant at 100: |s - 100| is at most 1/256 where a = 1/64.
  EXPECT_NEAR(printed.entry(100, 100, 1.0 / 64)[3], -std::expm1(-0.75), 1e-4);
  EXPECT_NEAR(exact(transfer, Emission::associated, 100, 100, 1.0 / 64)[3], -std::expm1(-1.0), 3e-3);
}

TEST(QuadraticGrayPrinted, SeesThroughAnotherEntry) {
  const PiecewiseLinear transfer = random_transfer(256, 2);
  const QuadraticGrayPrint other = only([](QuadraticGrayPrint& print) { print.entry_transmittance = true; });
  QuadraticGrayPrinted printed(transfer, 0, 255, 1, Emission::plain, other);
  double largest = 0;
  for (const auto& [front, back, a] : entries()) {
    const Vec4 truth = exact(transfer, Emission::plain, static_cast<double>(front), static_cast<double>(back), a);
    const Vec4 found = printed.entry(front, back, a);
    EXPECT_NEAR(found[3], truth[3], 1e-11);
    largest = std::max(largest, (found - truth).head<3>().abs().maxCoeff());
  }
  EXPECT_GE(largest, 0.05);
}

TEST(RadiusNodes, FindWhatStandsAround) {
  const auto expect = [](const RadiusNodes::Place& place, std::size_t first, std::size_t second, double weight) {
    EXPECT_EQ(place.first, first);
    if (weight > 0) {
      EXPECT_EQ(place.second, second);
    }
    EXPECT_NEAR(place.weight, weight, 1e-12);
  };
  const RadiusAxis ours;  // R = 1/8 to 8: nodes 0 to 14, the linear table in the middle
  EXPECT_EQ(ours.node_count(), 15U);
  EXPECT_EQ(ours.curvature(7), 0);
  EXPECT_NEAR(ours.curvature(14), 64, 1e-12);
  EXPECT_NEAR(ours.curvature(6), -1.0 / 64, 1e-15);
  const RadiusNodes nodes(ours);
  expect(nodes.place(0), 7, 7, 0);
  expect(nodes.place(-1.0 / 128), 7, 6, 0.5);
  expect(nodes.place(40), 13, 14, 0.5);
  expect(nodes.place(-1000), 1, 0, 1);
  EXPECT_TRUE(nodes.clamps(-65));
  EXPECT_FALSE(nodes.clamps(64));
  const RadiusNodes printed(printed_radius_axis());  // node 0 linear, 1 to 7 for R = 8 down to 1/8
  expect(printed.place(-3), 0, 0, 0);
  expect(printed.place(1.0 / 65), 0, 0, 0);
  expect(printed.place(1 / (1.5 * 1.5)), 4, 3, 0.5);
  expect(printed.place(100), 7, 7, 0);
  const RadiusNodes wrong(printed_radius_axis(RadiusLookUp::natural_logarithm));
  // ln(6) ln 2 = 1.24: the pair 2 and 4, where 4 and 8 are around.
  expect(wrong.place(1.0 / 36), 3, 2, 1);
  const RadiusNodes equal(
      {.steps = RadiusSteps::equal_steps, .low = 1, .high = 3, .count = 3, .look_up = RadiusLookUp::linear_in_radius});
  expect(equal.place(1 / (2.5 * 2.5)), 5, 4, 0.5);
  expect(equal.place(-1 / (1.25 * 1.25)), 0, 1, 0.25);
}

TEST(RadiusNodes, AgreeWithTheRule) {
  Rules<double> rules;
  for (const RadiusAxis& axis : {RadiusAxis{}, RadiusAxis{.low = 0.03, .high = 5, .count = 10},
                                 RadiusAxis{.low = 0.5, .high = 0.5, .count = 1}}) {
    const RadiusNodes nodes(axis);
    for (int i = -1000; i <= 1000; ++i) {
      const double a = i * std::abs(i) * 1e-4;
      const RadiusNodes::Place place = nodes.place(a);
      const double by_nodes = static_cast<double>(place.first) +
                              place.weight * (static_cast<double>(place.second) - static_cast<double>(place.first));
      const double by_rule = rules.quadratic_gray_node(a, 1 / (axis.high * axis.high), 1 / (axis.low * axis.low),
                                                       static_cast<double>(axis.count));
      EXPECT_NEAR(by_nodes, by_rule, 1e-9) << a;
    }
  }
}

TEST(RadiusAxis, RefusesWhatIsNone) {
  EXPECT_THROW(check(RadiusAxis{.low = 2, .high = 1}), InputError);
  EXPECT_THROW(check(RadiusAxis{.low = 0}), InputError);
  EXPECT_THROW(check(RadiusAxis{.count = 0}), InputError);
  EXPECT_THROW(check(RadiusAxis{.count = most_radii + 1}), InputError);
  EXPECT_THROW(check(RadiusAxis{.steps = RadiusSteps::powers_of_two, .low = 0.125, .high = 9, .count = 7}), InputError);
  EXPECT_THROW(check(RadiusAxis{.steps = RadiusSteps::powers_of_two, .low = 0.125, .high = 8, .count = 6}), InputError);
  EXPECT_NO_THROW(check(printed_radius_axis()));
}

}  // namespace
}  // namespace raytruth
