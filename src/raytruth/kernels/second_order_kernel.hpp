#pragma once

#include "raytruth/kernels/float_lanes.hpp"
#include "raytruth/kernels/slab_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace raytruth::inline RAYTRUTH_LEVEL {

inline FloatLanes::Bits lane_indices(const FloatLanes& x) {
  return __builtin_convertvector(x.vector, FloatLanes::Bits);
}

inline FloatLanes clamped(const FloatLanes& x, const FloatLanes& low, const FloatLanes& high) {
  const auto above = x.vector > low.vector ? x.vector : low.vector;
  return FloatLanes::of(above < high.vector ? above : high.vector);
}

/// Neighbouring front entries in lanes. In one step their scalars differ by at most one entry from lane to lane, since
/// the front's weight (1 - t)(1 - 2t) lies in [-1/8, 1]: so all of them are among as many neighbouring entries of the
/// transfer function as there are lanes, which are read at once and permuted, not gathered. IsThin: no step's t exceeds
/// `thin_interval`.
template <bool IsThin>
void second_order_lanes(const TransferEntries& transfer, const SecondOrderSteps& steps, float front, float middle,
                        float back, std::array<FloatLanes, 4>& slab) {
  const auto last = static_cast<float>(transfer.count - 1);
  const FloatLanes fronts =
      FloatLanes(front) + FloatLanes::of(__builtin_convertvector(lane_numbers(), FloatLanes::Vector));
  FloatLanes transmittance(1.0F);
  std::array<FloatLanes, 3> color{};
  for (std::size_t k = 0; k < steps.count; ++k) {
    const float rest = steps.middle_weight[k] * middle + steps.back_weight[k] * back;
    const float front_weight = steps.front_weight[k];
    const FloatLanes at =
        clamped(multiply_add(FloatLanes(front_weight), fronts, FloatLanes(rest)), FloatLanes(0.0F), FloatLanes(last));
    const FloatLanes::Bits entry = lane_indices(at);
    const std::int32_t first = std::min(entry[0], entry[float_lane_count - 1]);
    const FloatLanes weight = at - FloatLanes::of(__builtin_convertvector(entry, FloatLanes::Vector));
    const FloatLanes::Bits inside = entry - first;
    const auto read = [&](const float* values, const float* differences) {
      return multiply_add(weight, shuffled(FloatLanes::load(differences + first), inside),
                          shuffled(FloatLanes::load(values + first), inside));
    };
    const FloatLanes t = read(transfer.rate, transfer.rate_difference);
    const FloatLanes absorbed = transmittance * opacity_of<IsThin>(t);
    transmittance = transmittance - absorbed;
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = multiply_add(absorbed, read(transfer.color[c], transfer.color_difference[c]), color[c]);
  }
  for (std::size_t c = 0; c < 3; ++c) slab[c] = color[c];
  slab[3] = FloatLanes(1.0F) - transmittance;
}

/// SlabKernels::second_order_row.
inline void second_order_row(const TransferEntries& transfer, const SecondOrderSteps& steps, std::size_t middle,
                             std::size_t back, float* row) {
  for (std::size_t front = 0; front < transfer.count; front += float_lane_count) {
    std::array<FloatLanes, 4> slab;
    const auto run = steps.is_thin ? second_order_lanes<true> : second_order_lanes<false>;
    run(transfer, steps, static_cast<float>(front), static_cast<float>(middle), static_cast<float>(back), slab);
    alignas(64) std::array<std::array<float, float_lane_count>, 4> channels;
    for (std::size_t c = 0; c < 4; ++c) slab[c].store(channels[c].data());
    const std::size_t used = std::min(float_lane_count, transfer.count - front);
    for (std::size_t lane = 0; lane < used; ++lane)
      for (std::size_t c = 0; c < 4; ++c) row[4 * (front + lane) + c] = channels[c][lane];
  }
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
