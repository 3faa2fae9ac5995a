#include "experiments/measure.hpp"
#include "raytruth/gl/twin_errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

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

struct Options {
  std::size_t inputs = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "inputs"});
  return {.inputs = static_cast<std::size_t>(json.at("inputs").integer(1, most_inputs))};
}

std::string argument_names(const Twin& twin) {
  std::vector<std::string_view> names;
  for (const Domain domain : twin.arguments) names.push_back(info(domain).name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// A local function on inputs of a kind.
struct Record {
  const Twin* twin;
  TwinInputs inputs;
  TwinErrors errors;
};

Columns<ArithmeticError> arithmetic_columns(const Arithmetic& arithmetic) {
  const std::string of = std::string(" of ") + arithmetic.description;
  return {
      {.name = arithmetic.name + "_max_ulps",
       .unit = "ulp",
       .description = "maximum" + of,
       .cell = &ArithmeticError::max_ulps},
      {.name = arithmetic.name + "_rms_ulps",
       .unit = "ulp",
       .description = "root mean square" + of,
       .cell = &ArithmeticError::rms_ulps},
      {.name = arithmetic.name + "_max", .description = "maximum" + of, .cell = &ArithmeticError::max_absolute},
      {.name = arithmetic.name + "_rms",
       .description = "root mean square" + of,
       .cell = &ArithmeticError::rms_absolute},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "function",
       .description = "the local function of src/rules",
       .is_key = true,
       .cell = [](const Record& record) { return record.twin->name; }},
      {.name = "arguments",
       .description = "their domains; src/rules/README.md tells the ranges",
       .cell = [](const Record& record) { return argument_names(*record.twin); }},
      {.name = "inputs",
       .description =
           "random: in the range of each argument; adversarial: zeros, denormals, huge and nearly equal ones",
       .is_key = true,
       .cell = [](const Record& record) { return record.inputs == TwinInputs::random ? "random" : "adversarial"; }},
      {.name = "input_count",
       .description = "inputs drawn",
       .cell = [](const Record& record) { return record.errors.inputs; }},
      {.name = "beyond_range",
       .description = "of these, left out: their values are beyond binary32",
       .cell = [](const Record& record) { return record.errors.beyond_range; }},
      {.name = "not_finite",
       .description = "values of the shader that are not finite, but binary32 is",
       .cell = [](const Record& record) { return record.errors.not_finite; }},
      {.name = "gl_bound",
       .unit = "ulp",
       .description = "the catalogue's bound on gl_max_ulps",
       .cell = [](const Record& record) { return record.twin->bounds.gl; }},
      {.name = "rounding_bound",
       .unit = "ulp",
       .description = "its bound on round32_max_ulps and round64_max_ulps",
       .cell = [](const Record& record) { return record.twin->bounds.rounding; }},
      {.name = "violations",
       .description = "how many of the three, and of not_finite, are beyond their bounds",
       .cell = [](const Record& record) { return violations(record.errors, record.twin->bounds); }},
  };
  for (const Arithmetic& arithmetic : arithmetics)
    append_part(
        columns, [error = arithmetic.error](const Record& record) { return record.errors.*error; },
        arithmetic_columns(arithmetic));
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  const auto device = open_gl(experiment.gl);
  std::vector<Record> records;
  for (const TwinInputs inputs : {TwinInputs::random, TwinInputs::adversarial})
    for (const Twin& twin : catalogue::twins())
      records.push_back({&twin, inputs, measure_twin(*device, twin, inputs, experiment.seed, options.inputs)});
  return records;
}

}  // namespace

extern const Measure gl_functions_measure;
const Measure gl_functions_measure{MeasureDefinition<Options, Record>{
    .name = "gl_functions",
    .summary = "local functions in GLSL, binary32, binary64 and 50 digits, each against the next",
    .uses_gl = true,
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
