#include "raytruth/gl/twin_errors.hpp"

#include "raytruth/core/real50.hpp"
#include "raytruth/gl/rule_shader.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace raytruth {

namespace {

/// The unit in the last place of a number of this magnitude, at least that of `least`.
template <class Float>
double last_place(double magnitude, double least) {
  return std::ldexp(1.0, std::ilogb(std::max(magnitude, least)) + 1 - std::numeric_limits<Float>::digits);
}

constexpr double least_normal = std::numeric_limits<float>::min();

/// A value in every arithmetic; the differences from 50 digits are taken in them.
struct Value {
  double gl = 0;
  double binary32 = 0;
  double binary64 = 0;
  double binary64_error = 0;
  double shader_error = 0;
  double magnitude = 0;
};

class Accumulator {
 public:
  void add(double error, double unit) {
    error = std::abs(error);
    const double ulps = error / unit;
    sum_.max_ulps = std::max(sum_.max_ulps, ulps);
    sum_.max_absolute = std::max(sum_.max_absolute, error);
    sum_.rms_ulps += ulps * ulps;
    sum_.rms_absolute += error * error;
    ++count_;
  }

  [[nodiscard]] ArithmeticError result() const {
    ArithmeticError result = sum_;
    const double count = std::max<double>(1, static_cast<double>(count_));
    result.rms_ulps = std::sqrt(sum_.rms_ulps / count);
    result.rms_absolute = std::sqrt(sum_.rms_absolute / count);
    return result;
  }

 private:
  ArithmeticError sum_;
  std::size_t count_ = 0;
};

}  // namespace

TwinErrors measure_twin(GlDevice& device, const Twin& twin, TwinInputs inputs, std::uint64_t seed, std::size_t count,
                        const std::string& prelude) {
  const std::size_t width = twin.number_count();
  std::vector<float> numbers(count * width);
  const auto row = [&](std::size_t i) { return std::span(numbers).subspan(i * width, width); };
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { draw_arguments(twin, inputs, seed, i, row(i)); });
  const std::vector<float> gl = run_twin(device, twin, numbers, prelude);

  std::vector<Value> values(gl.size());
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const auto binary32 = twin.in_binary32(row(i));
    const auto binary64 = twin.in_binary64(row(i));
    const auto exact = twin.in_50_digits(row(i));
    for (std::size_t k = 0; k < twin.result_count; ++k) {
      Value& value = values[i * twin.result_count + k];
      value = {.gl = gl[i * twin.result_count + k],
               .binary32 = to_double(binary32[k]),
               .binary64 = binary64[k],
               .binary64_error = to_double(Real50(binary64[k]) - exact[k]),
               .magnitude = std::max(std::abs(to_double(exact[k])), twin.summand(row(i), k))};
      value.shader_error = std::isfinite(value.gl) ? to_double(Real50(value.gl) - exact[k]) : 0;
    }
  });

  TwinErrors errors;
  errors.inputs = count;
  Accumulator gl_sum;
  Accumulator binary32_sum;
  Accumulator binary64_sum;
  Accumulator shader_sum;
  for (std::size_t i = 0; i < count; ++i) {
    const auto of_input = std::span(values).subspan(i * twin.result_count, twin.result_count);
    const bool is_in_range = std::all_of(of_input.begin(), of_input.end(), [](const Value& value) {
      return std::isfinite(value.binary32) && std::isfinite(value.binary64);
    });
    if (!is_in_range) ++errors.beyond_range;
    if (!is_in_range) continue;
    for (const Value& value : of_input) {
      const double magnitude = value.magnitude;
      binary64_sum.add(value.binary64_error, last_place<double>(magnitude, std::numeric_limits<double>::min()));
      binary32_sum.add(value.binary32 - value.binary64, last_place<float>(magnitude, least_normal));
      if (!std::isfinite(value.gl)) {
        ++errors.not_finite;
        continue;
      }
      const double unit = std::max(last_place<float>(magnitude, least_normal), least_normal);
      gl_sum.add(value.gl - value.binary32, unit);
      shader_sum.add(value.shader_error, unit);
    }
  }
  errors.gl = gl_sum.result();
  errors.binary32 = binary32_sum.result();
  errors.binary64 = binary64_sum.result();
  errors.shader = shader_sum.result();
  return errors;
}

std::int64_t violations(const TwinErrors& errors, const Twin::Bounds& bounds) {
  return std::int64_t{errors.not_finite > 0} + std::int64_t{errors.gl.max_ulps > bounds.gl} +
         std::int64_t{errors.binary32.max_ulps > bounds.rounding} +
         std::int64_t{errors.binary64.max_ulps > bounds.rounding};
}

}  // namespace raytruth
