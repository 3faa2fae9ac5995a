#pragma once

#include "raytruth/kernels/float_lanes.hpp"
#include "raytruth/kernels/table_kernels.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Slabs side by side: light in three channels, and opacity.
using LaneSlab = std::array<FloatLanes, 4>;

/// Element I of the result is element Index(I) of a, or of b from float_lane_count on.
template <class Index, std::size_t... I>
FloatLanes shuffle(const FloatLanes& a, const FloatLanes& b, Index index, std::index_sequence<I...> /*lanes*/) {
  return FloatLanes::of(__builtin_shufflevector(a.vector, b.vector, static_cast<int>(index(I))...));
}

/// The place of a lane among texels that lie one behind the other, such that four channels become texels by few
/// shuffles: neighbouring lanes are a quarter of the texels apart.
constexpr std::size_t place_of(std::size_t lane) { return lane % 4 * (float_lane_count / 4) + lane / 4; }

/// 0, 1, 2, ... at the lanes' places.
inline FloatLanes::Bits lane_places() {
  FloatLanes::Bits places{};
  for (std::size_t lane = 0; lane < float_lane_count; ++lane) places[lane] = static_cast<std::int32_t>(place_of(lane));
  return places;
}

/// Neighbouring numbers, the first one at place 0.
inline FloatLanes load_in_places(const float* from) { return shuffled(FloatLanes::load(from), lane_places()); }

/// Writes the slabs as texels one behind the other, RGBA each, in the order of the lanes' places. A quarter is 128
/// bits, which hold a texel; the shuffles are those that processors have.
inline void store_texels(const LaneSlab& slab, float* to) {
  constexpr auto lanes = std::make_index_sequence<float_lane_count>{};
  // Takes two numbers of a and of b from every quarter: a b a b, from its lower half or from its upper one.
  const auto mix = [&](const FloatLanes& a, const FloatLanes& b, auto half) {
    return shuffle(
        a, b,
        [](std::size_t i) { return i / 4 * 4 + decltype(half)::value * 2 + i % 4 / 2 + i % 2 * float_lane_count; },
        lanes);
  };
  // Takes the lower (or upper) halves of a and of b from every quarter.
  const auto join = [&](const FloatLanes& a, const FloatLanes& b, auto half) {
    return shuffle(
        a, b,
        [](std::size_t i) { return i / 4 * 4 + decltype(half)::value * 2 + i % 2 + i % 4 / 2 * float_lane_count; },
        lanes);
  };
  constexpr std::integral_constant<std::size_t, 0> lower{};
  constexpr std::integral_constant<std::size_t, 1> upper{};
  const auto& [r, g, b, a] = slab;
  const FloatLanes rg_lower = mix(r, g, lower);
  const FloatLanes rg_upper = mix(r, g, upper);
  const FloatLanes ba_lower = mix(b, a, lower);
  const FloatLanes ba_upper = mix(b, a, upper);
  // Lanes k, k + 4, ... in the quarters of the k-th.
  join(rg_lower, ba_lower, lower).store(to);
  join(rg_lower, ba_lower, upper).store(to + float_lane_count);
  join(rg_upper, ba_upper, lower).store(to + 2 * float_lane_count);
  join(rg_upper, ba_upper, upper).store(to + 3 * float_lane_count);
}

/// Intervals of the transfer function as the lanes of a band see them.
struct LaneInterval {
  std::array<FloatLanes, 4> color;  ///< what the opacity is multiplied by to give light: RGB and white
  FloatLanes position;              ///< of its front behind a bin's border, in units of the lane's slabs
};

