#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/statistics/order.hpp"
#include "raytruth/transfer/emission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr double meaningful_radii = 10;

struct Options {
  TableStudy study;
  std::size_t cells = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "sizes", "cells"});
  return {.study = read_table_study(json, largest_table_size), .cells = read_cells(json)};
}

/// What a slope is fitted to.
struct Fitted {
  const char* name;
  double TableError::*error;
};

constexpr std::array fitted{Fitted{"max", &TableError::max}, Fitted{"l1", &TableError::mean},
                            Fitted{"l2", &TableError::root_mean_square}, Fitted{"band", &TableError::band_max}};

CertifiedCell::vec4 exact_entry(const CertifiedCell& cell, std::size_t front, std::size_t back) {
  return cell.entry(front, back);
}

/// A table of exact entries.
struct Point {
  std::size_t size = 0;
  std::size_t cells = 0;  ///< looked up
  CertifiedTableError error;
  std::optional<TableError> before;  ///< of the size before, where there is one
};

/// The order of each of `fitted`; none where the reference's radius supports fewer than two errors.
using Orders = std::array<std::optional<FittedOrder>, fitted.size()>;

/// Over the steps 1 / (n - 1).
Orders orders_of(const std::vector<Point>& tables) {
  Orders orders;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    std::vector<StepError> points;
    for (const Point& table : tables) {
      const double error = table.error.error.*fitted[i].error;
      if (error > meaningful_radii * table.error.radius)
        points.push_back({1 / static_cast<double>(table.size - 1), error});
    }
    if (points.size() >= 2) orders[i] = fit_order(points);
  }
  return orders;
}

/// A table, or the orders over all sizes.
struct Record {
  TableKeys keys;
  std::variant<Point, Orders> found;
};

Columns<Point> point_columns() {
  Columns<Point> columns{
      {.name = "cells", .description = "cells whose 4 x 4 places are looked up", .cell = &Point::cells},
  };
  append_part(columns, &Point::error, table_error_columns());
  const auto ratio = [](double TableError::*error) {
    return [error](const Point& point) {
      return point.before ? std::optional<Value>(point.error.error.*error / (*point.before).*error) : std::nullopt;
    };
  };
  append(
      columns,
      {{.name = "l1_ratio", .description = "error_l1 over that of the size before", .cell = ratio(&TableError::mean)},
       {.name = "max_ratio",
        .description = "error_max over that of the size before",
        .cell = ratio(&TableError::max)}});
  return columns;
}

Columns<Orders> order_columns() {
  Columns<Orders> columns;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    const auto column = [i](const char* suffix, const char* description, double FittedOrder::*value) {
      return RecordColumn<Orders>{.name = fmt::format("order_{}{}", fitted[i].name, suffix),
                                  .description = description,
                                  .cell = [i, value](const Orders& orders) {
                                    return orders[i] ? std::optional((*orders[i]).*value) : std::nullopt;
                                  }};
    };
    append(columns, {column("", "slope of the logarithm of the error over that of 1/(n - 1)", &FittedOrder::order),
                     column("_residual", "root mean square of log2(error) about the line", &FittedOrder::residual)});
  }
  return columns;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::keys, table_key_columns());
  columns.push_back(
      {.name = "part",
       .description = "point: a table of exact entries; fit: the orders over all sizes",
       .is_key = true,
       .cell = [](const Record& record) { return std::holds_alternative<Point>(record.found) ? "point" : "fit"; }});
  append_part(
      columns, [](const Record& record) { return std::get_if<Point>(&record.found); }, point_columns());
  append_part(
      columns, [](const Record& record) { return std::get_if<Orders>(&record.found); }, order_columns());
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      std::vector<Point> points;
      for (const std::size_t size : options.study.sizes) {
        const CertifiedCells truth =
            certified_cells(transfer, TableStudy::axes(size), Emission::associated, options.cells, experiment.seed);
        const std::size_t side = std::min(options.cells, size - 1);
        Point point{.size = size,
                    .cells = side * side,
                    .error = {bilinear_error(truth, exact_entry), truth.radius},
                    .before = std::nullopt};
        if (!points.empty()) point.before = points.back().error.error;
        points.push_back(point);
        records.push_back({{shape, depth, size}, point});
      }
      records.push_back({{shape, depth, options.study.sizes.back()}, orders_of(points)});
    }
  return records;
}

/// Options of the second measure, a map of the errors of one table.
struct Map {
  std::vector<std::string> shapes;
  double optical_depth = 0;
  std::size_t size = 0;
};

Map read_map(const Experiment& /*experiment*/, const JsonReader& json) {
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

/// A line of cells.
struct Line {
  TableKeys keys;
  std::size_t line = 0;  ///< 0 at the lowest back scalar
  double largest = 0;
  std::string pixels;
};

Columns<Line> line_columns(const Experiment& /*experiment*/, const Map& /*map*/) {
  Columns<Line> columns;
  append_part(columns, &Line::keys, table_key_columns());
  append(columns,
         {{.name = "line", .description = "of cells, 0 at the lowest back scalar", .is_key = true, .cell = &Line::line},
          {.name = "line_max", .description = "largest error of look-ups in these cells", .cell = &Line::largest},
          {.name = "pixels",
           .description = "largest error of look-ups in each cell, front scalar ascending, exact entries: two "
                          "hexadecimal digits of 255 (1 + log10(error) / 6), 1e-6 being black and 1 white",
           .cell = &Line::pixels}});
  return columns;
}

std::vector<Line> lines(const Experiment& experiment, const Map& map) {
  const TableAxes axes = TableStudy::axes(map.size);
  std::vector<Line> lines;
  for (const std::string& shape : map.shapes) {
    const CertifiedCells truth = certified_cells(TableStudy::transfer(shape, map.optical_depth, experiment.seed), axes,
                                                 Emission::associated, map.size, experiment.seed);
    const std::size_t side = map.size - 1;
    for (std::size_t row = 0; row < side; ++row) {
      Line& line = lines.emplace_back(
          Line{.keys = {shape, map.optical_depth, map.size}, .line = row, .largest = 0, .pixels = {}});
      for (std::size_t i = 0; i < side; ++i) {
        const double error = bilinear_error({axes, {truth.cells[row * side + i]}, truth.radius}, exact_entry).max;
        line.largest = std::max(line.largest, error);
        line.pixels += fmt::format("{:02x}", gray_of(error));
      }
    }
  }
  return lines;
}

}  // namespace

extern const Measure table_resolution_measure;
const Measure table_resolution_measure{MeasureDefinition<Options, Record>{
    .name = "table_resolution",
    .summary = "errors of look-ups in exact tables against their size, and their orders",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

extern const Measure table_error_map_measure;
const Measure table_error_map_measure{MeasureDefinition<Map, Line>{.name = "table_error_map",
                                                                   .summary = "where on an exact table look-ups err",
                                                                   .read = read_map,
                                                                   .columns = line_columns,
                                                                   .of_experiment = lines}};

}  // namespace raytruth
