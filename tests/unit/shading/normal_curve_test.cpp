#include "raytruth/shading/normal_curve.hpp"

#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/core/vector3.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/shading/normal_curve50.hpp"

#include <gtest/gtest.h>
#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace raytruth {
namespace {

const Real50 pi = boost::math::constants::pi<Real50>();
const Real50 tiny("1e-46");  // rounding of some dozen operations on numbers up to 100

const NormalCurve& curve_of(std::string_view name) {
  const NormalCurve* curve = find_named(catalogue::normal_curves(), name);
  if (curve == nullptr) throw std::logic_error(std::string(name));
  return *curve;
}

Real50 radians(double degrees) { return Real50(degrees) * pi / 180; }

Vector3<Real50> random_unit_vector(std::uint64_t index) {
  for (std::uint32_t repetition = 0;; ++repetition) {
    const auto numbers = random_numbers(11, RandomStream::points, index, repetition);
    const Vector3<Real50> vector(Real50(numbers[0] - 0.5), Real50(numbers[1] - 0.5), Real50(numbers[2] - 0.5));
    const Real50 length = sqrt((vector * vector).sum());
    if (length > Real50(0.1) && length < Real50(0.5)) return vector / length;
  }
}

/// A slab and a direction in which it is looked at.
struct Views {
  Real50 front;
  Real50 back;
  Real50 cosine;
};

Views random_views(std::uint64_t index) {
  const Vector3<Real50> front = random_unit_vector(3 * index);
  const Vector3<Real50> back = random_unit_vector(3 * index + 1);
  const Vector3<Real50> view = random_unit_vector(3 * index + 2);
  return {Real50((front * view).sum()), Real50((back * view).sum()), Real50((front * back).sum())};
}

TEST(NormalCurve, CoefficientsOfTheQuadraticArcAreThoseOfGuetatsEquation8) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto [front, back, cosine] = random_views(i);
    const Real50 c = cos(acos(cosine) / 2);
    const Real50 r = 4 * (c - 1) / c;
    const auto a = Rules<Real50>{}.quadratic_arc(front, back, cosine);
    EXPECT_LT(abs(a[0] - front), tiny);
    EXPECT_LT(abs(a[1] - (back - (1 + r) * front)), tiny * abs(r));
    EXPECT_LT(abs(a[2] - r * (2 * front - back)), tiny * abs(r));
    EXPECT_LT(abs(a[3] - r * (back - front)), tiny * abs(r));
  }
}

TEST(NormalCurve, QuadraticArcIsGuetatsEquation6WithItsWeightsExchanged) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    const auto [front, back, cosine] = random_views(i);
    const Real50 c = cos(acos(cosine) / 2);
    const auto corrected = Rules<Real50>{}.quadratic_arc(front, back, cosine);
    const auto printed = Rules<Real50>{}.quadratic_arc_printed(front, back, cosine);
    for (int k = 0; k <= 8; ++k) {
      const Real50 s = Real50(k) / 8;
      const Real50 x = 2 * s - 1;
      const Real50 factor = (1 + x * x * (c - 1)) / c;
      EXPECT_LT(abs(Rules<Real50>{}.normal_curve_value(corrected, s) - factor * (s * back + (1 - s) * front)),
                tiny / c);
      EXPECT_LT(abs(Rules<Real50>{}.normal_curve_value(printed, s) - factor * (s * front + (1 - s) * back)), tiny / c);
    }
  }
}

TEST(NormalCurve, CoefficientsAndWeightsAreTheSameCurve) {
  for (const NormalCurve& curve : catalogue::normal_curves()) {
    if (curve.coefficients == nullptr) continue;
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Views views = random_views(i);
      const double front = to_double(views.front);
      const double back = to_double(views.back);
      const double cosine = to_double(views.cosine);
      const auto a = curve.coefficients(front, back, cosine);
      for (const double s : {0.0, 0.3, 0.5, 1.0})
        EXPECT_NEAR(a[0] + s * (a[1] + s * (a[2] + s * a[3])),
                    curve.weight(1 - s, cosine) * front + curve.weight(s, cosine) * back,
                    1e-14 / std::sqrt((1 + cosine) / 2))
            << curve.name << ' ' << s;
    }
  }
}

