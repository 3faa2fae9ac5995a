#pragma once

#include "raytruth/kernels/level.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __FMA__
#include <immintrin.h>
#endif

namespace raytruth::inline RAYTRUTH_LEVEL {

// As many as one register holds: GCC keeps vectors that are wider than a register in memory.
#if defined(__AVX512F__)
inline constexpr std::size_t float_lane_count = 16;
#elif defined(__FMA__)
inline constexpr std::size_t float_lane_count = 8;
#else
inline constexpr std::size_t float_lane_count = 4;
#endif

/// Binary32 numbers that are computed with side by side, as Lanes are with binary64.
struct alignas(4 * float_lane_count) FloatLanes {
  using Vector = float __attribute__((vector_size(4 * float_lane_count)));
  using Bits = std::int32_t __attribute__((vector_size(4 * float_lane_count)));

  Vector vector;

  FloatLanes() = default;
  // Implicit: the same number in all lanes.
  FloatLanes(float x) : vector(x - Vector{}) {}  // NOLINT(google-explicit-constructor)

  static FloatLanes load(const float* from) {
    FloatLanes result;
    std::memcpy(&result.vector, from, sizeof(Vector));
    return result;
  }
  void store(float* to) const { std::memcpy(to, &vector, sizeof(Vector)); }

  friend FloatLanes operator+(const FloatLanes& a, const FloatLanes& b) { return of(a.vector + b.vector); }
  friend FloatLanes operator-(const FloatLanes& a, const FloatLanes& b) { return of(a.vector - b.vector); }
  friend FloatLanes operator*(const FloatLanes& a, const FloatLanes& b) { return of(a.vector * b.vector); }
  friend FloatLanes operator/(const FloatLanes& a, const FloatLanes& b) { return of(a.vector / b.vector); }

