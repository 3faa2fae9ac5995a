#include "raytruth/core/random.hpp"

#include <Random123/philox.h>

#include <algorithm>

namespace raytruth {

std::array<double, 4> random_numbers(std::uint64_t seed, RandomStream stream, std::uint64_t index,
                                     std::uint32_t repetition) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
  const r123::Philox4x32 generator;
  const r123::Philox4x32::ctr_type counter{{low(index), high(index), repetition, static_cast<std::uint32_t>(stream)}};
  const r123::Philox4x32::key_type key{{low(seed), high(seed)}};
  const auto bits = generator(counter, key);
  std::array<double, 4> numbers{};
  std::transform(bits.begin(), bits.end(), numbers.begin(), [](std::uint32_t word) { return word * 0x1p-32; });
  return numbers;
}

}  // namespace raytruth
