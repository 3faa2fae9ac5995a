#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/tables/dissertation_linear.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/table_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

constexpr std::size_t largest_size = 1024;
constexpr int positions = 256;  // between d_j and d_(j+1)

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

Options read_options(const JsonReader& json) {
  json.only({"kind", "sizes", "shapes", "optical_depths", "lengths"});
  Options options{.study = read_table_study(json, largest_size), .lengths = {}};
  for (const JsonReader& length : json.at("lengths").items()) options.lengths.push_back(length.number(1.0 / 64, 64));
  return options;
}

/// The largest error of an opacity between two distances d and 2 d of a homogeneous slab of depth y at d, interpolated
/// linearly as it is or by the logarithm of 1 - opacity.
void add_interpolation(const Options& asked, std::vector<Row>& rows) {
  constexpr double eight_bits = 255;
  for (const double depth : asked.study.optical_depths) {
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
    for (const auto& [name, error] : {std::pair{"opacity", of_opacity}, {"logarithm", of_logarithm}})
      rows.push_back({{"part", "interpolation"},
                      {"algorithm", name},
                      {"optical_depth", depth},
                      {"opacity_error", error},
                      {"opacity_steps", eight_bits * error}});
  }
}

void add_tables(const Experiment& experiment, const Options& asked, std::vector<Row>& rows) {
  for (const std::string& shape : asked.study.shapes)
    for (const double depth : asked.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      for (const std::size_t size : asked.study.sizes)
        for (const double length : asked.lengths) {
          TableAxes axes = TableStudy::axes(size);
          axes.length = length;
          const auto exact = exact_table(transfer, axes, experiment.emission);
          for (const auto& [name, algorithm, interpolation] : variants) {
            const auto table = dissertation_linear_table(transfer, axes, experiment.emission, algorithm, interpolation);
            const TableDifference error = largest_difference(table, exact);
            Row& row = rows.emplace_back(Row{{"part", "table"}, {"algorithm", name}, {"length", length}});
            const Row keys = table_keys(shape, depth, size);
            row.insert(row.end(), keys.begin(), keys.end());
            row.insert(row.end(), {{"color_error", error.color},
                                   {"opacity_error", error.opacity},
                                   {"color_steps", 255 * error.color},
                                   {"opacity_steps", 255 * error.opacity}});
          }
        }
    }
}

}  // namespace

std::vector<Column> distance_axis_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns{
      {.name = "part",
       .unit = "",
       .description = "interpolation: of one homogeneous slab; table: all entries of a table",
       .is_key = true},
      {.name = "algorithm",
       .unit = "",
       .description = "opacity or logarithm: what is interpolated; else the variant of the dissertation's algorithm",
       .is_key = true},
  };
  append(columns, table_key_columns());
  columns.insert(
      columns.end(),
      {
          {.name = "length",
           .unit = "length",
           .description = "of the slabs; distances are powers of 2",
           .is_key = true},
          {.name = "color_error", .unit = "", .description = "largest, of any channel, against the exact table"},
          {.name = "opacity_error", .unit = "", .description = "largest, against the exact table or slab"},
          {.name = "color_steps", .unit = "1/255", .description = "color_error in steps of an 8-bit frame"},
          {.name = "opacity_steps", .unit = "1/255", .description = "opacity_error in steps of an 8-bit frame"},
      });
  return columns;
}

std::vector<Row> distance_axis_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  add_interpolation(asked, rows);
  add_tables(experiment, asked, rows);
  return rows;
}

}  // namespace raytruth
