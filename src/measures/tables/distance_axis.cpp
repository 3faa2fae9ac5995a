#include "experiments/measure.hpp"
#include "measures/tables/table_difference.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/tables/dissertation_linear.hpp"
#include "raytruth/tables/exact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

constexpr std::size_t largest_size = 1024;
constexpr int positions = 256;       // between d_j and d_(j+1)
constexpr double frame_steps = 255;  // of an 8-bit frame

struct Variant {
  const char* name;
  DissertationAlgorithm algorithm;
  DistanceInterpolation interpolation;
};

constexpr std::array variants{
    Variant{"text", DissertationAlgorithm::text, DistanceInterpolation::opacity},
    Variant{"pseudo_code", DissertationAlgorithm::pseudo_code, DistanceInterpolation::opacity},
    Variant{"corrected", DissertationAlgorithm::corrected, DistanceInterpolation::opacity},
    Variant{"corrected_logarithm", DissertationAlgorithm::corrected, DistanceInterpolation::logarithm}};

struct Options {
  TableStudy study;
  std::vector<double> lengths;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "sizes", "shapes", "optical_depths", "lengths"});
  Options options{.study = read_table_study(json, largest_size), .lengths = {}};
  for (const JsonReader& length : json.at("lengths").items()) options.lengths.push_back(length.number(1.0 / 64, 64));
  return options;
}

/// All entries of a table.
struct WholeTable {
  TableKeys keys;
  double length = 0;
  double color_error = 0;
};

/// The error of an interpolation between two distances, of a homogeneous slab or of the entries of a table.
struct Record {
  const char* algorithm = nullptr;  ///< of a slab: what is interpolated
  double optical_depth = 0;
  double opacity_error = 0;
  std::optional<WholeTable> table;
};

/// The largest error of an opacity between two distances d and 2 d of a homogeneous slab of depth y at d, interpolated
/// linearly as it is or by the logarithm of 1 - opacity.
std::array<Record, 2> slabs_of(double depth) {
  double of_opacity = 0;
  double of_logarithm = 0;
  for (int k = 0; k <= positions; ++k) {
    const double weight = static_cast<double>(k) / positions;
    const double truth = -std::expm1(-(1 + weight) * depth);
    const double opacities = std::lerp(-std::expm1(-depth), -std::expm1(-2 * depth), weight);
    const double logarithms = -std::expm1(std::lerp(-depth, -2 * depth, weight));
    of_opacity = std::max(of_opacity, std::abs(opacities - truth));
    of_logarithm = std::max(of_logarithm, std::abs(logarithms - truth));
  }
  return {{{"opacity", depth, of_opacity, std::nullopt}, {"logarithm", depth, of_logarithm, std::nullopt}}};
}

void add_tables(const Experiment& experiment, const Options& options, std::vector<Record>& records) {
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      for (const std::size_t size : options.study.sizes)
        for (const double length : options.lengths) {
          TableAxes axes = TableStudy::axes(size);
          axes.length = length;
          const auto exact = exact_table(transfer, axes, experiment.emission);
          for (const auto& [name, algorithm, interpolation] : variants) {
            const auto table = dissertation_linear_table(transfer, axes, experiment.emission, algorithm, interpolation);
            const TableDifference error = largest_difference(table, exact);
            records.push_back({name, depth, error.opacity, WholeTable{{shape, depth, size}, length, error.color}});
          }
        }
    }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  const auto of_table = [](double WholeTable::*value) {
    return [value](const Record& record) {
      return record.table ? std::optional<Value>((*record.table).*value) : std::nullopt;
    };
  };
  Columns<Record> columns{
      {.name = "part",
       .description = "interpolation: of one homogeneous slab; table: all entries of a table",
       .is_key = true,
       .cell = [](const Record& record) { return record.table ? "table" : "interpolation"; }},
      {.name = "algorithm",
       .description = "opacity or logarithm: what is interpolated; else the variant of the dissertation's algorithm",
       .is_key = true,
       .cell = &Record::algorithm},
      written_here<Record>("length", of_table(&WholeTable::length)),
  };
  append_part(
      columns, [](const Record& record) { return record.table ? &record.table->keys : nullptr; }, table_key_columns());
  append(columns,
         {
             written_here<Record>(
                 "optical_depth",
                 [](const Record& record) { return cell_if(!record.table.has_value(), record.optical_depth); }),
             {.name = "length",
              .unit = "length",
              .description = "of the slabs; distances are powers of 2",
              .is_key = true,
              .cell = {}},
             {.name = "color_error",
              .description = "largest, of any channel, against the exact table",
              .cell = of_table(&WholeTable::color_error)},
             {.name = "opacity_error",
              .description = "largest, against the exact table or slab",
              .cell = &Record::opacity_error},
             {.name = "color_steps",
              .unit = "1/255",
              .description = "color_error in steps of an 8-bit frame",
              .cell =
                  [](const Record& record) {
                    return record.table ? std::optional<Value>(frame_steps * record.table->color_error) : std::nullopt;
                  }},
             {.name = "opacity_steps",
              .unit = "1/255",
              .description = "opacity_error in steps of an 8-bit frame",
              .cell = [](const Record& record) { return frame_steps * record.opacity_error; }},
         });
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const double depth : options.study.optical_depths)
    for (const Record& of_slab : slabs_of(depth)) records.push_back(of_slab);
  add_tables(experiment, options, records);
  return records;
}

}  // namespace

extern const Measure distance_axis_measure;
const Measure distance_axis_measure{MeasureDefinition<Options, Record>{
    .name = "distance_axis",
    .summary = "errors of tables for distances 2^j: the interpolation's and the algorithm's",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
