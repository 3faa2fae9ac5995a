#include "raytruth/tables/interval_arrays.hpp"
#include "raytruth/transfer/emission.hpp"

#include <algorithm>
#include <numbers>

namespace raytruth {

// Plain light is (c / tau) times the opacity, however thin the interval.
constexpr double least_extinction = 1e-20;
constexpr double most_rate = 1e30;  // opaque at every length

IntervalArrays::IntervalArrays(const DiscreteTransfer& transfer, double length)
    : count_(transfer.intervals.size()), length_(static_cast<float>(length)) {
  constexpr std::size_t padding = TableIntervals::padding;
  for (auto& array : arrays_) array.assign(count_ + 2 * padding, 0);
  for (std::size_t k = 0; k < count_; ++k) {
    const auto& [stated, color] = transfer.intervals[k];
    const bool is_plain = transfer.emission == Emission::plain;
    const double extinction = is_plain ? std::max(stated, least_extinction) : stated;
    arrays_[0][padding + k] = static_cast<float>(std::min(extinction * std::numbers::log2e, most_rate));
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const double light = channel < 3 ? color[static_cast<Eigen::Index>(channel)] : 1;
      arrays_[1 + channel][padding + k] = static_cast<float>(is_plain ? light / extinction : light);
    }
  }
}

TableIntervals IntervalArrays::view() const {
  constexpr std::size_t padding = TableIntervals::padding;
  const auto first = [&](std::size_t array) { return arrays_[array].data() + padding; };
  return {.count = count_,
          .rate = first(0),
          .color = {first(1), first(2), first(3), first(4)},
          .most_rate = *std::max_element(arrays_[0].begin(), arrays_[0].end()),
          .length = length_};
}

}  // namespace raytruth
