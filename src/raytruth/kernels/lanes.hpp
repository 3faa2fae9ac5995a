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

/// The bits of Lanes, or for every lane whether something holds: all bits or none.
struct alignas(8 * lane_count) LaneBits {
  using Vector = std::int64_t __attribute__((vector_size(8 * lane_count)));

  Vector vector{};

  friend LaneBits operator+(const LaneBits& a, const LaneBits& b) { return {a.vector + b.vector}; }
  friend LaneBits operator|(const LaneBits& a, std::int64_t b) { return {a.vector | b}; }
  friend LaneBits operator&(const LaneBits& a, std::int64_t b) { return {a.vector & b}; }
  friend LaneBits operator&(const LaneBits& a, const LaneBits& b) { return {a.vector & b.vector}; }
  friend LaneBits operator<<(const LaneBits& a, int b) { return {a.vector << b}; }
  friend LaneBits operator>>(const LaneBits& a, int b) { return {a.vector >> b}; }
};

/// Eight binary64 numbers that are computed with side by side: one register, or two, or four, as the processor has
/// them.
struct alignas(8 * lane_count) Lanes {
  using Vector = double __attribute__((vector_size(8 * lane_count)));

  Vector vector{};

  Lanes() = default;
  Lanes(const Vector& lanes) : vector(lanes) {}  // NOLINT(google-explicit-constructor)
  // Implicit, so that one template serves Lanes and double: the same number in all lanes.
  Lanes(double x) : vector(x - Vector{}) {}  // NOLINT(google-explicit-constructor)

  explicit Lanes(const Eight& numbers) : Lanes(load(numbers.data())) {}

  static Lanes load(const double* from) {
    Lanes result;
    std::memcpy(&result.vector, from, sizeof(Vector));
    return result;
  }

  explicit operator Eight() const {
    Eight numbers;
    std::memcpy(numbers.data(), &vector, sizeof(Vector));
    return numbers;
  }

  double operator[](std::size_t lane) const { return vector[lane]; }
  void set(std::size_t lane, double x) { vector[lane] = x; }

  Lanes& operator+=(const Lanes& b) { return vector += b.vector, *this; }
  Lanes& operator-=(const Lanes& b) { return vector -= b.vector, *this; }
  Lanes& operator*=(const Lanes& b) { return vector *= b.vector, *this; }
  Lanes& operator/=(const Lanes& b) { return vector /= b.vector, *this; }
  friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a) += b; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a) -= b; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a) *= b; }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a) /= b; }
  friend Lanes operator-(const Lanes& a) { return Lanes(0.0) -= a; }
  friend LaneBits operator<(const Lanes& a, const Lanes& b) { return {a.vector < b.vector}; }
};

// What follows is written for Lanes and for double alike.

/// a b + c: with one rounding where the processor has it, else with two. No bound that is proven here asks which. For
/// one number always with two: the compiler does neighbours side by side, which saves more.
inline double multiply_add(double a, double b, double c) { return a * b + c; }
inline Lanes multiply_add(const Lanes& a, const Lanes& b, const Lanes& c) {
#if defined(__AVX512F__)
  Lanes result;
  result.vector = Lanes::Vector(_mm512_fmadd_pd(__m512d(a.vector), __m512d(b.vector), __m512d(c.vector)));
  return result;
#elif defined(__FMA__)
  struct Halves {
    __m256d low, high;
  };
  const auto x = std::bit_cast<Halves>(a);
  const auto y = std::bit_cast<Halves>(b);
  const auto z = std::bit_cast<Halves>(c);
  return std::bit_cast<Lanes>(Halves{_mm256_fmadd_pd(x.low, y.low, z.low), _mm256_fmadd_pd(x.high, y.high, z.high)});
#else
  return a * b + c;
#endif
}

inline Lanes select(const LaneBits& which, const Lanes& a, const Lanes& b) {
  Lanes result;
  result.vector = which.vector ? a.vector : b.vector;
  return result;
}
inline double select(bool which, double a, double b) { return which ? a : b; }

inline LaneBits to_bits(const Lanes& x) { return std::bit_cast<LaneBits>(x); }
inline std::int64_t to_bits(double x) { return std::bit_cast<std::int64_t>(x); }
inline Lanes from_bits(const LaneBits& x) { return std::bit_cast<Lanes>(x); }
inline double from_bits(std::int64_t x) { return std::bit_cast<double>(x); }

inline LaneBits both(const LaneBits& a, const LaneBits& b) { return a & b; }
inline bool both(bool a, bool b) { return a && b; }

/// b where either is not a number.
template <class Vector>
Vector larger(const Vector& a, const Vector& b) {
  return select(b < a, a, b);
}

/// b where either is not a number.
template <class Vector>
Vector smaller(const Vector& a, const Vector& b) {
  return select(a < b, a, b);
}

#ifdef __AVX512F__
// One instruction, which the compiler does not see in the above. (The functions without `maskz` do the same, but by way
// of a variable that GCC warns of as not initialized.)
template <>
inline Lanes larger(const Lanes& a, const Lanes& b) {
  return Lanes::Vector(_mm512_maskz_max_pd(0xff, __m512d(a.vector), __m512d(b.vector)));
}

template <>
inline Lanes smaller(const Lanes& a, const Lanes& b) {
  return Lanes::Vector(_mm512_maskz_min_pd(0xff, __m512d(a.vector), __m512d(b.vector)));
}
#endif

template <class Vector>
Vector magnitude(const Vector& x) {
  return from_bits(to_bits(x) & INT64_MAX);
}

/// Whether something holds in at least one lane.
inline bool any(const LaneBits& which) {
  LaneBits::Vector bits = which.vector;
  bits |= __builtin_shufflevector(bits, bits, 4, 5, 6, 7, 0, 1, 2, 3);
  bits |= __builtin_shufflevector(bits, bits, 2, 3, 0, 1, 6, 7, 4, 5);
  return (bits[0] | bits[1]) != 0;
}

/// Combines all lanes into one number, by halves.
template <class Combine>
double combined(const Lanes& x, const Combine& combine) {
  const auto& v = x.vector;
  const Lanes four = combine(x, Lanes{__builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3)});
  const Lanes two = combine(four, Lanes{__builtin_shufflevector(four.vector, four.vector, 2, 3, 0, 1, 6, 7, 4, 5)});
  return combine(two[0], two[1]);
}

inline double sum(const Lanes& x) {
  return combined(x, [](const auto& a, const auto& b) { return a + b; });
}

inline double largest(const Lanes& x) {
  return combined(x, [](const auto& a, const auto& b) { return larger(a, b); });
}
inline double largest(double x) { return x; }

}  // namespace raytruth::inline RAYTRUTH_LEVEL
