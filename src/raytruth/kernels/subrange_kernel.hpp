#pragma once

#include "raytruth/kernels/band.hpp"

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Light in three channels and opacity, one slab over the other.
template <bool IsThin>
struct SlabAlgebra {
  using State = LaneSlab;
  using Crossing = std::array<FloatLanes, 1>;  ///< opacity
  static constexpr std::ptrdiff_t rows_ahead = 24;

  explicit SlabAlgebra(const FloatLanes& /*shares*/) {}

  [[nodiscard]] Crossing crossing_of(const FloatLanes& t) const { return {opacity_of<IsThin>(t)}; }

  void put_in_front(State& slab, const Crossing& crossing, const LaneInterval& interval) const {
    const FloatLanes& opacity = crossing[0];
    const FloatLanes transmittance = FloatLanes(1.0F) - opacity;
    for (std::size_t c = 0; c < 3; ++c) slab[c] = multiply_add(transmittance, slab[c], opacity * interval.color[c]);
    slab[3] = multiply_add(transmittance, slab[3], opacity);
  }

  void put_behind(State& slab, const Crossing& crossing, const LaneInterval& interval) const {
    const FloatLanes seen = (FloatLanes(1.0F) - slab[3]) * crossing[0];
    for (std::size_t c = 0; c < 3; ++c) slab[c] = multiply_add(seen, interval.color[c], slab[c]);
    slab[3] = slab[3] + seen;
  }

  template <class Write>
  void texels(const State& before, const State& behind, const FloatLanes& /*distance*/, const Write& write) const {
    const FloatLanes transmittance = FloatLanes(1.0F) - before[3];
    LaneSlab slab;
    for (std::size_t c = 0; c < 4; ++c) slab[c] = multiply_add(transmittance, behind[c], before[c]);
    write(0, slab);
  }
};

}  // namespace raytruth::inline RAYTRUTH_LEVEL
