#pragma once

#include "raytruth/kernels/float_lanes.hpp"
#include "raytruth/kernels/slab_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// What a stretch does: its opacity, and the weights of the colour at the lower entry of its interval and of the
/// difference of the upper entry's colour from it.
struct StretchLight {
  FloatLanes opacity;
  FloatLanes lower;
  FloatLanes difference;
};

template <bool IsPlain, bool IsThin>
StretchLight stretch_light(const DiagonalStretch& stretch, const DiagonalNode* nodes, const FloatLanes& rate,
                           const FloatLanes& rate_difference) {
  constexpr float log2_e = 0x1.715476p0F;
  const auto opacity_behind = [](const FloatLanes& depth) { return opacity_of<IsThin>(depth * log2_e); };
  StretchLight light{.opacity = opacity_behind(multiply_add(rate_difference, FloatLanes(stretch.depth_difference),
                                                            rate * stretch.depth_rate)),
                     .lower = {},
                     .difference = {}};
  for (std::size_t i = 0; i < stretch.node_count; ++i) {
    const DiagonalNode& node = nodes[i];
    const FloatLanes below = multiply_add(rate_difference, FloatLanes(node.depth_difference), rate * node.depth_rate);
    FloatLanes seen = (FloatLanes(1.0F) - opacity_behind(below)) * node.weight;
    if constexpr (!IsPlain) seen = seen * multiply_add(rate_difference, FloatLanes(node.place), rate);
    if constexpr (IsPlain) light.lower = light.lower + seen;
    light.difference = multiply_add(seen, FloatLanes(node.place), light.difference);
  }
  if constexpr (!IsPlain) light.lower = light.opacity;
  return light;
}

/// What a stretch does in associated emission, its interval crossed from end to end. Seen from the end that is nearer
/// the depth is taken as d(x) = D x + e x (1 - x), which is exact where the way is straight, with e from its exact mean
/// r. Then the mean of 1 - exp(-d) is
///
///     P = r - (D^2 / 15 - D r / 10 + 3 r^2 / 5) + (D^3 / 24 + D^2 e / 40 + D e^2 / 120 + e^3 / 840) - D^4 / 120 + ...,
///
/// and the integral of x over what is absorbed is the opacity less P, or P where the slab falls. Off by at most
/// 5e-3 D^2 |g|, g being the bend of the way. No division, no node. IsFaint: of the third order in D only D^3 / 24
/// counts.
template <bool IsFaint>
StretchLight moment_light(const DiagonalStretch& stretch, const FloatLanes& rate, const FloatLanes& rate_difference) {
  const FloatLanes depth =
      multiply_add(rate_difference, FloatLanes(stretch.depth_difference), rate * stretch.depth_rate);
  const FloatLanes moment =
      multiply_add(rate_difference, FloatLanes(stretch.moment_difference), rate * stretch.depth_difference);
  const FloatLanes mean = stretch.falls ? moment : depth - moment;
  const FloatLanes second =
      multiply_add(mean, multiply_add(mean, FloatLanes(0.6F), depth * -0.1F), depth * depth * (1.0F / 15));
  // 1 - exp(-D)
  FloatLanes opacity(1.0F / 6);
  if constexpr (!IsFaint)
    opacity = multiply_add(depth, multiply_add(depth, FloatLanes(1.0F / 120), FloatLanes(-1.0F / 24)), opacity);
  opacity = multiply_add(depth, opacity, FloatLanes(-0.5F));
  opacity = depth * multiply_add(depth, opacity, FloatLanes(1.0F));
  if constexpr (IsFaint) {
    const FloatLanes absorbed = multiply_add(depth * depth, depth * (1.0F / 24), mean - second);
    return {opacity, opacity, stretch.falls ? absorbed : opacity - absorbed};
  }
  const FloatLanes bow = multiply_add(mean, FloatLanes(6.0F), depth * -3.0F);  // e
  FloatLanes third = multiply_add(depth, FloatLanes(1.0F / 24) - depth * (1.0F / 120), bow * (1.0F / 40));
  third = depth * third;
  third = multiply_add(bow, bow * (1.0F / 120), third);
  third = multiply_add(depth, third, bow * bow * bow * (1.0F / 840));
  const FloatLanes absorbed = mean - second + third;
  return {opacity, opacity, stretch.falls ? absorbed : opacity - absorbed};
}

