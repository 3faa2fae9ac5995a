#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace raytruth {

// Four numbers side by side, as compilers know them: arithmetic is lane by lane.
using Float4 [[gnu::vector_size(16)]] = float;
using Double4 [[gnu::vector_size(32)]] = double;
using Int4 [[gnu::vector_size(16)]] = int;

/// Four numbers from anywhere.
inline Float4 load4(const float* from) {
  Float4 result;
  std::memcpy(&result, from, sizeof result);
  return result;
}

/// Two neighbours from here, two from there; joined in a register, since memory written in halves is slow to read as a
/// whole.
inline Float4 load2(const float* from, const float* and_from) {
  using Halves [[gnu::vector_size(16)]] = std::int64_t;
  Halves halves{};
  std::int64_t half = 0;
  std::memcpy(&half, from, sizeof half);
  halves[0] = half;
  std::memcpy(&half, and_from, sizeof half);
  halves[1] = half;
  return std::bit_cast<Float4>(halves);
}

/// Four such numbers as binary64. By reference: a function that returns four of them has another way to do so for each level.
inline void load2(const float* from, const float* and_from, Double4& result) {
  result = __builtin_convertvector(load2(from, and_from), Double4);
}
inline void load2(const double* from, const double* and_from, Double4& result) {
  result = Double4{from[0], from[1], and_from[0], and_from[1]};
}

}  // namespace raytruth