TEST(NormalCurve, MeetsTheNormals) {
  for (const NormalCurve& curve : catalogue::normal_curves())
    for (const double angle : {0.0, 0.01, 30.0, 90.0, 170.0}) {
      const Real50 cosine = cos(radians(angle));
      const Real50 at_front = curve.in_50_digits->weight(0, cosine);
      const Real50 at_back = curve.in_50_digits->weight(1, cosine);
      if (curve.name == "mean_gradient") {
        EXPECT_LT(abs(normal_at(curve, Real50(0.3), cosine).norm() - 1), tiny);
        EXPECT_LT(abs(normal_at(curve, Real50(0.3), cosine).chord), tiny);
      } else if (curve.name == "quadratic_arc_printed") {  // the other normal at either end
        EXPECT_LT(abs(at_front - 1), 100 * tiny) << angle;
        EXPECT_LT(abs(at_back), 100 * tiny) << angle;
      } else {
        EXPECT_LT(abs(at_front), 100 * tiny) << curve.name << ' ' << angle;
        EXPECT_LT(abs(at_back - 1), 100 * tiny) << curve.name << ' ' << angle;
      }
    }
}

TEST(NormalCurve, EqualNormalsStayWhatTheyAre) {
  for (const NormalCurve& curve : catalogue::normal_curves())
    for (const double cosine : {1.0, 1.0 + 1e-15})  // as rounded vectors may have
      for (const double s : {0.0, 0.25, 0.5, 1.0}) {
        EXPECT_NEAR(curve.weight(s, cosine) + curve.weight(1 - s, cosine), 1, 1e-15) << curve.name;
        if (curve.name != "mean_gradient" && curve.name != "quadratic_arc_printed") {
          EXPECT_NEAR(curve.weight(s, cosine), s, 1e-15) << curve.name;
        }
      }
}

TEST(NormalCurve, OppositeNormalsLeaveOnlyTheChord) {
  for (const double s : {0.0, 0.25, 0.5, 1.0}) EXPECT_EQ(curve_of("linear_gradient").weight(s, -1), s);
  EXPECT_FALSE(std::isfinite(curve_of("quadratic_arc").weight(0.5, -1)));
  EXPECT_FALSE(std::isfinite(curve_of("mean_gradient").weight(0.5, -1)));
  EXPECT_FALSE(std::isfinite(curve_of("normalized_linear").weight(0.5, -1)));
}

TEST(NormalCurve, ReferencesAreUnitVectors) {
  for (const double angle : {1.0, 60.0, 90.0, 170.0})
    for (const double s : {0.1, 0.25, 0.5, 0.8}) {
      const Real50 cosine = cos(radians(angle));
      for (const char* name : {"normalized_linear", "slerp"})
        EXPECT_LT(abs(normal_at(curve_of(name), Real50(s), cosine).norm() - 1), tiny) << name;
      // The slerp turns at constant speed, the linear interpolation along a chord.
      EXPECT_LT(
          abs(normal_at(curve_of("slerp"), Real50(s), cosine).direction() - (2 * Real50(s) - 1) * radians(angle) / 2),
          tiny);
      const auto chord = normal_at(curve_of("normalized_linear"), Real50(s), cosine);
      EXPECT_LT(abs(chord.chord / chord.bisector - (2 * Real50(s) - 1) * tan(radians(angle) / 2)), 100 * tiny);
    }
}

TEST(NormalCurve, HalfWayTheChordHasTheLengthOfTheCosine) {
  for (const double angle : {1.0, 45.0, 90.0, 120.0})
    EXPECT_LT(abs(normal_at(curve_of("linear_gradient"), Real50(0.5), Real50(cos(radians(angle)))).norm() -
                  cos(radians(angle) / 2)),
              tiny);
}

