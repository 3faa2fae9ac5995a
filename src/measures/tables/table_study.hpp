#pragma once

#include "experiments/columns.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/tables/table_error.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace raytruth {

/// Tables of slabs of length 1 and scalars in [0, 1], associated emission: what the studies of tables have in common.
/// JSON: "shapes", "optical_depths", "sizes".
struct TableStudy {
  std::vector<std::string> shapes;     ///< transfer functions of the catalogue
  std::vector<double> optical_depths;  ///< of a slab that meets the largest extinction all along
  std::vector<std::size_t> sizes;

  [[nodiscard]] static TableAxes axes(std::size_t size) { return {.size = size, .low = 0, .high = 1, .length = 1}; }
  [[nodiscard]] static PiecewiseLinear transfer(const std::string& shape, double optical_depth, std::uint64_t seed);
};

/// Throws InputError.
std::string read_shape(const JsonReader& json);
double read_optical_depth(const JsonReader& json);
TableStudy read_table_study(const JsonReader& json, std::size_t largest_size);
/// "cells": how many of each axis `certified_cells` looks at.
std::size_t read_cells(const JsonReader& json);
/// "formats": names of `table_formats`.
std::vector<TableFormat> read_formats(const JsonReader& json);

/// Which table a row is about.
struct TableKeys {
  std::string shape;
  double optical_depth = 0;
  std::size_t size = 0;
};

Columns<TableKeys> table_key_columns();

/// Bytes of an RGBA table of so many entries.
std::int64_t bytes_of(std::size_t entries, const TableFormat& format);

/// How far look-ups in a table are from the truth, and how far that may be off: the radius of the reference.
struct CertifiedTableError {
  TableError error;
  double radius = 0;
};

Columns<CertifiedTableError> table_error_columns();

}  // namespace raytruth
