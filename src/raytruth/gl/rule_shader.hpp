#pragma once

#include "raytruth/gl/device.hpp"
#include "raytruth/gl/texts.hpp"
#include "raytruth/rules/texts.hpp"
#include "raytruth/rules/twins.hpp"
#include "raytruth/schemes/sampled_march.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <span>
#include <string>
#include <vector>

namespace raytruth {

/// A shader that can call the rules: version, prelude, the rules' text, and `body`.
std::string rule_shader(const std::string& body, const std::string& prelude = rule_prelude);

/// Values of the twin in GLSL, `twin.result_count` for each row of `twin.number_count()` numbers.
std::vector<float> run_twin(GlDevice& device, const Twin& twin, std::span<const float> numbers,
                            const std::string& prelude = rule_prelude);

/// Rays by a sampled scheme in GLSL (sampled_march.glsl): colour and opacity of each.
std::vector<TwinValues<float>> run_march(GlDevice& device, const Sampled& method, const PiecewiseLinear& transfer,
                                         Emission emission, std::span<const SampledRay<Binary32>> rays,
                                         const std::string& prelude = rule_prelude);

}  // namespace raytruth
