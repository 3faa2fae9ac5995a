#include "measures/quantile_columns.hpp"

#include "raytruth/statistics/statistics.hpp"

#include <fmt/format.h>

namespace raytruth {

std::vector<Column> quantile_columns(const std::string& name, const std::string& unit, const std::string& description,
                                     const std::string& radius) {
  std::vector<Column> columns;
  columns.reserve(shown_percents.size());
  for (const int percent : shown_percents)
    columns.push_back({.name = fmt::format("{}_p{:02}", name, percent),
                       .unit = unit,
                       .description = fmt::format("{}, {}th percentile", description, percent),
                       .is_key = false,
                       .radius = radius});
  return columns;
}

void add_quantiles(Row& row, const std::string& name, const std::vector<double>& sorted, double scale) {
  for (const int percent : shown_percents)
    row.emplace_back(fmt::format("{}_p{:02}", name, percent),
                     sorted.empty() ? Value() : Value(quantile(sorted, percent / 100.0) * scale));
}

}  // namespace raytruth
