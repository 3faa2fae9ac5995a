#pragma once

#include "raytruth/tables/look_up.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace raytruth {

// An array of numbers as the bytes of a file: rounded to the format, little-endian, C order (the last axis varies
// fastest).

/// A number as a reader of the file gets it: fixed-point ones as the stored integer over its largest, in binary64. A
/// texture unit may hand out the nearest binary32 instead: `stored`.
double read_back(const TableFormat& format, double value);

/// NumPy's format (numpy.lib.format, version 1.0).
std::string npy_bytes(const std::vector<std::size_t>& shape, const std::vector<double>& values,
                      const TableFormat& format);

/// NRRD (Teem, version 4), data attached and raw. Throws InputError for float16, which it does not have.
std::string nrrd_bytes(const std::vector<std::size_t>& shape, const std::vector<double>& values,
                       const TableFormat& format);

}  // namespace raytruth
