#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/transfer/emission.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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

struct Options {
  TableStudy study;
  std::size_t cells = 0;
  std::vector<TableFormat> formats;
  std::vector<int> weight_bits;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "sizes", "cells", "formats", "weight_bits"});
  return {.study = read_table_study(json, largest_table_size),
          .cells = read_cells(json),
          .formats = read_formats(json),
          .weight_bits = read_weight_bits(json)};
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

/// An exact table in a format, looked up with weights of so many bits.
struct Record {
  TableKeys keys;
  TableFormat format;
  int weight_bits = 0;  ///< 0: exact
  CertifiedTableError error;
  TableError own;         ///< from the same look-ups in binary64 with exact weights
  TableError resolution;  ///< of those
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::keys, table_key_columns());
  append(columns,
         {{.name = "format",
           .description = "of the table's numbers",
           .is_key = true,
           .cell = [](const Record& record) { return record.format.name; }},
          {.name = "weight_bits",
           .unit = "bit",
           .description = "k, weights of the look-up being multiples of 2^-k; null: exact",
           .is_key = true,
           .cell =
               [](const Record& record) {
                 return record.weight_bits > 0 ? std::optional(record.weight_bits) : std::nullopt;
               }},
          {.name = "bytes", .unit = "byte", .description = "of the table, RGBA", .cell = [](const Record& record) {
             return bytes_of(record.keys.size * record.keys.size, record.format);
           }}});
  append_part(columns, &Record::error, table_error_columns());
  append(columns,
         {{.name = "own_max",
           .description = "largest difference from the same look-ups in binary64 with exact weights: what format and "
                          "weights cost by themselves",
           .cell = [](const Record& record) { return record.own.max; }},
          {.name = "own_l1",
           .description = "mean magnitude of it",
           .cell = [](const Record& record) { return record.own.mean; }},
          {.name = "resolution_max",
           .description = "error_max in binary64 with exact weights",
           .cell = [](const Record& record) { return record.resolution.max; }},
          {.name = "resolution_l1",
           .description = "error_l1 in binary64 with exact weights",
           .cell = [](const Record& record) { return record.resolution.mean; }},
          {.name = "format_sets_error",
           .description = "whether format and weights cost more in the mean than the resolution does",
           .cell = [](const Record& record) { return record.own.mean > record.resolution.mean; }}});
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths)
      for (const std::size_t size : options.study.sizes) {
        const CertifiedCells truth =
            certified_cells(TableStudy::transfer(shape, depth, experiment.seed), TableStudy::axes(size),
                            Emission::associated, options.cells, experiment.seed);
        const TableError resolution = bilinear_error(truth, exact_entry);
        for (const TableFormat& format : options.formats)
          for (const int bits : options.weight_bits)
            records.push_back({.keys = {shape, depth, size},
                               .format = format,
                               .weight_bits = bits,
                               .error = {bilinear_error(truth, exact_entry, format, bits), truth.radius},
                               .own = own_error(truth, format, bits),
                               .resolution = resolution});
      }
  return records;
}

}  // namespace

extern const Measure table_formats_measure;
const Measure table_formats_measure{MeasureDefinition<Options, Record>{
    .name = "table_formats",
    .summary = "errors of look-ups by the format of the table and the weights of the texture unit",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
