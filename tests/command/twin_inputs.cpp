// The inputs of the rules' twins as files, for shader languages that run elsewhere, and the judgement of what came
// back.
//
//     twin_inputs write DIR   twins.json, and for each twin NAME.random and NAME.adversarial: rows of binary32 numbers
//     twin_inputs judge DIR   reads NAME.random.values and NAME.adversarial.values, a row for each row; prints what is
//                             beyond the twin's bounds, as the measure gl_functions judges it; exit code 1 if anything
//                             is

#include "raytruth/gl/twin_errors.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace raytruth {
namespace {

using std::filesystem::path;

constexpr std::uint64_t seed = 1;
constexpr std::size_t input_count = 4096;
constexpr std::array kinds{std::pair(TwinInputs::random, "random"), std::pair(TwinInputs::adversarial, "adversarial")};

void write_numbers(const path& file, const std::vector<float>& numbers) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size() * sizeof(float)));
}

std::vector<float> read_numbers(const path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::vector<float> numbers(bytes.size() / sizeof(float));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  return numbers;
}

/// Answers with what another device has computed.
class Recorded final : public GlDevice {
 public:
  explicit Recorded(std::vector<float> values) : values_(std::move(values)) {}

  [[nodiscard]] const GlIdentity& identity() const override { return identity_; }
  std::vector<float> compute(const ComputePass& pass) override {
    if (values_.size() != pass.output_size)
      throw std::runtime_error(fmt::format("found {} values, {} are expected", values_.size(), pass.output_size));
    return values_;
  }
  std::vector<float> draw(const DrawPass& /*pass*/) override { return {}; }

 private:
  GlIdentity identity_;
  std::vector<float> values_;
};

std::vector<float> without_denormals(std::span<const float> numbers) {
  std::vector<float> result(numbers.begin(), numbers.end());
  for (float& number : result)
    if (std::fpclassify(number) == FP_SUBNORMAL) number = 0;
  return result;
}

/// The twin of such arguments.
Twin of_normal_numbers(Twin twin) {
  const auto wrapped = [](auto function) {
    return [function](std::span<const float> numbers, auto... rest) {
      return function(without_denormals(numbers), rest...);
    };
  };
  twin.in_binary32 = wrapped(twin.in_binary32);
  twin.in_binary64 = wrapped(twin.in_binary64);
  twin.in_50_digits = wrapped(twin.in_50_digits);
  twin.summand = wrapped(twin.summand);
  return twin;
}

void write_inputs(const path& folder) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Twin& twin : catalogue::twins()) {
    nlohmann::ordered_json types = nlohmann::ordered_json::array();
    for (const Domain domain : twin.arguments) types.push_back(info(domain).type);
    list.push_back({{"name", twin.name}, {"arguments", types}, {"result_count", twin.result_count}});
    for (const auto& [inputs, name] : kinds) {
      const std::size_t width = twin.number_count();
      std::vector<float> numbers(input_count * width);
      for (std::size_t i = 0; i < input_count; ++i)
        draw_arguments(twin, inputs, seed, i, std::span(numbers).subspan(i * width, width));
      write_numbers(folder / fmt::format("{}.{}", twin.name, name), without_denormals(numbers));
    }
  }
  std::ofstream(folder / "twins.json") << list.dump();
}

int judge(const path& folder) {
  int beyond = 0;
  for (const Twin& twin : catalogue::twins())
    for (const auto& [inputs, name] : kinds) {
      Recorded device(read_numbers(folder / fmt::format("{}.{}.values", twin.name, name)));
      const TwinErrors errors = measure_twin(device, of_normal_numbers(twin), inputs, seed, input_count);
      const auto count = violations(errors, twin.bounds);
      if (count > 0) beyond = 1;
      std::cout << fmt::format("{}{} {}: {} units in the last place from binary32, {} are allowed; {} not finite\n",
                               count > 0 ? "beyond: " : "", twin.name, name, errors.gl.max_ulps, twin.bounds.gl,
                               errors.not_finite);
    }
  return beyond;
}

}  // namespace
}  // namespace raytruth

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  if (std::string_view(argv[1]) == "judge") return raytruth::judge(argv[2]);
  raytruth::write_inputs(argv[2]);
  return 0;
}
