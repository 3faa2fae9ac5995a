#include "experiments/measure.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/rules/rules.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_parts = 4096;
constexpr double smallest_opacity = 1e-30;
constexpr double largest_opacity_asked = 1 - 0x1p-24;  // the largest number of binary32 below 1

struct Options {
  std::vector<double> opacities;  ///< rounded to binary32, so that all arithmetics begin with the same number
  std::vector<std::int64_t> parts;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "opacities", "parts"});
  Options options;
  for (const JsonReader& opacity : json.at("opacities").items())
    options.opacities.push_back(to_double(Binary32(opacity.number(smallest_opacity, largest_opacity_asked))));
  for (const JsonReader& parts : json.at("parts").items()) {
    options.parts.push_back(parts.integer(2, most_parts));
    if ((options.parts.back() & (options.parts.back() - 1)) != 0) parts.refuse_value("a power of two");
  }
  return options;
}

/// Lee 2010, eq. 11, from the whole down to one of the parts.
template <class Real>
Real by_recursion(Real opacity, std::int64_t parts) {
  for (; parts > 1; parts /= 2) opacity = Rules<Real>{}.opacity_correction_half(opacity);
  return opacity;
}

/// Lee 2010, eq. 9 as printed, 1 - (1 - alpha)^(1/n).
template <class Real>
Real by_power(Real opacity, std::int64_t parts) {
  using std::pow;
  return Real(1) - pow(Real(1) - opacity, Real(1 / static_cast<double>(parts)));
}

/// This form has no difference of nearly equal numbers; a whole is 1/n times as many parts.
template <class Real>
Real by_closed_form(Real opacity, double parts) {
  return Rules<Real>{}.opacity_correction(opacity, Real(1 / parts));
}

Real50 widened(const Real50& x) { return x; }
Real50 widened(double x) { return x; }
Real50 widened(Binary32 x) { return to_double(x); }

template <class Real>
constexpr int binary_digits = std::numeric_limits<Real>::digits;
template <>
constexpr int binary_digits<Binary32> = std::numeric_limits<float>::digits;

/// The opacity of one of n equal parts of a whole, by one method in one arithmetic.
struct Record {
  std::string_view arithmetic;
  int digits = 0;  ///< of the arithmetic, binary
  std::string_view method;
  std::int64_t parts = 0;
  double whole_opacity = 0;
  Real50 found;
  Real50 exact;
};

double opacity_error(const Record& record) { return static_cast<double>(record.found - record.exact); }

double relative_error(const Record& record) {
  return static_cast<double>((record.found - record.exact) / record.exact);
}

/// The magnitude of the error in units of the last place of the exact opacity, in the record's arithmetic.
double last_places(const Record& record) {
  const int exponent = std::ilogb(static_cast<double>(record.exact)) + 1 - record.digits;
  return static_cast<double>(ldexp(abs(record.found - record.exact), -exponent));
}

/// What the parts compose to, minus the whole.
double composed_error(const Record& record) {
  return static_cast<double>(by_closed_form(record.found, 1 / static_cast<double>(record.parts)) -
                             record.whole_opacity);
}

/// One for each method and number of parts.
template <class Real>
void add_records(const Options& options, std::string_view arithmetic, std::vector<Record>& records) {
  for (const double opacity : options.opacities)
    for (const std::int64_t parts : options.parts) {
      const auto count = static_cast<double>(parts);
      const auto exact = by_closed_form<Real50>(opacity, count);
      const std::array methods{std::pair{"recursion", by_recursion<Real>(opacity, parts)},
                               std::pair{"power", by_power<Real>(opacity, parts)},
                               std::pair{"closed_form", by_closed_form<Real>(opacity, count)}};
      for (const auto& [method, result] : methods)
        records.push_back({.arithmetic = arithmetic,
                           .digits = binary_digits<Real>,
                           .method = method,
                           .parts = parts,
                           .whole_opacity = opacity,
                           .found = widened(result),
                           .exact = exact});
    }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "arithmetic",
       .description = "binary64, binary32, or 50 decimal digits",
       .is_key = true,
       .cell = &Record::arithmetic},
      {.name = "method",
       .description = "recursion: Lee's eq. 11; power: eq. 9 as printed; closed_form: -expm1(log1p(-alpha)/n)",
       .is_key = true,
       .cell = &Record::method},
      {.name = "parts", .description = "n, equal parts of the whole", .is_key = true, .cell = &Record::parts},
      {.name = "whole_opacity",
       .description = "alpha, rounded to binary32",
       .is_key = true,
       .cell = &Record::whole_opacity},
      {.name = "transparency",
       .description = "1 - alpha",
       .cell = [](const Record& record) { return 1 - record.whole_opacity; }},
      {.name = "opacity",
       .description = "of one part",
       .cell = [](const Record& record) { return static_cast<double>(record.found); }},
      {.name = "opacity_error",
       .description = "of one part, against 1 - (1 - alpha)^(1/n) in 50 digits",
       .cell = opacity_error},
      {.name = "relative_error", .description = "opacity_error over the exact opacity", .cell = relative_error},
      {.name = "relative_magnitude",
       .description = "magnitude of relative_error",
       .cell = [](const Record& record) { return std::abs(relative_error(record)); }},
      {.name = "last_places",
       .description = "magnitude of opacity_error in units of the last place of the exact opacity in this arithmetic",
       .cell = last_places},
      {.name = "composed_error",
       .description = "what the n parts compose to, exactly, minus alpha",
       .cell = composed_error},
  };
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  add_records<Real50>(options, "decimal50", records);
  add_records<double>(options, "binary64", records);
  add_records<Binary32>(options, "binary32", records);
  return records;
}

}  // namespace

extern const Measure opacity_recursion_measure;
const Measure opacity_recursion_measure{MeasureDefinition<Options, Record>{
    .name = "opacity_recursion",
    .summary = "the opacity of a part of a stretch by Lee's recursion against the closed form",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
