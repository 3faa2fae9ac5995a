#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/transfer/emission.hpp"

namespace raytruth {

namespace {

constexpr int most_weight_bits = 16;

/// 0 first: weights as exact as the arithmetic.
std::vector<int> read_weight_bits(const JsonReader& json) {
  std::vector<int> bits{0};
  for (const JsonReader& item : json.at("weight_bits").items())
    bits.push_back(static_cast<int>(item.integer(1, most_weight_bits)));
  return bits;
}

CertifiedCell::vec4 exact_entry(const CertifiedCell& cell, std::size_t front, std::size_t back) {
  return cell.entry(front, back);
}

/// How far look-ups in this format are from those in binary64 with exact weights, over the same places.
TableError own_error(CertifiedCells truth, const TableFormat& format, int weight_bits) {
  const TableAxes axes = truth.axes;
  for (CertifiedCell& cell : truth.cells)
    for (std::size_t place = 0; place < cell.slabs.size(); ++place)
      cell.slabs[place] = bilinear<double>(
          axes, [&cell](std::size_t front, std::size_t back) { return cell.entry(front, back); },
          place_of(axes, cell, place));
  return bilinear_error(truth, exact_entry, format, weight_bits);
}

}  // namespace

std::vector<Column> table_formats_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  options.only({"kind", "shapes", "optical_depths", "sizes", "cells", "formats", "weight_bits"});
  read_table_study(options, largest_table_size);
  read_cells(options);
  read_formats(options);
  read_weight_bits(options);
  std::vector<Column> columns = table_key_columns();
  append(columns, {{.name = "format", .unit = "", .description = "of the table's numbers", .is_key = true},
                   {.name = "weight_bits",
                    .unit = "bit",
                    .description = "k, weights of the look-up being multiples of 2^-k; null: exact",
                    .is_key = true},
                   {.name = "bytes", .unit = "byte", .description = "of the table, RGBA"}});
  append(columns, table_error_columns());
  append(columns,
         {{.name = "own_max",
           .unit = "",
           .description = "largest difference from the same look-ups in binary64 with exact weights: what format and "
                          "weights cost by themselves"},
          {.name = "own_l1", .unit = "", .description = "mean magnitude of it"},
          {.name = "resolution_max", .unit = "", .description = "error_max in binary64 with exact weights"},
          {.name = "resolution_l1", .unit = "", .description = "error_l1 in binary64 with exact weights"},
          {.name = "format_sets_error",
           .unit = "",
           .description = "whether format and weights cost more in the mean than the resolution does"}});
  return columns;
}

std::vector<Row> table_formats_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const TableStudy study = read_table_study(options, largest_table_size);
  const std::size_t cells = read_cells(options);
  const std::vector<TableFormat> formats = read_formats(options);
  const std::vector<int> weight_bits = read_weight_bits(options);
  std::vector<Row> rows;
  for (const std::string& shape : study.shapes)
    for (const double depth : study.optical_depths)
      for (const std::size_t size : study.sizes) {
        const CertifiedCells truth =
            certified_cells(TableStudy::transfer(shape, depth, experiment.seed), TableStudy::axes(size),
                            Emission::associated, cells, experiment.seed);
        const TableError resolution = bilinear_error(truth, exact_entry);
        for (const TableFormat& format : formats)
          for (const int bits : weight_bits) {
            const TableError own = own_error(truth, format, bits);
            Row& row = rows.emplace_back(table_keys(shape, depth, size));
            row.insert(row.end(), {{"format", std::string(format.name)},
                                   {"weight_bits", bits > 0 ? Value(std::int64_t{bits}) : Value()},
                                   {"bytes", bytes_of(size * size, format)}});
            add_table_error(row, bilinear_error(truth, exact_entry, format, bits), truth.radius);
            row.insert(row.end(), {{"own_max", own.max},
                                   {"own_l1", own.mean},
                                   {"resolution_max", resolution.max},
                                   {"resolution_l1", resolution.mean},
                                   {"format_sets_error", own.mean > resolution.mean}});
          }
      }
  return rows;
}

}  // namespace raytruth
