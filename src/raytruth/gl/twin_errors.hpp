#pragma once

#include "raytruth/gl/device.hpp"
#include "raytruth/rules/texts.hpp"
#include "raytruth/rules/twins.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace raytruth {

/// Differences of one arithmetic from another one, over all values of all inputs: magnitudes, and root mean squares.
///
/// The unit in the last place is that of the larger of the value's magnitude and that of its summands
/// (`Twin::summand`), and at least the least denormal number; of shaders, which may take denormal numbers for 0, at
/// least the least normal one.
struct ArithmeticError {
  double max_ulps = 0;
  double rms_ulps = 0;
  double max_absolute = 0;
  double rms_absolute = 0;
};

/// How a twin's arithmetics differ, each from the next one.
struct TwinErrors {
  std::size_t inputs = 0;        ///< drawn
  std::size_t beyond_range = 0;  ///< of these, left out: their values are beyond binary32
  std::size_t not_finite = 0;    ///< values of the shader that are not finite where binary32 is; no part of `gl`
  ArithmeticError gl;            ///< GLSL - binary32
  ArithmeticError binary32;      ///< binary32 - binary64
  ArithmeticError binary64;      ///< binary64 - 50 digits, in its own last places
  ArithmeticError shader;        ///< GLSL - 50 digits: what a shader shows - truth
};

/// The twin on inputs drawn by the seed. Throws ShaderError.
TwinErrors measure_twin(GlDevice& device, const Twin& twin, TwinInputs inputs, std::uint64_t seed, std::size_t count,
                        const std::string& prelude = rule_prelude);

/// How many of the differences between neighbours have a maximum beyond the twin's bounds; values that are not finite
/// count as one more.
std::int64_t violations(const TwinErrors& errors, const Twin::Bounds& bounds);

}  // namespace raytruth
