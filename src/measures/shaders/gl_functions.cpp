#include "experiments/measure.hpp"
#include "raytruth/gl/twin_errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace raytruth {

namespace {

constexpr std::int64_t most_inputs = 10'000'000;

struct Arithmetic {
  std::string name;
  const char* description;
  ArithmeticError TwinErrors::*error;
};

const std::array arithmetics{
    Arithmetic{"gl", "GLSL - binary32", &TwinErrors::gl},
    Arithmetic{"round32", "binary32 - binary64", &TwinErrors::binary32},
    Arithmetic{"round64", "binary64 - 50 digits, in last places of binary64", &TwinErrors::binary64},
    Arithmetic{"shader", "GLSL - 50 digits", &TwinErrors::shader},
};

std::int64_t read_inputs(const JsonReader& options) {
  options.only({"kind", "inputs"});
  return options.at("inputs").integer(1, most_inputs);
}

std::string argument_names(const Twin& twin) {
  std::vector<std::string_view> names;
  for (const Domain domain : twin.arguments) names.push_back(info(domain).name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<Column> gl_functions_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_inputs(options);
  std::vector<Column> columns{
      {.name = "function", .unit = "", .description = "the local function of src/rules", .is_key = true},
      {.name = "arguments", .unit = "", .description = "their domains; src/rules/README.md tells the ranges"},
      {.name = "inputs",
       .unit = "",
       .description =
           "random: in the range of each argument; adversarial: zeros, denormals, huge and nearly equal ones",
       .is_key = true},
      {.name = "input_count", .unit = "", .description = "inputs drawn"},
      {.name = "beyond_range", .unit = "", .description = "of these, left out: their values are beyond binary32"},
      {.name = "not_finite", .unit = "", .description = "values of the shader that are not finite, but binary32 is"},
      {.name = "gl_bound", .unit = "ulp", .description = "the catalogue's bound on gl_max_ulps"},
      {.name = "rounding_bound", .unit = "ulp", .description = "its bound on round32_max_ulps and round64_max_ulps"},
      {.name = "violations",
       .unit = "",
       .description = "how many of the three, and of not_finite, are beyond their bounds"},
  };
  for (const auto& [name, description, error] : arithmetics) {
    const std::string of = std::string(" of ") + description;
    append(columns, {{.name = name + "_max_ulps", .unit = "ulp", .description = "maximum" + of},
                     {.name = name + "_rms_ulps", .unit = "ulp", .description = "root mean square" + of},
                     {.name = name + "_max", .unit = "", .description = "maximum" + of},
                     {.name = name + "_rms", .unit = "", .description = "root mean square" + of}});
  }
  return columns;
}

std::vector<Row> gl_functions_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const auto count = static_cast<std::size_t>(read_inputs(options));
  const auto device = open_gl(experiment.gl);
  std::vector<Row> rows;
  for (const auto& [inputs, name] :
       {std::pair{TwinInputs::random, "random"}, std::pair{TwinInputs::adversarial, "adversarial"}})
    for (const Twin& twin : catalogue::twins()) {
      const TwinErrors errors = measure_twin(*device, twin, inputs, experiment.seed, count);
      const Twin::Bounds& bounds = twin.bounds;
      Row& row = rows.emplace_back();
      row.insert(row.end(), {{"function", std::string(twin.name)},
                             {"arguments", argument_names(twin)},
                             {"inputs", name},
                             {"input_count", static_cast<std::int64_t>(errors.inputs)},
                             {"beyond_range", static_cast<std::int64_t>(errors.beyond_range)},
                             {"not_finite", static_cast<std::int64_t>(errors.not_finite)},
                             {"gl_bound", bounds.gl},
                             {"rounding_bound", bounds.rounding},
                             {"violations", violations(errors, bounds)}});
      for (const Arithmetic& arithmetic : arithmetics) {
        const ArithmeticError& error = errors.*arithmetic.error;
        row.insert(row.end(), {{arithmetic.name + "_max_ulps", error.max_ulps},
                               {arithmetic.name + "_rms_ulps", error.rms_ulps},
                               {arithmetic.name + "_max", error.max_absolute},
                               {arithmetic.name + "_rms", error.rms_absolute}});
      }
    }
  return rows;
}

}  // namespace raytruth
