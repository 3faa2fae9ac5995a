#include "measures/quantile_columns.hpp"

#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>

namespace raytruth {

ShownQuantiles shown_quantiles(const std::vector<double>& sorted, double scale) {
  if (sorted.empty()) return {};
  ShownQuantiles quantiles;
  auto& values = quantiles.values.emplace();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = quantile(sorted, shown_percents[i] / 100.0) * scale;
  return quantiles;
}

Columns<ShownQuantiles> shown_quantile_columns(const std::string& name, const std::string& unit,
                                               const std::string& description, const std::string& radius) {
  Columns<ShownQuantiles> columns;
  for (std::size_t i = 0; i < shown_percents.size(); ++i)
    columns.push_back({.name = fmt::format("{}_p{:02}", name, shown_percents[i]),
                       .unit = unit,
                       .description = fmt::format("{}, {}th percentile", description, shown_percents[i]),
                       .radius = radius,
                       .cell = [i](const ShownQuantiles& quantiles) {
                         return quantiles.values ? std::optional((*quantiles.values)[i]) : std::nullopt;
                       }});
  return columns;
}

}  // namespace raytruth
