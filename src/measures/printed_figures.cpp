#include "experiments/measure.hpp"
#include "raytruth/statistics/linear_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

using Numbers = std::vector<double>;

/// Numbers that a publication prints side by side, and what follows from them.
struct Printed {
  std::string name;
  std::string_view operation;
  Numbers x;
  Numbers y;
  double limit = 0;
};

struct Options {
  std::vector<Printed> figures;
};

std::optional<double> largest_ratio(const Printed& printed) {
  double largest = 0;
  for (std::size_t i = 0; i < printed.x.size(); ++i) largest = std::max(largest, printed.x[i] / printed.y[i]);
  return largest;
}

std::optional<double> fitted_exponent(const Printed& printed) {
  std::vector<Observation> points;
  for (std::size_t i = 0; i < printed.x.size(); ++i)
    points.push_back({.features = {std::log(printed.x[i])}, .value = std::log(printed.y[i])});
  return fit_linear(points).coefficients[1];
}

std::optional<double> peak_to_noise(const Printed& printed) {
  constexpr double decibels = 20;
  return decibels * std::log10(printed.x.front() / printed.y.front());
}

std::optional<double> first_below(const Printed& printed) {
  for (std::size_t i = 0; i < printed.x.size(); ++i)
    if (printed.y[i] < printed.limit) return printed.x[i];
  return std::nullopt;
}

std::optional<double> largest_rise(const Printed& printed) {
  double largest = 0;
  for (std::size_t i = 1; i < printed.y.size(); ++i) largest = std::max(largest, printed.y[i] / printed.y[i - 1]);
  return largest;
}

std::optional<double> loss(const Printed& printed) { return 1 - printed.y.front() / printed.x.front(); }

std::optional<double> difference(const Printed& printed) { return printed.x.front() - printed.y.front(); }

struct Operation {
  std::string_view name;
  std::optional<double> (*apply)(const Printed&);
};

constexpr std::array operations{
    Operation{"largest_ratio", largest_ratio},
    Operation{"fitted_exponent", fitted_exponent},
    Operation{"psnr", peak_to_noise},
    Operation{"first_below", first_below},
    Operation{"difference", difference},
    Operation{"largest_rise", largest_rise},
    Operation{"loss", loss},
};

Numbers read_numbers(const JsonReader& json) {
  Numbers numbers;
  for (const JsonReader& item : json.items()) numbers.push_back(item.positive_number());
  return numbers;
}

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "figures"});
  std::vector<std::string_view> names;
  for (const Operation& operation : operations) names.push_back(operation.name);
  Options options;
  for (const JsonReader& figure : json.at("figures").items()) {
    figure.only({"name", "operation", "x", "y", "limit"});
    const std::string word = figure.at("operation").word(names);
    Printed printed{.name = figure.at("name").text(),
                    .operation = *std::find(names.begin(), names.end(), word),
                    .x = read_numbers(figure.at("x")),
                    .y = read_numbers(figure.at("y"))};
    if (printed.x.size() != printed.y.size()) figure.refuse("lists x and y of different lengths", "as many of both");
    if (word == "fitted_exponent" && printed.x.size() < 2) figure.refuse("one point", "two or more to fit");
    if (word == "first_below") printed.limit = figure.at("limit").positive_number();
    options.figures.push_back(std::move(printed));
  }
  return options;
}

struct Record {
  const Printed* printed;
  std::optional<double> value;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "figures",
       .description = "which of the numbers that are printed side by side",
       .is_key = true,
       .cell = [](const Record& record) { return record.printed->name; }},
      {.name = "operation",
       .description =
           "largest_ratio: of x to y; fitted_exponent: of y as a power of x, by least squares; psnr: x over y in "
           "dB; first_below: the first x whose y is below the limit; largest_rise: of a y to the one before; "
           "loss: 1 - y / x; difference: x - y",
       .cell = [](const Record& record) { return record.printed->operation; }},
      {.name = "value", .description = "what follows from the numbers", .cell = &Record::value},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const Printed& printed : options.figures) {
    const auto* const operation = std::find_if(operations.begin(), operations.end(), [&printed](const Operation& one) {
      return one.name == printed.operation;
    });
    records.push_back({&printed, operation->apply(printed)});
  }
  return records;
}

}  // namespace

extern const Measure printed_figures_measure;
const Measure printed_figures_measure{MeasureDefinition<Options, Record>{
    .name = "printed_figures",
    .summary = "what follows from a publication's own numbers: nothing is computed but that",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