/// SlabKernels::diagonal. Lanes are neighbouring slabs of the diagonal: what differs between them is where they read
/// the transfer function, and that is contiguous.
template <bool IsPlain>
void diagonal_lanes(const TransferEntries& transfer, const DiagonalSlabs& slabs, std::size_t first,
                    std::array<FloatLanes, 4>& result) {
  FloatLanes transmittance(1.0F);
  std::array<FloatLanes, 3> color{};
  for (std::size_t i = 0; i < slabs.stretch_count; ++i) {
    const DiagonalStretch& stretch = slabs.stretches[i];
    const auto at = static_cast<std::ptrdiff_t>(first) + stretch.entry;
    const FloatLanes rate = FloatLanes::load(transfer.rate + at);
    const FloatLanes rate_difference = FloatLanes::load(transfer.rate_difference + at);
    const DiagonalNode* const nodes = slabs.nodes + stretch.first_node;
    StretchLight light;
    if (!IsPlain && stretch.is_faint)
      light = moment_light<true>(stretch, rate, rate_difference);
    else if (!IsPlain && stretch.by_moments)
      light = moment_light<false>(stretch, rate, rate_difference);
    else if (stretch.is_thin)
      light = stretch_light<IsPlain, true>(stretch, nodes, rate, rate_difference);
    else
      light = stretch_light<IsPlain, false>(stretch, nodes, rate, rate_difference);
    const FloatLanes lower = transmittance * light.lower;
    const FloatLanes difference = transmittance * light.difference;
    for (std::size_t c = 0; c < 3; ++c) {
      color[c] = multiply_add(lower, FloatLanes::load(transfer.color[c] + at), color[c]);
      color[c] = multiply_add(difference, FloatLanes::load(transfer.color_difference[c] + at), color[c]);
    }
    transmittance = transmittance - transmittance * light.opacity;
  }
  for (std::size_t c = 0; c < 3; ++c) result[c] = color[c];
  result[3] = FloatLanes(1.0F) - transmittance;
}

inline void diagonal_slabs(const TransferEntries& transfer, const DiagonalSlabs& slabs, float* texels) {
  for (std::size_t first = 0; first < slabs.count; first += float_lane_count) {
    std::array<FloatLanes, 4> result;
    const auto run = slabs.is_plain ? diagonal_lanes<true> : diagonal_lanes<false>;
    run(transfer, slabs, slabs.first + first, result);
    alignas(64) std::array<std::array<float, float_lane_count>, 4> channels;
    for (std::size_t c = 0; c < 4; ++c) result[c].store(channels[c].data());
    const std::size_t used = std::min(float_lane_count, slabs.count - first);
    for (std::size_t lane = 0; lane < used; ++lane)
      for (std::size_t c = 0; c < 4; ++c) texels[slabs.stride * (first + lane) + c] = channels[c][lane];
  }
}

/// SlabKernels::diagonal_opacities.
inline void diagonal_opacities(const float* rates, const float* weights, std::size_t weight_count, std::size_t count,
                               float* opacities) {
  constexpr float log2_e = 0x1.715476p0F;
  for (std::size_t first = 0; first < count; first += float_lane_count) {
    // Two sums, for a product waits for the one before.
    FloatLanes even{};
    FloatLanes odd{};
    std::size_t k = 0;
    for (; k + 1 < weight_count; k += 2) {
      even = multiply_add(FloatLanes::load(rates + first + k), FloatLanes(weights[k]), even);
      odd = multiply_add(FloatLanes::load(rates + first + k + 1), FloatLanes(weights[k + 1]), odd);
    }
    if (k < weight_count) even = multiply_add(FloatLanes::load(rates + first + k), FloatLanes(weights[k]), even);
    alignas(64) std::array<float, float_lane_count> lanes;
    opacity_of<false>((even + odd) * log2_e).store(lanes.data());
    std::memcpy(opacities + first, lanes.data(), sizeof(float) * std::min(float_lane_count, count - first));
  }
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
