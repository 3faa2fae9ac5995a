#include "raytruth/gl/rule_shader.hpp"
#include "raytruth/gl/twin_errors.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/study_transfers.hpp"
#include "unit/gl/on_every_gl.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

namespace raytruth {
namespace {

class GlTwinsTest : public OnEveryGl {};
INSTANTIATE_TEST_SUITE_P(Gl, GlTwinsTest, every_gl_platform, platform_name);

constexpr std::size_t input_count = 4096;
constexpr std::array every_kind_of_input{TwinInputs::random, TwinInputs::adversarial};

std::string source_text(const std::string& file) {
  std::ifstream stream(std::string(std::getenv("RAYTRUTH_SOURCE")) + "/" + file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto where = text.find(from);
  if (where == std::string::npos) throw std::logic_error("there is no " + from);
  return text.replace(where, from.size(), to);
}

const Twin& twin_of(std::string_view name) {
  for (const Twin& twin : catalogue::twins())
    if (twin.name == name) return twin;
  throw std::logic_error(std::string(name));
}

TEST(Twins, AreAllFunctionsOfTheRules) {
  std::vector<std::string> defined;
  std::istringstream text(rule_texts);
  for (std::string line; std::getline(text, line);)
    for (const std::string type : {"real ", "vec4 ", "bool "})
      if (line.starts_with(type) && line.find('(') != std::string::npos)
        defined.push_back(line.substr(type.size(), line.find('(') - type.size()));
  std::vector<std::string> listed;
  for (const Twin& twin : catalogue::twins()) listed.emplace_back(twin.name);
  EXPECT_EQ(listed, defined);
}

TEST(Twins, DependOnSeedAndIndexAlone) {
  const Twin& twin = twin_of("simpson_slab");
  std::vector<float> first(twin.number_count());
  std::vector<float> again(twin.number_count());
  std::set<float> widths;
  for (std::uint64_t i = 0; i < 100; ++i) {
    draw_arguments(twin, TwinInputs::random, 7, i, first);
    draw_arguments(twin, TwinInputs::random, 7, i, again);
    EXPECT_EQ(first, again);
    widths.insert(first[12]);
  }
  EXPECT_EQ(widths.size(), 100U);
}

TEST(Twins, AdversariesAreZeroDenormalHugeAndNearlyEqual) {
  const Twin& twin = twin_of("order1");
  bool is_zero = false;
  bool is_denormal = false;
  bool is_huge = false;
  bool is_nearly_equal = false;
  std::vector<float> numbers(2);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    draw_arguments(twin, TwinInputs::adversarial, 1, i, numbers);
    is_zero |= numbers[0] == 0;
    is_denormal |= std::fpclassify(numbers[0]) == FP_SUBNORMAL;
    is_huge |= std::abs(numbers[0]) > 1e29F;
    is_nearly_equal |= numbers[0] != numbers[1] && std::abs(numbers[0] - numbers[1]) < 1e-6F && numbers[0] > 0.1F;
  }
  EXPECT_TRUE(is_zero && is_denormal && is_huge && is_nearly_equal);
}

TEST_P(GlTwinsTest, AreWithinTheirBounds) {
  for (const Twin& twin : catalogue::twins())
    for (const TwinInputs inputs : every_kind_of_input) {
      const TwinErrors errors = measure_twin(*device, twin, inputs, 1, input_count);
      EXPECT_EQ(violations(errors, twin.bounds), 0)
          << twin.name << ": " << errors.gl.max_ulps << ' ' << errors.binary32.max_ulps << ' '
          << errors.binary64.max_ulps << ' ' << errors.not_finite;
      EXPECT_LT(errors.beyond_range, input_count / 2) << twin.name;
    }
}

/// What the check says of every twin if the prelude is another one.
std::set<std::string_view> violated(GlDevice& device, const std::string& prelude) {
  std::set<std::string_view> names;
  for (const Twin& twin : catalogue::twins())
    if (violations(measure_twin(device, twin, TwinInputs::random, 1, input_count, prelude), twin.bounds) > 0)
      names.insert(twin.name);
  return names;
}

TEST_P(GlTwinsTest, ACubicForTheExponentialIsFound) {
  const std::string cubic =
      replaced(rule_prelude, "p = r + r * r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * p)));",
               "p = r + r * r * (0.5 + r * (1.0 / 6.0));");
  EXPECT_EQ(
      violated(*device, cubic),
      (std::set<std::string_view>{"absorption", "absorption_mean_transmittance", "homogeneous_slab", "trapezoid_slab",
                                  "simpson_slab", "opacity_correction", "highlight_lobe", "quadratic_gray_node"}));
}

TEST_P(GlTwinsTest, TheLanguagesOwnExponentialIsFound) {
  const std::string naive =
      replaced(rule_prelude, "float expm1(float x) {", "float expm1(float x) {\n  return exp(x) - 1.0;");
  EXPECT_TRUE(violated(*device, naive).contains("absorption"));
}

TEST_P(GlTwinsTest, ALogarithmOfARoundedSumIsFound) {
  const std::string naive =
      replaced(rule_prelude, "float f = k == 0 ? x : uintBitsToFloat(", "float f = uintBitsToFloat(");
  EXPECT_EQ(violated(*device, naive), std::set<std::string_view>{"opacity_correction"});
}

// 768 intervals of 8 slabs, with a transfer function of many points: more than llvmpipe's loops may go round if a
// search of the points took part.
TEST_P(GlTwinsTest, MarchesLongRaysToTheirEnds) {
  const PiecewiseLinear transfer = gaussian_transfer(3);
  const Sampled method{.rule = SampledRule::virtual_catmull_rom, .virtual_samples = 7};
  Samples<double> samples;
  const Chain<3> signal{{{.start = 0.0, .length = 12, .polynomial = {{0.0, 0.9, 0.2, 1.0}}}}, 12.0};
  sample_constant(signal, 1.0 / 64, samples);
  const SampledRay<Binary32> ray(signal, samples);
  const auto expected = march(method, OpticsLookup<Binary32>(transfer, Emission::associated), ray);
  const auto shown = run_march(*device, method, transfer, Emission::associated, std::span(&ray, 1)).front();
  EXPECT_GT(shown[3], 0.9F);
  EXPECT_NEAR(shown[3], to_double(expected.opacity), 1e-6);
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(shown[static_cast<std::size_t>(channel)], to_double(expected.color[channel]), 1e-6);
}

TEST_P(GlTwinsTest, RefusesRaysThatLlvmpipeWouldCutOff) {
  Samples<double> samples;
  const Chain<3> signal{{{.start = 0.0, .length = 1, .polynomial = {{0.0, 0.0, 1.0, 1.0}}}}, 1.0};
  sample_constant(signal, 1.0 / 65536, samples);
  const SampledRay<Binary32> ray(signal, samples);
  EXPECT_THROW(run_march(*device, {}, gaussian_transfer(3), Emission::associated, std::span(&ray, 1)), MissingError);
}

TEST_P(GlTwinsTest, ExampleShaderDrawsAHomogeneousMedium) {
  constexpr float extinction = 3;
  constexpr std::array color{0.25F, 0.5F, 1.0F};
  const std::vector<float> volume(8, 0.5F);
  std::vector<float> transfer;
  for (int i = 0; i < 2; ++i) transfer.insert(transfer.end(), {color[0], color[1], color[2], extinction});
  const auto pixels = device->draw(
      {.shader = rule_shader(source_text("src/raytruth/rules/example.frag")),
       .reads = {.uniforms = {{"image_size", std::array{4.0F, 4.0F}}, {"steps", 7}},
                 .textures = {{"volume", {.size = {2, 2, 2}, .format = TexelFormat::r32f, .texels = volume}},
                              {"transfer", {.size = {2}, .format = TexelFormat::rgba32f, .texels = transfer}}}},
       .width = 4,
       .height = 4});
  const double opacity = -std::expm1(-extinction);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    EXPECT_NEAR(pixels[i], i % 4 < 3 ? static_cast<double>(color[i % 4]) * opacity : opacity, 1e-6) << i;
}

TEST(RulesReadme, TellsEveryDomainOfArguments) {
  const std::string readme = source_text("src/raytruth/rules/README.md");
  for (const DomainInfo& domain : domains())
    EXPECT_NE(readme.find(fmt::format("| {} | {} | {} | {} |", domain.name, domain.type,
                                      domain.unit.empty() ? "-" : domain.unit, domain.range)),
              std::string::npos)
        << domain.name;
}

}  // namespace
}  // namespace raytruth
