#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// What stands before the numbers of a NumPy file (numpy.lib.format, version 1.0): magic, version and the header,
/// padded with spaces so that the data begin at a multiple of 64 bytes. `type` is NumPy's, as "<f4"; `shape` is in C
/// order.
inline std::string npy_header(std::string_view type, const std::vector<std::size_t>& shape) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", type,
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  constexpr std::size_t preamble = 10;
  header.append(63 - (preamble + header.size()) % 64, ' ');
  header += '\n';
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(header.size() & 0xFF);
  file += static_cast<char>(header.size() >> 8);
  return file + header;
}

}  // namespace raytruth
