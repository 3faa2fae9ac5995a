#include "measures/error_summary.hpp"

#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

double mean_of(const RayErrors& errors, double (*value)(const Difference&)) {
  double sum = 0;
  for (const Difference& error : errors.rays) sum += value(error);
  return errors.rays.empty() ? 0 : sum / static_cast<double>(errors.rays.size());
}

QuantityErrors summary_of_quantity(const RayErrors& errors, double bias, double rms,
                                   double (*magnitude)(const Difference&), double scale) {
  std::vector<double> magnitudes;
  magnitudes.reserve(errors.rays.size());
  for (const Difference& error : errors.rays) magnitudes.push_back(magnitude(error));
  std::sort(magnitudes.begin(), magnitudes.end());
  return {.bias = bias * scale,
          .rms = rms * scale,
          .median = quantile(magnitudes, 0.5) * scale,
          .percentile_95 = quantile(magnitudes, 0.95) * scale,
          .max = quantile(magnitudes, 1) * scale};
}

}  // namespace

void RayErrors::add(const Difference& error, double error_radius) {
  rays.push_back(error);
  radius = std::max(radius, error_radius);
}

double color_magnitude(const Difference& error) { return error.color.abs().maxCoeff(); }

double rms_opacity(const RayErrors& errors) {
  return std::sqrt(mean_of(errors, [](const Difference& error) { return error.opacity * error.opacity; }));
}

double rms_color(const RayErrors& errors) {
  return std::sqrt(mean_of(errors, [](const Difference& error) { return error.color.square().mean(); }));
}

ErrorSummary summary_of(const RayErrors& errors, double scale) {
  ErrorSummary summary{.opacity = {}, .color = {}, .radius = errors.radius * scale};
  if (errors.rays.empty()) return summary;
  summary.opacity = summary_of_quantity(
      errors, mean_of(errors, [](const Difference& error) { return error.opacity; }), rms_opacity(errors),
      [](const Difference& error) { return std::abs(error.opacity); }, scale);
  summary.color =
      summary_of_quantity(errors, mean_of(errors, [](const Difference& error) { return error.color.mean(); }),
                          rms_color(errors), color_magnitude, scale);
  return summary;
}

Columns<ErrorSummary> error_summary_columns(const std::string& unit, const std::string& of_what) {
  Columns<ErrorSummary> columns;
  for (const auto& [name, errors] : {std::pair{"opacity", &ErrorSummary::opacity}, {"color", &ErrorSummary::color}}) {
    const bool is_color = errors == &ErrorSummary::color;
    const auto add = [&, name = name, errors = errors](const std::string& suffix, double QuantityErrors::*figure,
                                                       const std::string& description) {
      columns.push_back({.name = name + suffix,
                         .unit = unit,
                         .description = fmt::format("{} of {}: {}", name, of_what, description),
                         .radius = "radius",
                         .cell = [errors, figure](const ErrorSummary& summary) {
                           const auto& of_quantity = summary.*errors;
                           return of_quantity ? std::optional((*of_quantity).*figure) : std::nullopt;
                         }});
    };
    const std::string over = is_color ? "over rays and channels" : "over rays";
    const std::string magnitude = is_color ? "the largest magnitude among the channels" : "the magnitude";
    add("_bias", &QuantityErrors::bias, "mean of the signed error " + over);
    add("_rms", &QuantityErrors::rms, "root mean square of the error " + over);
    add("_p50", &QuantityErrors::median, "median over rays of " + magnitude);
    add("_p95", &QuantityErrors::percentile_95, "95th percentile over rays of " + magnitude);
    add("_max", &QuantityErrors::max, "maximum over rays of " + magnitude);
  }
  columns.push_back({.name = "radius",
                     .unit = unit,
                     .description = "bound on the error of the errors: the reference's",
                     .cell = &ErrorSummary::radius});
  return columns;
}

}  // namespace raytruth
