#include "experiments/measure.hpp"
#include "raytruth/core/real.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/rules/rules.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace raytruth {

namespace {

constexpr std::int64_t most_parts = 4096;
constexpr double smallest_opacity = 1e-30;
constexpr double largest_opacity_asked = 1 - 0x1p-24;  // the largest number of binary32 below 1

struct Options {
  std::vector<double> opacities;  ///< rounded to binary32, so that all arithmetics begin with the same number
  std::vector<std::int64_t> parts;
};

Options read_options(const JsonReader& json) {
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

/// The same without the difference of nearly equal numbers; a whole is 1/n times as many parts.
template <class Real>
Real by_closed_form(Real opacity, double parts) {
  return Rules<Real>{}.opacity_correction(opacity, Real(1 / parts));
}

Real50 widened(const Real50& x) { return x; }
Real50 widened(double x) { return x; }
Real50 widened(Binary32 x) { return to_double(x); }

/// One row for each method and number of parts, in an arithmetic of that many binary digits.
template <class Real>
void add_rows(const Options& options, const std::string& arithmetic, int digits, std::vector<Row>& rows) {
  for (const double opacity : options.opacities)
    for (const std::int64_t parts : options.parts) {
      const auto count = static_cast<double>(parts);
      const auto exact = by_closed_form<Real50>(opacity, count);
      const std::array methods{std::pair{"recursion", by_recursion<Real>(opacity, parts)},
                               std::pair{"power", by_power<Real>(opacity, parts)},
                               std::pair{"closed_form", by_closed_form<Real>(opacity, count)}};
      for (const auto& [method, result] : methods) {
        const Real50 found = widened(result);
        const auto relative = static_cast<double>((found - exact) / exact);
        const int exponent = std::ilogb(static_cast<double>(exact)) + 1 - digits;
        rows.push_back({{"arithmetic", arithmetic},
                        {"method", method},
                        {"parts", parts},
                        {"whole_opacity", opacity},
                        {"transparency", 1 - opacity},
                        {"opacity", static_cast<double>(found)},
                        {"opacity_error", static_cast<double>(found - exact)},
                        {"relative_error", relative},
                        {"relative_magnitude", std::abs(relative)},
                        {"last_places", static_cast<double>(ldexp(abs(found - exact), -exponent))},
                        {"composed_error", static_cast<double>(by_closed_form(found, 1 / count) - opacity)}});
      }
    }
}

}  // namespace

std::vector<Column> opacity_recursion_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "arithmetic", .unit = "", .description = "binary64, binary32, or 50 decimal digits", .is_key = true},
      {.name = "method",
       .unit = "",
       .description = "recursion: Lee's eq. 11; power: eq. 9 as printed; closed_form: -expm1(log1p(-alpha)/n)",
       .is_key = true},
      {.name = "parts", .unit = "", .description = "n, equal parts of the whole", .is_key = true},
      {.name = "whole_opacity", .unit = "", .description = "alpha, rounded to binary32", .is_key = true},
      {.name = "transparency", .unit = "", .description = "1 - alpha"},
      {.name = "opacity", .unit = "", .description = "of one part"},
      {.name = "opacity_error", .unit = "", .description = "of one part, against 1 - (1 - alpha)^(1/n) in 50 digits"},
      {.name = "relative_error", .unit = "", .description = "opacity_error over the exact opacity"},
      {.name = "relative_magnitude", .unit = "", .description = "magnitude of relative_error"},
      {.name = "last_places",
       .unit = "",
       .description = "magnitude of opacity_error in units of the last place of the exact opacity in this arithmetic"},
      {.name = "composed_error", .unit = "", .description = "what the n parts compose to, exactly, minus alpha"},
  };
}

std::vector<Row> opacity_recursion_rows(const Experiment& /*experiment*/, const JsonReader& options,
                                        const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  add_rows<Real50>(asked, "decimal50", std::numeric_limits<Real50>::digits, rows);
  add_rows<double>(asked, "binary64", std::numeric_limits<double>::digits, rows);
  add_rows<Binary32>(asked, "binary32", std::numeric_limits<float>::digits, rows);
  return rows;
}

}  // namespace raytruth
