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
  /// The rows of a field, without `measure` and `field`; without `status` and `why` unless refused; the same bytes on
  /// any number of threads.
  std::vector<Row> (*rows)(const Experiment&, const JsonReader& options, const Field&);
};

std::vector<Column> signal_error_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> signal_error_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> cell_cubic_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> cell_cubic_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> turning_points_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> turning_points_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> orders_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> orders_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> virtual_samples_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> virtual_samples_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> frequency_response_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> frequency_response_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

std::vector<Column> minmax_bounds_columns(const Experiment& experiment, const JsonReader& options);
std::vector<Row> minmax_bounds_rows(const Experiment& experiment, const JsonReader& options, const Field& field);

inline constexpr std::array measures{
    Measure{"signal_error", "xi and xi_max of every scheme along random rays: quantiles, and ratios between schemes",
            true, signal_error_columns, signal_error_rows},
    Measure{"cell_cubic", "whether a trilinear ray is a cubic inside each cell, and how its slope jumps between cells",
            true, cell_cubic_columns, cell_cubic_rows},
    Measure{"turning_points", "how often the cubic inside a cell turns twice", true, turning_points_columns,
            turning_points_rows},
    Measure{"orders", "fitted orders of xi and xi_max, refined inside cells and at constant steps across them", true,
            orders_columns, orders_rows},
    Measure{"virtual_samples", "RMSE, maximum and PSNR of virtual samples, and of fewer or trilinear ones", true,
            virtual_samples_columns, virtual_samples_rows},
    Measure{"frequency_response", "Fourier transforms of the B-spline and of virtual samples, closed form and measured",
            false, frequency_response_columns, frequency_response_rows},
    Measure{"minmax_bounds", "how far virtual samples leave the range of their data and of the block they lie in",
            false, minmax_bounds_columns, minmax_bounds_rows},
};

/// The measure that an item of an experiment's "measures" names. Throws InputError.
const Measure& measure_of(const JsonReader& options);

}  // namespace raytruth