TEST(NormalCurve, TheQuadraticArcIsNeverShorterThanOne) {
  for (int angle = 1; angle < 180; ++angle) {
    const Real50 cosine = cos(radians(angle));
    for (int i = 0; i <= 64; ++i) {
      const Real50 norm = normal_at(curve_of("quadratic_arc"), Real50(i) / 64, cosine).norm();
      EXPECT_GE(norm, 1 - tiny) << angle;
      if (i > 0 && i != 32 && i < 64) {
        EXPECT_GT(norm, 1) << angle << ' ' << i;
      }
    }
  }
}

/// norm^2 - 1 of a circle arc, from its speed v0 in the middle: y (1-y) (v0^2 - 2 (1-c) - (v0 - sin a)^2 y).
Real50 circle_arc_excess(const Real50& speed, const Real50& a, const Real50& y) {
  const Real50 difference = speed - sin(a);
  return y * (1 - y) * (speed * speed - 2 * (1 - cos(a)) - difference * difference * y);
}

TEST(NormalCurve, CircleArcsHaveTheNormOfTheirClosedForm) {
  for (const double angle : {1.0, 30.0, 90.0, 170.0}) {
    const Real50 a = radians(angle) / 2;
    const Real50 c = cos(a);
    const Real50 tuned = sin(a) * (sqrt((6 + 2 * c) / (1 + c)) - 1);
    for (const auto& [name, speed] : {std::pair{"circle_arc", a}, std::pair{"circle_arc_tuned", tuned}})
      for (int i = 0; i <= 16; ++i) {
        const Real50 s = Real50(i) / 16;
        const Real50 norm = normal_at(curve_of(name), s, Real50(cos(2 * a))).norm();
        EXPECT_LT(abs(norm * norm - 1 - circle_arc_excess(speed, a, (2 * s - 1) * (2 * s - 1))), 100 * tiny) << name;
      }
    // The tuned one deviates as far to one side as to the other, at y = 1/2 -+ sqrt(3)/6, and nowhere farther.
    const Real50 largest = sqrt(Real50(3)) / 36 * (tuned - sin(a)) * (tuned - sin(a));
    EXPECT_LT(abs(circle_arc_excess(tuned, a, Real50(0.5) - sqrt(Real50(3)) / 6) - largest), tiny);
    EXPECT_LT(abs(circle_arc_excess(tuned, a, Real50(0.5) + sqrt(Real50(3)) / 6) + largest), tiny);
    for (int i = 0; i <= 100; ++i) EXPECT_LE(abs(circle_arc_excess(tuned, a, Real50(i) / 100)), largest + tiny);
    // Every other speed is worse at one of the two places.
    for (const double factor : {0.9, 0.99, 1.01, 1.1}) {
      const Real50 other = factor * tuned;
      EXPECT_GT(std::max<Real50>(abs(circle_arc_excess(other, a, Real50(0.5) - sqrt(Real50(3)) / 6)),
                                 abs(circle_arc_excess(other, a, Real50(0.5) + sqrt(Real50(3)) / 6))),
                largest);
    }
  }
}

