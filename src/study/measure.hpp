#pragma once

#include "study/experiment.hpp"
#include "study/row.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace raytruth {

/// What an experiment can ask. Adding one: its two functions in a file of its own, and a line in
/// `measures`.
struct Measure {
  std::string_view name;
  std::string_view summary;
  /// Whether it is asked of every field of the experiment, along its rays; else once, with an empty field.
  bool of_fields;
  /// The columns of its rows besides `measure`, `field`, `status` and `why`. Refuses options it does not know.
  std::vector<Column> (*columns)(const Experiment&, const JsonReader& options);
  /// The rows of a field, without `measure`, `field`, `status` and `why`; the same bytes on any number of threads.
  std::vector<Row> (*rows)(const Experiment&, const JsonReader& options, const Field&);
};

std::vector<Column> signal_error_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> signal_error_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> cell_cubic_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> cell_cubic_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

inline constexpr std::array measures{
    Measure{"signal_error", "xi and xi_max of every scheme along random rays: quantiles, and ratios between schemes",
            true, signal_error_columns, signal_error_rows},
    Measure{"cell_cubic", "whether a trilinear ray is a cubic inside each cell, and how its slope jumps between cells",
            true, cell_cubic_columns, cell_cubic_rows},
};

/// The measure that an item of an experiment's "measures" names. Throws InputError.
const Measure& measure_of(const JsonReader& options);

}  // namespace raytruth
