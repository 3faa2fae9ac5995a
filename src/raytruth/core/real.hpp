#pragma once

#include <cmath>
#include <limits>

namespace raytruth {

/// IEEE binary32 that never promotes. In C++ `0.5 * x` with a float x is a double product; in GLSL it is a float
/// product. Every operation on this type rounds to binary32, literals included, as a shader does.
class Binary32 {
 public:
  constexpr Binary32() = default;
  // Implicit, so that the literals of a formula written for GLSL convert as they do there.
  constexpr Binary32(double value) : value_(static_cast<float>(value)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] explicit constexpr operator double() const { return static_cast<double>(value_); }

  friend constexpr Binary32 operator+(Binary32 a, Binary32 b) { return round(a.value_ + b.value_); }
  friend constexpr Binary32 operator-(Binary32 a, Binary32 b) { return round(a.value_ - b.value_); }
  friend constexpr Binary32 operator*(Binary32 a, Binary32 b) { return round(a.value_ * b.value_); }
  friend constexpr Binary32 operator/(Binary32 a, Binary32 b) { return round(a.value_ / b.value_); }
  friend constexpr Binary32 operator-(Binary32 a) { return round(-a.value_); }
  friend constexpr auto operator<=>(Binary32 a, Binary32 b) = default;

  friend Binary32 floor(Binary32 x) { return round(std::floor(x.value_)); }
  friend Binary32 sqrt(Binary32 x) { return round(std::sqrt(x.value_)); }
  friend Binary32 expm1(Binary32 x) { return round(std::expm1(x.value_)); }
  friend Binary32 log1p(Binary32 x) { return round(std::log1p(x.value_)); }
  friend Binary32 pow(Binary32 x, Binary32 y) { return round(std::pow(x.value_, y.value_)); }
  friend Binary32 acos(Binary32 x) { return round(std::acos(x.value_)); }
  friend Binary32 sin(Binary32 x) { return round(std::sin(x.value_)); }

 private:
  static constexpr Binary32 round(float value) {
    Binary32 result;
    result.value_ = value;
    return result;
  }

  float value_ = 0;
};

/// The binary64 number nearest to `value`, of any of the arithmetics.
template <class Real>
double to_double(const Real& value) {
  return static_cast<double>(value);
}

}  // namespace raytruth
