#include "raytruth/tables/table_file.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/core/npy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace raytruth {

namespace {

static_assert(std::endian::native == std::endian::little, "the bytes of numbers are written as they are");

template <class Number>
void append(std::string& bytes, Number number) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  bytes.append(raw.data(), raw.size());
}

constexpr double levels8 = 0xFF;
constexpr double levels16 = 0xFFFF;

/// Fixed-point numbers are stored as the integers of which they are multiples.
long level(double value, double levels) { return std::lround(std::clamp(value, 0.0, 1.0) * levels); }

Eigen::half half_of(double value) { return Eigen::half(static_cast<float>(value)); }

void append(std::string& bytes, double value, const TableFormat& format) {
  if (!format.is_texel) return append(bytes, value);
  switch (format.type) {
    case TexelType::unorm8:
      return append(bytes, static_cast<std::uint8_t>(level(value, levels8)));
    case TexelType::unorm16:
      return append(bytes, static_cast<std::uint16_t>(level(value, levels16)));
    case TexelType::float16:
      return append(bytes, Eigen::numext::bit_cast<std::uint16_t>(half_of(value)));
    case TexelType::float32:
      return append(bytes, static_cast<float>(value));
  }
}

std::string_view numpy_type(const TableFormat& format) {
  if (!format.is_texel) return "<f8";
  switch (format.type) {
    case TexelType::unorm8:
      return "|u1";
    case TexelType::unorm16:
      return "<u2";
    case TexelType::float16:
      return "<f2";
    case TexelType::float32:
      break;
  }
  return "<f4";
}

std::string_view nrrd_type(const TableFormat& format) {
  if (!format.is_texel) return "double";
  switch (format.type) {
    case TexelType::unorm8:
      return "uint8";
    case TexelType::unorm16:
      return "uint16";
    case TexelType::float16:
      throw InputError(fmt::format("{} in an NRRD file, which has no such numbers; another format, or .npy, is allowed",
                                   format.name));
    case TexelType::float32:
      break;
  }
  return "float";
}

std::string with_numbers(std::string bytes, const std::vector<double>& values, const TableFormat& format) {
  bytes.reserve(bytes.size() + values.size() * format.bytes);
  for (const double value : values) append(bytes, value, format);
  return bytes;
}

}  // namespace

double read_back(const TableFormat& format, double value) {
  if (!format.is_texel) return value;
  switch (format.type) {
    case TexelType::unorm8:
      return static_cast<double>(level(value, levels8)) / levels8;
    case TexelType::unorm16:
      return static_cast<double>(level(value, levels16)) / levels16;
    case TexelType::float16:
      return static_cast<double>(half_of(value));
    case TexelType::float32:
      break;
  }
  return static_cast<double>(static_cast<float>(value));
}

std::string npy_bytes(const std::vector<std::size_t>& shape, const std::vector<double>& values,
                      const TableFormat& format) {
  return with_numbers(npy_header(numpy_type(format), shape), values, format);
}

std::string nrrd_bytes(const std::vector<std::size_t>& shape, const std::vector<double>& values,
                       const TableFormat& format) {
  const std::vector<std::size_t> fastest_first(shape.rbegin(), shape.rend());
  return with_numbers(fmt::format("NRRD0004\ntype: {}\ndimension: {}\nsizes: {}\nendian: little\nencoding: raw\n\n",
                                  nrrd_type(format), shape.size(), fmt::join(fastest_first, " ")),
                      values, format);
}

}  // namespace raytruth