  static FloatLanes of(Vector vector) {
    FloatLanes result;
    result.vector = vector;
    return result;
  }
};

/// a b + c: with one rounding where the processor has it, else with two.
inline FloatLanes multiply_add(const FloatLanes& a, const FloatLanes& b, const FloatLanes& c) {
#if defined(__AVX512F__)
  return FloatLanes::of(FloatLanes::Vector(_mm512_fmadd_ps(__m512(a.vector), __m512(b.vector), __m512(c.vector))));
#elif defined(__FMA__)
  return FloatLanes::of(FloatLanes::Vector(_mm256_fmadd_ps(__m256(a.vector), __m256(b.vector), __m256(c.vector))));
#else
  return a * b + c;
#endif
}

inline FloatLanes select(const FloatLanes::Bits& which, const FloatLanes& a, const FloatLanes& b) {
  return FloatLanes::of(which ? a.vector : b.vector);
}
inline FloatLanes larger(const FloatLanes& a, const FloatLanes& b) { return select(a.vector > b.vector, a, b); }
inline FloatLanes smaller(const FloatLanes& a, const FloatLanes& b) { return select(a.vector < b.vector, a, b); }

/// Lane l of the result is lane places[l] of `from`.
inline FloatLanes shuffled(const FloatLanes& from, const FloatLanes::Bits& places) {
#ifdef __clang__  // which shuffles by constant places only
  FloatLanes result;
  for (std::size_t lane = 0; lane < float_lane_count; ++lane) result.vector[lane] = from.vector[places[lane]];
  return result;
#else
  return FloatLanes::of(__builtin_shuffle(from.vector, places));
#endif
}

/// The smallest of all lanes.
inline float least(const FloatLanes& x) {
  float result = x.vector[0];
  for (std::size_t lane = 1; lane < float_lane_count; ++lane)
    result = x.vector[lane] < result ? x.vector[lane] : result;
  return result;
}

/// Bit l: whether something holds in lane l; lanes hold all bits or none.
inline std::uint32_t lane_mask(const FloatLanes::Bits& which) {
#if defined(__AVX512F__)
  return _mm512_test_epi32_mask(__m512i(which), __m512i(which));
#elif defined(__FMA__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(__m256(which)));
#else
  const auto lanes = std::bit_cast<std::array<std::int32_t, float_lane_count> >(which);
  std::uint32_t mask = 0;
  for (std::size_t lane = 0; lane < float_lane_count; ++lane) mask |= (lanes[lane] != 0 ? 1U : 0U) << lane;
  return mask;
#endif
}

#if defined(__AVX512F__)
inline constexpr __mmask16 all_lanes = 0xFFFF;  // without a mask GCC 12 warns of its own header
#endif

/// 1 / x for normal x > 0, to 2 units in the last place.
inline FloatLanes reciprocal(const FloatLanes& x) {
#if defined(__AVX512F__)
  // It takes 14 bits and one step of Newton's method: several times faster than the division.
  const FloatLanes y = FloatLanes::of(FloatLanes::Vector(_mm512_maskz_rcp14_ps(all_lanes, __m512(x.vector))));
  return multiply_add(y, multiply_add(FloatLanes(0.0F) - x, y, FloatLanes(1.0F)), y);
#else
  return FloatLanes(1.0F) / x;
#endif
}

/// The square root of a normal x > 0, to 2 units in the last place.
inline FloatLanes square_root(const FloatLanes& x) {
#if defined(__AVX512F__)
  const FloatLanes y = FloatLanes::of(FloatLanes::Vector(_mm512_maskz_rsqrt14_ps(all_lanes, __m512(x.vector))));
  const FloatLanes root = x * y;
  return multiply_add(multiply_add(FloatLanes(0.0F) - root, root, x), y * 0.5F, root);
#elif defined(__FMA__)
  return FloatLanes::of(FloatLanes::Vector(_mm256_sqrt_ps(__m256(x.vector))));
#else
  FloatLanes root;
  for (std::size_t lane = 0; lane < float_lane_count; ++lane) root.vector[lane] = __builtin_sqrtf(x.vector[lane]);
  return root;
#endif
}

/// 0, 1, 2, ...
inline FloatLanes::Bits lane_numbers() {
  FloatLanes::Bits numbers{};
  for (std::size_t lane = 0; lane < float_lane_count; ++lane) numbers[lane] = static_cast<std::int32_t>(lane);
  return numbers;
}

/// p(r) = (2^r - 1) / r for |r| <= 1/2: the polynomial of degree 4 whose largest relative error is least, 4.4e-7.
inline FloatLanes exponential_slope(const FloatLanes& r) {
  FloatLanes p = multiply_add(r, FloatLanes(0x1.5d87dep-10F), FloatLanes(0x1.3cbe58p-7F));
  p = multiply_add(r, p, FloatLanes(0x1.c6b26ep-5F));
  p = multiply_add(r, p, FloatLanes(0x1.ebfa4ep-3F));
  return multiply_add(r, p, FloatLanes(0x1.62e42ep-1F));
}

/// Opacities are small where an interval is a small part of a slab: up to this t no reduction is needed.
inline constexpr float thin_interval = 0.5F;

/// 1 - 2^-t for t >= 0, infinity too, or, IsThin, for 0 <= t <= thin_interval. With n the integer next to -t and
/// r = -(t + n), 1 - 2^n 2^r = (1 - 2^n) - 2^n r p(r) keeps the digits of small opacities too. Beyond t = 126 the
/// opacity is 1.
template <bool IsThin>
FloatLanes opacity_of(const FloatLanes& t) {
  if constexpr (IsThin) return t * exponential_slope(FloatLanes(0.0F) - t);
  constexpr float round_to_integer = 0x1.8p23F;  // adding it leaves the integer in the low bits
  const FloatLanes most(126.0F);
  const FloatLanes y = FloatLanes(0.0F) - FloatLanes::of(t.vector < most.vector ? t.vector : most.vector);
  const FloatLanes shifted = y + round_to_integer;
  const FloatLanes r = y - (shifted - round_to_integer);
  constexpr int mantissa_bits = 23;
  const auto scale_bits = (FloatLanes::Bits(shifted.vector) << mantissa_bits) + std::bit_cast<std::int32_t>(1.0F);
  const FloatLanes scale = FloatLanes::of(FloatLanes::Vector(scale_bits));
  return multiply_add(FloatLanes(0.0F) - scale * r, exponential_slope(r), FloatLanes(1.0F) - scale);
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