TEST(NormalCurve, TheCircleArcHasTheCirclesMiddleAndSpeedThere) {
  for (const double angle : {10.0, 90.0, 150.0}) {
    const Real50 a = radians(angle) / 2;
    const Real50 cosine = cos(2 * a);
    // The derivative along x = 2s - 1 of N = sum a_k s^k, on the bisector (1, 1) / (2c) and on the chord (-1, 1) / (2
    // sin a).
    const auto bisector = Rules<Real50>{}.circle_arc(Real50(cos(a)), Real50(cos(a)), cosine);
    const auto chord = Rules<Real50>{}.circle_arc(Real50(-sin(a)), Real50(sin(a)), cosine);
    const auto slope = [](const auto& k, const Real50& s) { return (k[1] + s * (2 * k[2] + s * 3 * k[3])) / 2; };
    EXPECT_LT(abs(Rules<Real50>{}.normal_curve_value(bisector, 0.5) - 1), 10 * tiny);
    EXPECT_LT(abs(slope(bisector, 0.5)), 10 * tiny);
    EXPECT_LT(abs(slope(chord, 0.5) - a), 10 * tiny);
    // At its end: -2 (1-c) and 3 sin a - 2a, where the circle has -a sin a and a cos a: apart by a^4/12 and a^5/20.
    const Real50 end_bisector = slope(bisector, 1);
    const Real50 end_chord = slope(chord, 1);
    EXPECT_LT(abs(end_bisector + 2 * (1 - cos(a))), 10 * tiny);
    EXPECT_LT(abs(end_chord - (3 * sin(a) - 2 * a)), 10 * tiny);
    EXPECT_LT(abs(end_bisector + a * sin(a)), a * a * a * a / 12);
    EXPECT_LT(abs(end_chord - a * cos(a)), a * a * a * a * a / 60);
  }
}

/// The largest |N - target| on a grid fine enough to see it to a thousandth.
double distance(const NormalCurve& curve, const NormalCurve& target, double cosine) {
  double largest = 0;
  for (int i = 0; i <= 2000; ++i)
    largest = std::max(largest, between(normal_at(curve, i / 2000.0, cosine), normal_at(target, i / 2000.0, cosine)));
  return largest;
}

/// No cubic that meets both normals has a smaller distance than this from a target whose component along the bisector
/// is g: with r_0 = c + U - g(0) and r_1 = c + U (1-y) - g(y), (1-y) r_0 - r_1 does not depend on U, so the larger one
/// of |r_0| and |r_1| is at least its magnitude over (1-y) + 1 (de la Vallee Poussin); the best y of a grid.
double least_distance(const NormalCurve& target, double cosine) {
  const double c = std::sqrt((1 + cosine) / 2);
  const double middle = normal_at(target, 0.5, cosine).bisector;
  double largest = 0;
  for (int i = 1; i < 1000; ++i) {
    const double x = i / 1000.0;
    const double y = x * x;
    const double g = normal_at(target, (1 + x) / 2, cosine).bisector;
    largest = std::max(largest, std::abs((1 - y) * (c - middle) - (c - g)) / (2 - y));
  }
  return largest;
}

TEST(NormalCurve, MinimaxArcsAreWithinTwoPercentOfTheLeastDistance) {
  for (int angle = 5; angle <= 170; angle += 5) {
    const double cosine = to_double(Real50(cos(radians(angle))));
    if (angle <= 130) {
      const double least = least_distance(curve_of("normalized_linear"), cosine);
      const double found = distance(curve_of("minimax_arc"), curve_of("normalized_linear"), cosine);
      EXPECT_LE(found, 1.02 * least) << angle;
      EXPECT_GE(found, 0.999 * least) << angle;  // a lower bound is one
      EXPECT_LT(found, 0.75 * distance(curve_of("quadratic_arc"), curve_of("normalized_linear"), cosine));
    }
    const double least = least_distance(curve_of("slerp"), cosine);
    const double found = distance(curve_of("minimax_circle_arc"), curve_of("slerp"), cosine);
    EXPECT_LE(found, 1.02 * least) << angle;
    EXPECT_GE(found, 0.999 * least) << angle;
    EXPECT_LT(found, distance(curve_of("circle_arc"), curve_of("slerp"), cosine));
  }
}

TEST(NormalCurve, NamesAreFound) {
  EXPECT_EQ(find_named(catalogue::normal_curves(), "arc"), nullptr);
  EXPECT_EQ(curve_of("slerp").coefficients, nullptr);
}

}  // namespace
}  // namespace raytruth
