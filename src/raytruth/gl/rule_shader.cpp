#include "raytruth/gl/rule_shader.hpp"

#include "raytruth/core/error.hpp"

#include <fmt/format.h>

namespace raytruth {

namespace {

// llvmpipe silently leaves all loops of a shader once they have gone round so often.
constexpr std::size_t most_iterations = 65535;

/// The numbers from `next` on as an argument.
std::string argument_text(Domain domain, std::size_t next) {
  const auto number = [](std::size_t i) { return fmt::format("numbers[first + {}u]", i); };
  const std::string_view type = info(domain).type;
  if (type == "vec4")
    return fmt::format("vec4({}, {}, {}, {})", number(next), number(next + 1), number(next + 2), number(next + 3));
  return type == "bool" ? fmt::format("{} != 0.0", number(next)) : number(next);
}

std::string twin_body(const Twin& twin) {
  std::string arguments;
  std::size_t next = 0;
  for (const Domain domain : twin.arguments) {
    arguments += (next == 0 ? "" : ", ") + argument_text(domain, next);
    next += number_count(domain);
  }
  return fmt::format(
      R"(
layout(local_size_x = 64) in;
uniform uint invocations;
layout(std430, binding = 0) readonly buffer Numbers {{ float numbers[]; }};
layout(std430, binding = 1) writeonly buffer Values {{ float values[]; }};

void main() {{
  uint invocation = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  if (invocation >= invocations) return;
  uint first = {0}u * invocation;
  vec4 value = vec4({1}({2}));
  for (uint i = 0u; i < {3}u; ++i) values[{3}u * invocation + i] = value[i];
}}
)",
      next, twin.name, arguments, twin.result_count);
}

float to_float(Binary32 value) { return static_cast<float>(to_double(value)); }

}  // namespace

std::string rule_shader(const std::string& body, const std::string& prelude) {
  return "#version 430 core\n" + prelude + rule_texts + body;
}

std::vector<float> run_twin(GlDevice& device, const Twin& twin, std::span<const float> numbers,
                            const std::string& prelude) {
  const std::size_t count = numbers.size() / twin.number_count();
  return device.compute({.shader = rule_shader(twin_body(twin), prelude),
                         .inputs = {numbers},
                         .invocations = count,
                         .output_size = count * twin.result_count});
}

std::vector<TwinValues<float>> run_march(GlDevice& device, const Sampled& method, const PiecewiseLinear& transfer,
                                         Emission emission, std::span<const SampledRay<Binary32>> rays,
                                         const std::string& prelude) {
  std::vector<float> points;
  const PiecewiseLinear linear = linear_in_extinction(transfer);
  for (const auto& [s, optics] : linear.points())
    for (const double number : {s, optics.color[0], optics.color[1], optics.color[2], optics.extinction})
      points.push_back(static_cast<float>(number));

  for (const SampledRay<Binary32>& ray : rays) {
    const std::size_t slabs = ray.widths.size() * static_cast<std::size_t>(method.virtual_samples + 2);
    if (slabs > most_iterations)
      throw MissingError(fmt::format("a ray of {} slabs is beyond shaders of llvmpipe, which go round {} times at most",
                                     slabs, most_iterations));
  }

  std::vector<float> headers;
  std::vector<float> values;
  std::vector<float> middles;
  std::vector<float> widths;
  for (const SampledRay<Binary32>& ray : rays) {
    for (const std::size_t number : {values.size(), ray.widths.size(), ray.full})
      headers.push_back(static_cast<float>(number));
    for (const Binary32 value : ray.values) values.push_back(to_float(value));
    for (const Binary32 middle : ray.middles) middles.push_back(to_float(middle));
    for (const Binary32 width : ray.widths) widths.push_back(to_float(width));
    middles.resize(values.size());  // one interval less than samples
    widths.resize(values.size());
  }

  const std::vector<float> slabs = device.compute(
      {.shader = rule_shader(sampled_march, prelude),
       .reads = {.uniforms = {{"rule", static_cast<int>(method.rule)},
                              {"is_linear", method.absorption == Absorption::linear ? 1 : 0},
                              {"virtual_samples", method.virtual_samples},
                              {"is_recursion", method.correction == OpacityCorrection::recursion ? 1 : 0},
                              {"is_plain", emission == Emission::plain ? 1 : 0},
                              {"point_count", static_cast<int>(linear.points().size())}}},
       .inputs = {points, headers, values, middles, widths},
       .invocations = rays.size(),
       .output_size = 4 * rays.size()});
  std::vector<TwinValues<float>> results(rays.size());
  for (std::size_t i = 0; i < slabs.size(); ++i) results[i / 4][i % 4] = slabs[i];
  return results;
}

}  // namespace raytruth
