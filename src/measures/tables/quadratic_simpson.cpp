#include "experiments/measure.hpp"
#include "raytruth/schemes/quadratic_gray_printed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr std::size_t grays = 256;

struct Options {
  std::vector<double> offsets;  ///< i - M
  double extinction = 0;        ///< of the constant transfer function of whole slabs, their length 1
  std::size_t stride = 1;       ///< of the gray values at their ends
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "offsets", "extinction", "stride"});
  Options options{.offsets = {}, .extinction = json.at("extinction").positive_number()};
  if (const auto stride = json.find("stride")) options.stride = static_cast<std::size_t>(stride->integer(1, grays));
  for (const JsonReader& item : json.at("offsets").items()) options.offsets.push_back(item.positive_number());
  return options;
}

/// A rule of three evaluations on one gray value: the integral of tau(s) / (2 sqrt(s - M)) over [i, i + 1].
struct LevelError {
  double offset = 0;
  std::string_view extinction;
  std::string_view rule;
  double relative = 0;
};

/// An extinction on [i, i + 1], x = s - i.
struct LevelExtinction {
  std::string_view name;
  double (*value)(double x);
  /// Its integral over y = sqrt(s - M) up to y, `offset` being i - M.
  double (*integral)(double y, double offset);
};

constexpr std::array level_extinctions{
    LevelExtinction{"constant", [](double /*x*/) { return 1.0; }, [](double y, double /*offset*/) { return y; }},
    LevelExtinction{"rising", [](double x) { return x; },
                    [](double y, double offset) { return y * (y * y / 3 - offset); }},
    LevelExtinction{"falling", [](double x) { return 1 - x; },
                    [](double y, double offset) { return y * (offset + 1 - y * y / 3); }}};

void add_level_errors(const LevelExtinction& extinction, double offset, std::vector<LevelError>& errors) {
  const double first = std::sqrt(offset);
  const double last = std::sqrt(offset + 1);
  const double exact = extinction.integral(last, offset) - extinction.integral(first, offset);
  const auto printed = [&](double x) { return extinction.value(x) / (2 * std::sqrt(offset + x)); };
  const auto substituted = [&](double y) { return extinction.value(y * y - offset); };
  const auto add = [&](std::string_view rule, double found) {
    errors.push_back({offset, extinction.name, rule, std::abs(found - exact) / exact});
  };
  add("Simpson in s", (printed(0) + 4 * printed(0.5) + printed(1)) / 6);
  const double middle = 0.5 * (first + last);
  add("Simpson in y", (last - first) / 6 * (substituted(first) + 4 * substituted(middle) + substituted(last)));
  const double node = 0.5 * (last - first) * std::sqrt(0.6);
  add("Gauss in y", (last - first) / 18 *
                        (5 * substituted(middle - node) + 8 * substituted(middle) + 5 * substituted(middle + node)));
}

/// Opacities of slabs of constant extinction, all S_f <= S_b, by how h runs and by what of the print is taken.
struct OmegaError {
  std::string_view method;
  std::string_view course;
  std::int64_t slabs = 0;
  double mean = 0;
  double max = 0;
};

constexpr std::array<std::string_view, 3> courses{"monotone", "from the minimum", "minimum inside"};

struct Method {
  std::string_view name;
  QuadraticGrayPrint print;
};

std::vector<Method> methods() {
  QuadraticGrayPrint inclusive;
  inclusive.inclusive_loops = true;
  QuadraticGrayPrint nested;
  nested.nested_end_if = true;
  QuadraticGrayPrint simpson = QuadraticGrayPrint::repaired();
  simpson.simpson = true;
  QuadraticGrayPrint dropped = QuadraticGrayPrint::repaired();
  dropped.minimum = AroundMinimum::dropped;
  QuadraticGrayPrint steps = QuadraticGrayPrint::repaired();
  steps.minimum = AroundMinimum::ten_steps;
  return {{"as printed", {}},
          {"as printed, loops inclusive", inclusive},
          {"as printed, end if as it stands", nested},
          {"Simpson's rule alone", simpson},
          {"ceil(M) alone", dropped},
          {"ten steps at M alone", steps},
          {"repaired", QuadraticGrayPrint::repaired()}};
}

std::vector<OmegaError> omega_errors(double extinction, std::size_t stride) {
  const PiecewiseLinear transfer({{0, {extinction, {1, 1, 1}}}});
  const double truth = -std::expm1(-extinction);
  std::vector<OmegaError> errors;
  for (const auto& [name, print] : methods()) {
    QuadraticGrayPrinted printed(transfer, 0, largest_gray, 1, Emission::associated, print);
    std::array<OmegaError, courses.size()> of_course{};
    const RadiusAxis axis = printed_radius_axis();
    for (std::size_t node = 1; node < axis.node_count(); ++node) {
      const double curvature = axis.curvature(node);
      const double radius = 1 / std::sqrt(curvature);
      for (std::size_t front = 0; front < grays; front += stride)
        for (std::size_t back = front; back < grays; back += stride) {
          const double slope = static_cast<double>(back - front) * radius - 1 / radius;
          const std::size_t course = slope > 0 ? 0 : slope == 0 ? 1 : 2;
          const double error = std::abs(-std::expm1(-radius * printed.omega(front, back, curvature)) - truth);
          OmegaError& sum = of_course[course];
          ++sum.slabs;
          sum.mean += error;
          sum.max = std::max(sum.max, error);
        }
    }
    for (std::size_t course = 0; course < courses.size(); ++course) {
      OmegaError& error = of_course[course];
      error.method = name;
      error.course = courses[course];
      error.mean /= static_cast<double>(std::max<std::int64_t>(error.slabs, 1));
      errors.push_back(error);
    }
  }
  return errors;
}

