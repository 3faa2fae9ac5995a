#pragma once

#include "experiments/columns.hpp"
#include "experiments/row.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// The quantiles that rows show of every distribution, in percent.
inline constexpr std::array shown_percents{5, 25, 50, 75, 95};

/// These quantiles of a distribution; null where there were no values.
struct ShownQuantiles {
  std::optional<std::array<double, shown_percents.size()>> values;
};

/// Quantiles of ascending values, times `scale`.
ShownQuantiles shown_quantiles(const std::vector<double>& sorted, double scale = 1);

/// NAME_p05 ... NAME_p95. `radius` names the column that bounds their rounding error; empty: none.
Columns<ShownQuantiles> shown_quantile_columns(const std::string& name, const std::string& unit,
                                               const std::string& description, const std::string& radius = {});

}  // namespace raytruth
