#pragma once

#include "kernels/band.hpp"

namespace raytruth::inline RAYTRUTH_LEVEL {

/// Light in three channels and opacity, one slab over the other.
template <bool IsThin>
struct SlabAlgebra {
  using State = LaneSlab;

  explicit SlabAlgebra(const FloatLanes& /*shares*/) {}

  void put_in_front(State& slab, const LaneInterval& interval) const {
    const FloatLanes opacity = opacity_of<IsThin>(interval.t);
    const FloatLanes transmittance = FloatLanes(1.0F) - opacity;
    for (std::size_t c = 0; c < 3; ++c) slab[c] = multiply_add(transmittance, slab[c], opacity * interval.color[c]);
    slab[3] = multiply_add(transmittance, slab[3], opacity);
  }

  void put_behind(State& slab, const LaneInterval& interval) const {
    const FloatLanes seen = (FloatLanes(1.0F) - slab[3]) * opacity_of<IsThin>(interval.t);
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