/// What the sums lose that begin at ceil(M), of slabs whose minimum is inside, the extinction constant.
struct LostShare {
  double scaled_length = 0;  ///< D'
  std::int64_t slabs = 0;    ///< differences S_b - S_f
  double mean = 0;
  double max = 0;
};

LostShare lost_share(double scaled_length) {
  LostShare lost{.scaled_length = scaled_length};
  const auto most = static_cast<std::int64_t>(std::ceil(scaled_length * scaled_length)) - 1;
  for (std::int64_t rise = -most; rise <= most; ++rise) {
    const double slope = static_cast<double>(rise) / scaled_length - scaled_length;
    const double below = 0.25 * slope * slope;  // S_f - M, S_f whole
    const double share = 2 * std::sqrt(below - std::floor(below)) / scaled_length;
    ++lost.slabs;
    lost.mean += share;
    lost.max = std::max(lost.max, share);
  }
  lost.mean /= static_cast<double>(lost.slabs);
  return lost;
}

struct Record {
  std::variant<LevelError, OmegaError, LostShare> found;
};

template <class Part>
const Part* part_of(const Record& record) {
  return std::get_if<Part>(&record.found);
}

Columns<LevelError> level_columns() {
  return {
      {.name = "offset", .description = "i - M, gray values", .is_key = true, .cell = &LevelError::offset},
      {.name = "extinction",
       .description = "tau on [i, i + 1]: 1, s - i, or i + 1 - s",
       .is_key = true,
       .cell = &LevelError::extinction},
      {.name = "rule",
       .description = "three evaluations: of tau / (2 sqrt(s - M)) in s, as printed; of tau(M + y^2) in y = sqrt(s - "
                      "M)",
       .is_key = true,
       .cell = &LevelError::rule},
      {.name = "relative_error",
       .description = "of the integral, against its closed form",
       .cell = &LevelError::relative}};
}

Columns<OmegaError> omega_columns() {
  return {{.name = "method",
           .description = "algorithm 9 as printed or in another reading, or the exact sum with one slip",
           .is_key = true,
           .cell = &OmegaError::method},
          {.name = "course",
           .description = "how h runs: monotone from S_f up, from its minimum up, or down and up again",
           .is_key = true,
           .cell = &OmegaError::course},
          {.name = "slabs", .description = "S_f <= S_b, R = 2^-3 to 2^3", .cell = &OmegaError::slabs},
          {.name = "opacity_error_l1", .description = "mean error of their opacity", .cell = &OmegaError::mean},
          {.name = "opacity_error_max", .description = "largest one", .cell = &OmegaError::max}};
}

Columns<LostShare> lost_columns() {
  return {{.name = "scaled_length", .description = "D'", .is_key = true, .cell = &LostShare::scaled_length},
          {.name = "differences", .description = "whole S_b - S_f below D'^2", .cell = &LostShare::slabs},
          {.name = "lost_share_mean", .description = "mean share of omega below ceil(M)", .cell = &LostShare::mean},
          {.name = "lost_share_max", .description = "largest one", .cell = &LostShare::max}};
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{{.name = "part",
                           .description = "level: one gray value; omega: whole slabs; minimum: what ceil(M) loses",
                           .is_key = true,
                           .cell = [](const Record& record) {
                             constexpr std::array parts{"level", "omega", "minimum"};
                             return parts[record.found.index()];
                           }}};
  append_part(columns, part_of<LevelError>, level_columns());
  append_part(columns, part_of<OmegaError>, omega_columns());
  append_part(columns, part_of<LostShare>, lost_columns());
  return columns;
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const LevelExtinction& extinction : level_extinctions)
    for (const double offset : options.offsets) {
      std::vector<LevelError> errors;
      add_level_errors(extinction, offset, errors);
      for (const LevelError& error : errors) records.push_back({error});
    }
  for (const OmegaError& error : omega_errors(options.extinction, options.stride)) records.push_back({error});
  const RadiusAxis axis = printed_radius_axis();
  for (std::size_t i = axis.count; i-- > 0;) records.push_back({lost_share(1 / axis.radius(i))});
  return records;
}

}  // namespace

extern const Measure quadratic_simpson_measure;
const Measure quadratic_simpson_measure{MeasureDefinition<Options, Record>{
    .name = "quadratic_simpson",
    .summary = "Simpson's rule on the quadratic gray-value model's singular integrand, and what its sums leave out",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
