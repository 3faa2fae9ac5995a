#pragma once

#include "raytruth/kernels/float_lanes.hpp"
#include "raytruth/kernels/slab_kernels.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace raytruth::inline RAYTRUTH_LEVEL {

// A register holds the four channels of as many rays as it has room for. On their way to the entries rays are four
// numbers at every level.

using FourFloats = float __attribute__((vector_size(16)));
using FourIndices = std::int32_t __attribute__((vector_size(16)));

/// Where four rays are along an axis of the table: the entry before, and the weight of the next one.
struct FourPlaces {
  FourIndices first;
  FourFloats weight;

  FourPlaces(const SlabTable& table, const float* scalars) {
    FourFloats s;
    std::memcpy(&s, scalars, sizeof s);
    const FourFloats zero{};
    const FourFloats last = static_cast<float>(table.size - 1) - zero;
    FourFloats position = s * table.scale + table.offset;
    position = position > zero ? position : zero;
    position = position < last ? position : last;
    // At the last entry the one before it comes first, so that both always exist.
    const FourFloats inside = position < last - 1.0F ? position : last - 1.0F;
    first = __builtin_convertvector(inside, FourIndices);
    weight = position - __builtin_convertvector(first, FourFloats);
  }
};

inline FloatLanes linear(const FloatLanes& a, const FloatLanes& b, const FloatLanes& weight) {
  return multiply_add(weight, b - a, a);
}

/// Bilinear look-ups of the rays of a register, `texels` those at the two entries before: first between the back
/// entries, then between the front ones; texels that are neighbours along the front axis are read together.
#if defined(__AVX512F__)

using EightFloats = float __attribute__((vector_size(32)));

inline FloatLanes two_pairs(const float* ray, const float* next_ray) {
  EightFloats a;
  EightFloats b;
  std::memcpy(&a, ray, sizeof a);
  std::memcpy(&b, next_ray, sizeof b);
  return FloatLanes::of(__builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
}

/// The four numbers in a register's first four places; GCC shuffles 128 bits into 512 by way of memory.
inline FloatLanes::Vector widened(const FourFloats& x) { return FloatLanes::Vector(_mm512_castps128_ps512(__m128(x))); }

inline FloatLanes look_up(const std::array<const float*, 4>& texels, std::size_t row, const FourFloats& front,
                          const FourFloats& back, std::size_t /*first_ray*/) {
  const auto f = widened(front);
  const auto b = widened(back);
  const auto between_rows = [&](std::size_t ray, const FloatLanes::Vector& weight) {
    const FloatLanes first = two_pairs(texels[ray], texels[ray + 1]);
    return linear(first, two_pairs(texels[ray] + row, texels[ray + 1] + row), FloatLanes::of(weight)).vector;
  };
  const auto x = between_rows(0, __builtin_shufflevector(b, b, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1));
  const auto y = between_rows(2, __builtin_shufflevector(b, b, 2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3));
  const auto first = __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
  const auto next = __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
  const auto weight = __builtin_shufflevector(f, f, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
  return linear(FloatLanes::of(first), FloatLanes::of(next), FloatLanes::of(weight));
}

inline FloatLanes opacity_of_rays(const FloatLanes& rays) {
  const auto v = rays.vector;
  return FloatLanes::of(__builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15));
}

#elif defined(__FMA__)

inline FloatLanes look_up(const std::array<const float*, 4>& texels, std::size_t row, const FourFloats& front,
                          const FourFloats& back, std::size_t first_ray) {
  const auto between_rows = [&](std::size_t ray) {
    const float* const a = texels[ray];
    return linear(FloatLanes::load(a), FloatLanes::load(a + row), FloatLanes(back[ray])).vector;
  };
  const auto x = between_rows(first_ray);
  const auto y = between_rows(first_ray + 1);
  const FloatLanes::Vector a = FloatLanes(front[first_ray]).vector;
  const FloatLanes::Vector b = FloatLanes(front[first_ray + 1]).vector;
  return linear(FloatLanes::of(__builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11)),
                FloatLanes::of(__builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15)),
                FloatLanes::of(__builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11)));
}

inline FloatLanes opacity_of_rays(const FloatLanes& rays) {
  const auto v = rays.vector;
  return FloatLanes::of(__builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7));
}

#else

inline FloatLanes look_up(const std::array<const float*, 4>& texels, std::size_t row, const FourFloats& front,
                          const FourFloats& back, std::size_t ray) {
  const float* const a = texels[ray];
  const FloatLanes weight(back[ray]);
  return linear(linear(FloatLanes::load(a), FloatLanes::load(a + row), weight),
                linear(FloatLanes::load(a + 4), FloatLanes::load(a + row + 4), weight), FloatLanes(front[ray]));
}

inline FloatLanes opacity_of_rays(const FloatLanes& ray) { return FloatLanes(ray.vector[3]); }

#endif

/// SlabKernels::march_four.
inline void march_four(const SlabTable& table, const float* scalars, std::size_t slabs, float* rays) {
  constexpr std::size_t registers = 16 / float_lane_count;
  const std::size_t row = 4 * table.size;
  std::array<FloatLanes, registers> sums{};
  FourPlaces front(table, scalars);
  for (std::size_t k = 1; k <= slabs; ++k) {
    const FourPlaces back(table, scalars + 4 * k);
    const FourIndices entries = back.first * static_cast<std::int32_t>(table.size) + front.first;
    std::array<const float*, 4> texels;
    for (std::size_t ray = 0; ray < 4; ++ray)
      texels[ray] = table.texels + 4 * static_cast<std::ptrdiff_t>(entries[ray]);
    for (std::size_t i = 0; i < registers; ++i) {
      const FloatLanes slab = look_up(texels, row, front.weight, back.weight, i * float_lane_count / 4);
      sums[i] = multiply_add(FloatLanes(1.0F) - opacity_of_rays(sums[i]), slab, sums[i]);
    }
    front = back;
  }
  for (std::size_t i = 0; i < registers; ++i) sums[i].store(rays + i * float_lane_count);
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
