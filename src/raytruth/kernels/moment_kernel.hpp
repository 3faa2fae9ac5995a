#pragma once

#include "raytruth/kernels/band.hpp"

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Light in four channels, RGB and white, times powers 0 to 3 of its distance behind a bin's border, in units of the
/// lane's slabs, and opacity. Moments about one point add up; only what is written is moved, to the slab's front.
template <bool IsThin>
class MomentAlgebra {
 public:
  using State = std::array<FloatLanes, 17>;    ///< four channels of each moment, and the opacity
  using Crossing = std::array<FloatLanes, 4>;  ///< opacity, and moments 1 to 3 of an interval about its front
  // These are fewer than for one table: rows lie 4 KiB apart, and share few lines of the cache.
  static constexpr std::ptrdiff_t rows_ahead = 8;

  explicit MomentAlgebra(const FloatLanes& shares) {
    constexpr float ln_2 = 0x1.62e430p-1F;
    powers_[0] = FloatLanes(ln_2);
    for (std::size_t k = 1; k < 4; ++k) powers_[k] = powers_[k - 1] * shares;
  }

  /// y J_k(y) of tables/exponential_moments.hpp for the interval's depth y, in units of the slab.
  [[nodiscard]] Crossing crossing_of(const FloatLanes& t) const {
    const FloatLanes opacity = opacity_of<IsThin>(t);
    const FloatLanes y = t * powers_[0];
    const FloatLanes transmittance = FloatLanes(1.0F) - opacity;
    // The recurrence goes downwards from J_3 = sum of (-y)^m / (m! (m + 4)).
    FloatLanes third(series.back());
    for (std::size_t m = series.size() - 1; m-- > 0;) third = multiply_add(y, third, FloatLanes(series[m]));
    FloatLanes second = multiply_add(y, third, transmittance) * (1.0F / 3);
    FloatLanes first = multiply_add(y, second, transmittance) * 0.5F;
    if constexpr (!IsThin) {
      // The recurrence goes upwards where that loses little: errors grow by 3 / y at most.
      const FloatLanes inverse = FloatLanes::of(FloatLanes(1.0F).vector / y.vector);
      const FloatLanes first_up = (opacity * inverse - transmittance) * inverse;
      const FloatLanes second_up = (first_up + first_up - transmittance) * inverse;
      const FloatLanes third_up = (second_up * 3.0F - transmittance) * inverse;
      const auto is_thin = t.vector <= FloatLanes(most_t_of_series).vector;
      first.vector = is_thin ? first.vector : first_up.vector;
      second.vector = is_thin ? second.vector : second_up.vector;
      third.vector = is_thin ? third.vector : third_up.vector;
    }
    return {opacity, t * powers_[1] * first, t * powers_[2] * second, t * powers_[3] * third};
  }

  void put_in_front(State& state, const Crossing& crossing, const LaneInterval& interval) const {
    const FloatLanes transmittance = FloatLanes(1.0F) - crossing[0];
    const auto weights = moved_by(interval.position, crossing);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t c = 0; c < 4; ++c) {
        FloatLanes& moment = state[4 * k + c];
        moment = multiply_add(transmittance, moment, weights[k] * interval.color[c]);
      }
    state.back() = multiply_add(transmittance, state.back(), crossing[0]);
  }

  void put_behind(State& state, const Crossing& crossing, const LaneInterval& interval) const {
    const FloatLanes transmittance = FloatLanes(1.0F) - state.back();
    const auto weights = moved_by(interval.position, crossing);
    for (std::size_t k = 0; k < 4; ++k) {
      const FloatLanes seen = transmittance * weights[k];
      for (std::size_t c = 0; c < 4; ++c) {
        FloatLanes& moment = state[4 * k + c];
        moment = multiply_add(seen, interval.color[c], moment);
      }
    }
    state.back() = multiply_add(transmittance, crossing[0], state.back());
  }

  template <class Write>
  void texels(const State& before, const State& behind, const FloatLanes& distance, const Write& write) const {
    const FloatLanes transmittance = FloatLanes(1.0F) - before.back();
    std::array<LaneSlab, 4> about_front;
    for (std::size_t c = 0; c < 4; ++c) {
      std::array<FloatLanes, 4> about_border;
      for (std::size_t k = 0; k < 4; ++k)
        about_border[k] = multiply_add(transmittance, behind[4 * k + c], before[4 * k + c]);
      const auto moved = moved_by(distance, about_border);
      for (std::size_t k = 0; k < 4; ++k) about_front[k][c] = moved[k];
    }
    for (std::size_t k = 0; k < 4; ++k) write(k, about_front[k]);
  }

 private:
  /// Moments about a point that lies `distance` before the one they are given about, by Horner's scheme.
  static std::array<FloatLanes, 4> moved_by(const FloatLanes& distance, const std::array<FloatLanes, 4>& m) {
    const FloatLanes first = multiply_add(distance, m[0], m[1]);
    const FloatLanes twice = distance + distance;
    const FloatLanes thrice = twice + distance;
    const FloatLanes square = distance * distance;
    const FloatLanes second = multiply_add(square, m[0], multiply_add(twice, m[1], m[2]));
    const FloatLanes three_squares = thrice * distance;
    const FloatLanes third =
        multiply_add(square * distance, m[0], multiply_add(three_squares, m[1], multiply_add(thrice, m[2], m[3])));
    return {m[0], first, second, third};
  }

  // What the series leaves out is below 10^-7: y <= 0.35 for thin intervals, else 1.4.
  static constexpr float most_t_of_series = 2;
  static constexpr auto series = [] {
    std::array<float, IsThin ? 6 : 11> terms{};
    double factorial = 1;
    for (std::size_t m = 0; m < terms.size(); ++m) {
      if (m > 0) factorial *= -static_cast<double>(m);
      terms[m] = static_cast<float>(1 / (factorial * static_cast<double>(m + 4)));
    }
    return terms;
  }();

  std::array<FloatLanes, 4> powers_;  ///< of an interval's share of the slab, times ln 2
};

}  // namespace raytruth::inline RAYTRUTH_LEVEL
