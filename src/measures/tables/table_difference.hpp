#pragma once

#include "raytruth/tables/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace raytruth {

/// The largest differences of two tables of one size over all entries: in the light of any channel, and in the opacity.
struct TableDifference {
  double color = 0;
  double opacity = 0;
};

inline TableDifference largest_difference(const Table<double>& a, const Table<double>& b) {
  TableDifference result;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    double& largest = i % 4 == 3 ? result.opacity : result.color;
    largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  }
  return result;
}

}  // namespace raytruth
