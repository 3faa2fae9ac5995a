#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/statistics/order.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace raytruth {

namespace {

constexpr double meaningful_radii = 10;

struct Fitted {
  const char* name;
  double TableError::*error;
};

/// What a slope is fitted to.
constexpr std::array fitted{Fitted{"max", &TableError::max}, Fitted{"l1", &TableError::mean},
                            Fitted{"l2", &TableError::root_mean_square}, Fitted{"band", &TableError::band_max}};

CertifiedCell::vec4 exact_entry(const CertifiedCell& cell, std::size_t front, std::size_t back) {
  return cell.entry(front, back);
}

struct SizedError {
  std::size_t size;
  TableError error;
  double radius;
};

/// The error of an exact table of this size.
SizedError sized_error(const PiecewiseLinear& transfer, std::size_t size, std::size_t cells, std::uint64_t seed) {
  const CertifiedCells truth = certified_cells(transfer, TableStudy::axes(size), Emission::associated, cells, seed);
  return {size, bilinear_error(truth, exact_entry), truth.radius};
}

/// Orders over the steps 1 / (n - 1) of errors that the reference's radius supports; null where two are not left.
void add_orders(Row& row, const std::vector<SizedError>& errors) {
  for (const auto& [name, error] : fitted) {
    std::vector<StepError> points;
    for (const auto& [size, sized, radius] : errors)
      if (sized.*error > meaningful_radii * radius) points.push_back({1 / static_cast<double>(size - 1), sized.*error});
    Value order;
    Value residual;
    if (points.size() >= 2) {
      const FittedOrder fit = fit_order(points);
      order = fit.order;
      residual = fit.residual;
    }
    row.emplace_back(std::string("order_") + name, order);
    row.emplace_back(std::string("order_") + name + "_residual", residual);
  }
}

struct Map {
  std::vector<std::string> shapes;
  double optical_depth;
  std::size_t size;
};

Map read_map(const JsonReader& json) {
  constexpr std::int64_t largest_map = 513;
  json.only({"kind", "shapes", "optical_depth", "size"});
  Map map{.shapes = {},
          .optical_depth = read_optical_depth(json.at("optical_depth")),
          .size = static_cast<std::size_t>(json.at("size").integer(2, largest_map))};
  for (const JsonReader& shape : json.at("shapes").items()) map.shapes.push_back(read_shape(shape));
  return map;
}

/// From black at 1e-6 to white at 1.
int gray_of(double error) {
  constexpr double decades = 6;
  return static_cast<int>(std::lround(255 * std::clamp(1 + std::log10(std::max(error, 1e-300)) / decades, 0.0, 1.0)));
}

}  // namespace

std::vector<Column> table_resolution_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  options.only({"kind", "shapes", "optical_depths", "sizes", "cells"});
  read_table_study(options, largest_table_size);
  read_cells(options);
  std::vector<Column> columns = table_key_columns();
  columns.push_back({.name = "part",
                     .unit = "",
                     .description = "point: a table of exact entries; fit: the orders over all sizes",
                     .is_key = true});
  columns.push_back({.name = "cells", .unit = "", .description = "cells whose 4 x 4 places are looked up"});
  append(columns, table_error_columns());
  columns.push_back({.name = "l1_ratio", .unit = "", .description = "error_l1 over that of the size before"});
  columns.push_back({.name = "max_ratio", .unit = "", .description = "error_max over that of the size before"});
  for (const auto& [name, error] : fitted) {
    const std::string order = std::string("order_") + name;
    columns.push_back(
        {.name = order, .unit = "", .description = "slope of the logarithm of the error over that of 1/(n - 1)"});
    columns.push_back(
        {.name = order + "_residual", .unit = "", .description = "root mean square of log2(error) about the line"});
  }
  return columns;
}

std::vector<Row> table_resolution_rows(const Experiment& experiment, const JsonReader& options,
                                       const Field& /*field*/) {
  const TableStudy study = read_table_study(options, largest_table_size);
  const std::size_t cells = read_cells(options);
  std::vector<Row> rows;
  for (const std::string& shape : study.shapes)
    for (const double depth : study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      std::vector<SizedError> errors;
      for (const std::size_t size : study.sizes) {
        errors.push_back(sized_error(transfer, size, cells, experiment.seed));
        const auto& [its_size, error, radius] = errors.back();
        Row& row = rows.emplace_back(table_keys(shape, depth, size));
        row.emplace_back("part", "point");
        row.emplace_back("cells", static_cast<std::int64_t>(std::min(cells, size - 1) * std::min(cells, size - 1)));
        add_table_error(row, error, radius);
        if (errors.size() < 2) continue;
        const TableError& before = errors[errors.size() - 2].error;
        row.emplace_back("l1_ratio", error.mean / before.mean);
        row.emplace_back("max_ratio", error.max / before.max);
      }
      Row& row = rows.emplace_back(table_keys(shape, depth, study.sizes.back()));
      row.emplace_back("part", "fit");
      add_orders(row, errors);
    }
  return rows;
}

std::vector<Column> table_error_map_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_map(options);
  std::vector<Column> columns = table_key_columns();
  append(columns, {{.name = "line", .unit = "", .description = "of cells, 0 at the lowest back scalar", .is_key = true},
                   {.name = "line_max", .unit = "", .description = "largest error of look-ups in these cells"},
                   {.name = "pixels",
                    .unit = "",
                    .description = "largest error of look-ups in each cell, front scalar ascending, exact entries: two "
                                   "hexadecimal digits of 255 (1 + log10(error) / 6), 1e-6 being black and 1 white"}});
  return columns;
}

std::vector<Row> table_error_map_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const Map map = read_map(options);
  const TableAxes axes = TableStudy::axes(map.size);
  std::vector<Row> rows;
  for (const std::string& shape : map.shapes) {
    const CertifiedCells truth = certified_cells(TableStudy::transfer(shape, map.optical_depth, experiment.seed), axes,
                                                 Emission::associated, map.size, experiment.seed);
    const std::size_t side = map.size - 1;
    for (std::size_t line = 0; line < side; ++line) {
      double line_max = 0;
      std::string pixels;
      for (std::size_t i = 0; i < side; ++i) {
        const double error = bilinear_error({axes, {truth.cells[line * side + i]}, truth.radius}, exact_entry).max;
        line_max = std::max(line_max, error);
        pixels += fmt::format("{:02x}", gray_of(error));
      }
      Row& row = rows.emplace_back(table_keys(shape, map.optical_depth, map.size));
      row.insert(row.end(), {{"line", static_cast<std::int64_t>(line)}, {"line_max", line_max}, {"pixels", pixels}});
    }
  }
  return rows;
}

}  // namespace raytruth
