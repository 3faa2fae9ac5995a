#include "raytruth/tables/discrete_transfer.hpp"

#include "raytruth/schemes/slab_integrals.hpp"
#include "raytruth/transfer/opacity_convention.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <utility>

namespace raytruth {

DiscreteTransfer from_opacities(const std::vector<OpacityEntry>& entries) {
  if (entries.size() < 2)
    throw InputError(fmt::format("found {} entries of a transfer function; 2 or more are allowed", entries.size()));
  DiscreteTransfer result;
  for (const auto& [opacity, color] : entries) {
    if (!(color >= 0).all() || !color.isFinite().all())
      throw InputError(
          fmt::format("found color [{}, {}, {}]; finite numbers >= 0 are allowed", color[0], color[1], color[2]));
    const double extinction = opacity == 1 ? std::numeric_limits<double>::infinity() : extinction_of(opacity, 1);
    result.entries.push_back({extinction, color});
  }
  result.intervals.assign(result.entries.begin(), result.entries.end() - 1);
  return result;
}

DiscreteTransfer sampled(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  check(axes);
  DiscreteTransfer result{.entries = {}, .intervals = {}, .emission = emission};
  for (std::size_t i = 0; i < axes.size; ++i) result.entries.push_back(transfer.at(axes.scalar(i)));
  result.intervals.assign(result.entries.begin(), result.entries.end() - 1);
  return result;
}

DiscreteTransfer interval_means(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission) {
  DiscreteTransfer result = sampled(transfer, axes, emission);
  for (std::size_t k = 0; k + 1 < axes.size; ++k) {
    const Bernstein<1> signal{{axes.scalar(k), axes.scalar(k + 1)}};
    const std::array interval{Piece<3>{0.0, 1, signal.elevated<3>()}};
    const auto mean = optics_integral(interval, transfer, emission);
    Optics& optics = result.intervals[k];
    optics = {mean[3], mean.head<3>()};
    // Where nothing absorbs nothing shines: any colour will do.
    if (emission == Emission::associated) optics.color /= mean[3] > 0 ? mean[3] : 1;
  }
  return result;
}

DiscreteTransfer whitened(DiscreteTransfer transfer) {
  for (auto* list : {&transfer.entries, &transfer.intervals})
    for (Optics& optics : *list) optics.color = Vector3<double>::Constant(1);
  return transfer;
}

}  // namespace raytruth
