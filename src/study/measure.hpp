#pragma once

#include "study/experiment.hpp"
#include "study/row.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace raytruth {

/// What an experiment can ask of each of its fields. Adding one: its two functions in a file of its own, and a line in
/// `measures`.
struct Measure {
  std::string_view name;
  std::string_view summary;
  /// The columns of its rows besides `measure`, `field`, `status` and `why`. Refuses options it does not know.
  std::vector<Column> (*columns)(const Experiment&, const JsonReader& options);
  /// The rows of one field, without `measure`, `field`, `status` and `why`; the same bytes on any number of threads.
  std::vector<Row> (*rows)(const Experiment&, const JsonReader& options, const Field&);
};

std::vector<Column> signal_error_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> signal_error_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> cell_cubic_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> cell_cubic_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

inline constexpr std::array measures{
    Measure{"signal_error", "xi and xi_max of every scheme along random rays: quantiles, and ratios between schemes",
            signal_error_columns, signal_error_rows},
    Measure{"cell_cubic", "whether a trilinear ray is a cubic inside each cell, and how its slope jumps between cells",
            cell_cubic_columns, cell_cubic_rows},
};

}  // namespace raytruth