/// A band of diagonals: lane l has the width `first_width` + offset(l), so that the entries of a row, all of one back,
/// lie side by side in the order of the lanes' places. Intervals are counted in the order of crossing; backwards that
/// is from the last one down, and entry j in this order is entry count - j of the table.
///
/// Algebra is what slabs are made of: a State, an array of FloatLanes that begins with zeros; a Crossing, another one,
/// zeros for no interval: what exponentials are needed for, crossing_of(t) for an opacity 1 - 2^-t;
/// put_in_front(state, crossing, interval), put_behind(state, crossing, interval); texels(before, behind, distance,
/// write), which joins the parts before and behind a border, the first of which begins at that distance from it, and
/// gives a LaneSlab to write(k, slab) for table k.
template <class Algebra, bool IsBackwards>
class Band {
 public:
  Band(const TableIntervals& intervals, std::size_t first_width)
      : intervals_(intervals), first_width_(static_cast<std::ptrdiff_t>(first_width)) {
    std::array<float, float_lane_count> shares{};
    std::array<float, float_lane_count> offsets{};
    for (std::size_t lane = 0; lane < float_lane_count; ++lane) {
      offsets[lane] = static_cast<float>(offset(lane));
      shares[lane] = 1.0F / static_cast<float>(first_width + offset(lane));
    }
    shares_ = FloatLanes::load(shares.data());
    offsets_ = FloatLanes::load(offsets.data());
  }

  /// Works by subranges whose bins, of `first_width` intervals, all lanes share. The ranges that end in the row of
  /// entry j begin in lane l at j - first_width - offset(l); so the scan of the parts before a bin's border is skewed
  /// by the lanes, that of the parts behind it is not.
  /// Among the shortest ranges the scans to many borders meet the same interval: its exponentials are made once.
  void run(float* buffer, float* const* tables) const {
    using State = typename Algebra::State;
    using Crossing = typename Algebra::Crossing;
    constexpr auto floats = static_cast<std::ptrdiff_t>(std::tuple_size_v<State> * float_lane_count);
    constexpr auto crossing_floats = static_cast<std::ptrdiff_t>(std::tuple_size_v<Crossing> * float_lane_count);
    const Algebra algebra(shares_);
    const FloatLanes lengths = FloatLanes(intervals_.length) * shares_;
    const auto count = static_cast<std::ptrdiff_t>(intervals_.count);
    const std::ptrdiff_t bin = first_width_;
    const auto skewed_crossing = [&](std::ptrdiff_t x) {
      return algebra.crossing_of(load_in_places(intervals_.rate + skewed(x)) * lengths);
    };
    const bool keeps_crossings = bin < lanes;
    float* const crossings = buffer + (bin + 1) * floats;
    for (std::ptrdiff_t x = 0; keeps_crossings && x < count + lanes - 1; ++x)
      store(skewed_crossing(x), crossings + x * crossing_floats);
    for (std::ptrdiff_t border = bin - 1; border < count; border += bin) {
      // Step x holds the parts from x - offset(l) to the border, used in row x + bin.
      const std::ptrdiff_t last_used = border < count - bin ? border : count - bin;
      State before{};
      for (std::ptrdiff_t x = border + lanes - 1; x > border - bin; --x) {
        auto crossing = keeps_crossings ? load<Crossing>(crossings + x * crossing_floats) : skewed_crossing(x);
        if (x >= border) leave_out_behind(x - border, crossing);
        algebra.put_in_front(before, crossing, skewed_interval(x, border));
        if (x <= last_used) store(before, buffer + (x - (border - bin)) * floats);
      }
      State behind{};
      for (std::ptrdiff_t back = border + 1; back <= last_used + bin; ++back) {
        const std::ptrdiff_t k = IsBackwards ? count - back : back - 1;
        algebra.put_behind(behind, algebra.crossing_of(FloatLanes(intervals_.rate[k]) * lengths),
                           interval(k, back - 1 - border));
        algebra.texels(load<State>(buffer + (back - border) * floats), behind,
                       (FloatLanes(static_cast<float>(border + bin - back)) + offsets_) * shares_,
                       [&](std::size_t j, const LaneSlab& slab) { write(slab, back, tables[j]); });
      }
    }
  }

 private:
  static constexpr std::size_t texel_floats = 4 * float_lane_count;
  static constexpr std::ptrdiff_t rows_ahead = Algebra::rows_ahead;
  static constexpr std::size_t floats_of_line = 16;
  static constexpr auto lanes = static_cast<std::ptrdiff_t>(float_lane_count);

  static constexpr std::size_t offset(std::size_t lane) {
    return IsBackwards ? place_of(lane) : float_lane_count - 1 - place_of(lane);
  }

