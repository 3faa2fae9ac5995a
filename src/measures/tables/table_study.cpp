#include "measures/tables/table_study.hpp"

#include "raytruth/catalogue.hpp"

#include <algorithm>
#include <string_view>

namespace raytruth {

namespace {

constexpr double largest_optical_depth = 1e6;
constexpr std::int64_t most_cells = 4096;

}  // namespace

PiecewiseLinear TableStudy::transfer(const std::string& shape, double optical_depth, std::uint64_t seed) {
  const auto& entry = *std::find_if(catalogue::transfers.begin(), catalogue::transfers.end(),
                                    [&shape](const auto& transfer) { return transfer.name == shape; });
  return entry.make(optical_depth, seed);
}

std::string read_shape(const JsonReader& json) {
  std::vector<std::string_view> names;
  for (const auto& transfer : catalogue::transfers)
    if (transfer.make != nullptr) names.push_back(transfer.name);
  return json.word(names);
}

double read_optical_depth(const JsonReader& json) { return json.number(0, largest_optical_depth); }

TableStudy read_table_study(const JsonReader& json, std::size_t largest_size) {
  TableStudy study;
  for (const JsonReader& shape : json.at("shapes").items()) study.shapes.push_back(read_shape(shape));
  for (const JsonReader& depth : json.at("optical_depths").items())
    study.optical_depths.push_back(read_optical_depth(depth));
  for (const JsonReader& size : json.at("sizes").items())
    study.sizes.push_back(static_cast<std::size_t>(size.integer(2, static_cast<std::int64_t>(largest_size))));
  return study;
}

std::size_t read_cells(const JsonReader& json) {
  return static_cast<std::size_t>(json.at("cells").integer(1, most_cells));
}

std::vector<TableFormat> read_formats(const JsonReader& json) {
  std::vector<std::string_view> names;
  for (const TableFormat& format : table_formats) names.push_back(format.name);
  std::vector<TableFormat> formats;
  for (const JsonReader& item : json.at("formats").items()) {
    const std::string name = item.word(names);
    formats.push_back(*std::find_if(table_formats.begin(), table_formats.end(),
                                    [&name](const TableFormat& format) { return format.name == name; }));
  }
  return formats;
}

Columns<TableKeys> table_key_columns() {
  return {
      {.name = "shape", .description = "transfer function", .is_key = true, .cell = &TableKeys::shape},
      {.name = "optical_depth",
       .description = "of a slab that meets the largest extinction all along",
       .is_key = true,
       .cell = &TableKeys::optical_depth},
      {.name = "size",
       .description = "n, entries along each axis of the table",
       .is_key = true,
       .cell = &TableKeys::size},
  };
}

std::int64_t bytes_of(std::size_t entries, const TableFormat& format) {
  return static_cast<std::int64_t>(4 * format.bytes * entries);
}

Columns<CertifiedTableError> table_error_columns() {
  const auto column = [](const char* name, const char* description, double TableError::*error) {
    return RecordColumn<CertifiedTableError>{
        .name = name,
        .description = description,
        .radius = "radius",
        .cell = [error](const CertifiedTableError& of_table) { return of_table.error.*error; }};
  };
  return {
      column("error_max",
             "largest error of a look-up, all places, colour channels and opacity, against certified slabs",
             &TableError::max),
      column("error_l1", "mean magnitude of the error over the area of the table and the four channels",
             &TableError::mean),
      column("error_l2", "root mean square of it", &TableError::root_mean_square),
      column("band_max", "largest error in the diagonal band, cells with |i - j| <= 1", &TableError::band_max),
      column("band_l1", "mean magnitude in the band", &TableError::band_mean),
      column("outside_max", "largest error outside of the band", &TableError::outside_max),
      {.name = "front",
       .unit = "scalar",
       .description = "front scalar of the largest error",
       .cell = [](const CertifiedTableError& of_table) { return of_table.error.front; }},
      {.name = "back",
       .unit = "scalar",
       .description = "its back scalar",
       .cell = [](const CertifiedTableError& of_table) { return of_table.error.back; }},
      {.name = "radius",
       .description = "bound on the error of the errors: the reference's",
       .cell = &CertifiedTableError::radius},
  };
}

}  // namespace raytruth