  // Register by register, and no loop: GCC keeps in memory what is copied as a whole, or met by a running index.
  template <class State>
  static void store(const State& state, float* to) {
#pragma GCC unroll 32
    for (std::size_t i = 0; i < state.size(); ++i) state[i].store(to + i * float_lane_count);
  }
  template <class State>
  static State load(const float* from) {
    State state;
#pragma GCC unroll 32
    for (std::size_t i = 0; i < state.size(); ++i) state[i] = FloatLanes::load(from + i * float_lane_count);
    return state;
  }

  /// Where intervals x - offset(l) begin, in the order of the lanes' places.
  [[nodiscard]] std::ptrdiff_t skewed(std::ptrdiff_t x) const {
    return IsBackwards ? static_cast<std::ptrdiff_t>(intervals_.count) - 1 - x : x - (lanes - 1);
  }
  [[nodiscard]] LaneInterval skewed_interval(std::ptrdiff_t x, std::ptrdiff_t border) const {
    LaneInterval result;
    for (std::size_t c = 0; c < 4; ++c) result.color[c] = load_in_places(intervals_.color[c] + skewed(x));
    result.position = (FloatLanes(static_cast<float>(x - border)) - offsets_) * shares_;
    return result;
  }

  /// Keeps only the intervals before the border: they are `steps` behind it, less the lane's offset.
  template <class Crossing>
  void leave_out_behind(std::ptrdiff_t steps, Crossing& crossing) const {
    for (FloatLanes& number : crossing)
      number = select(offsets_.vector > static_cast<float>(steps), number, FloatLanes(0.0F));
  }

  /// Interval k, the same in all lanes.
  [[nodiscard]] LaneInterval interval(std::ptrdiff_t k, std::ptrdiff_t behind_border) const {
    LaneInterval result;
    for (std::size_t c = 0; c < 4; ++c) result.color[c] = FloatLanes(intervals_.color[c][k]);
    result.position = FloatLanes(static_cast<float>(behind_border)) * shares_;
    return result;
  }

  /// Lanes whose front lies outside the table are left out.
  void write(const LaneSlab& slab, std::ptrdiff_t back, float* table) const {
    const auto count = static_cast<std::ptrdiff_t>(intervals_.count);
    const std::ptrdiff_t nearest = back - first_width_;  // front of offset 0
    const std::ptrdiff_t row = IsBackwards ? count - back : back;
    const std::ptrdiff_t column = IsBackwards ? count - nearest : nearest - (lanes - 1);
    float* const to = table + (row * (count + 1) + column) * 4;
    // Rows are too far apart for the processor to guess the next one.
    const float* const later = to + (IsBackwards ? -rows_ahead : rows_ahead) * (count + 2) * 4;
    for (std::size_t line = 0; line <= texel_floats; line += floats_of_line) __builtin_prefetch(later + line, 1);
    if (nearest >= lanes - 1) {
      store_texels(slab, to);
    } else {
      alignas(64) std::array<float, texel_floats> texels;
      store_texels(slab, texels.data());
      const std::ptrdiff_t first = IsBackwards ? 0 : lanes - 1 - nearest;
      for (std::ptrdiff_t lane = first; lane <= first + nearest; ++lane)
        std::memcpy(to + 4 * lane, texels.data() + 4 * lane, 4 * sizeof(float));
    }
  }

  TableIntervals intervals_;
  std::ptrdiff_t first_width_;
  FloatLanes shares_;  ///< of an interval in the lane's slabs
  FloatLanes offsets_;
};

/// Runs a band of Algebra<IsThin>, IsThin: every t is at most `thin_interval`.
template <template <bool> class Algebra>
void run_band(const TableIntervals& intervals, std::size_t first_width, bool backwards, float* buffer,
              float* const* tables) {
  const auto run = [&]<bool IsThin>() {
    if (backwards)
      Band<Algebra<IsThin>, true>(intervals, first_width).run(buffer, tables);
    else
      Band<Algebra<IsThin>, false>(intervals, first_width).run(buffer, tables);
  };
  if (intervals.most_rate * intervals.length <= thin_interval * static_cast<float>(first_width))
    run.template operator()<true>();
  else
    run.template operator()<false>();
}

}  // namespace raytruth::inline RAYTRUTH_LEVEL
