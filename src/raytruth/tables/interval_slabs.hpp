#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// A transfer function that is linear between points, cut at a table's scalars: what a slab does between two
/// neighbouring entries, exactly, for any length. The certified quadrature of reference/piece_integral.hpp does it,
/// eight parts side by side, so the error is about 1e-15.
class IntervalSlabs {
 public:
  using vec4 = Rules<double>::vec4;

  IntervalSlabs(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

  /// The slabs of all intervals when each is crossed in `length`, in the order of crossing: from entry 0 up, or
  /// `backwards` from the last entry down.
  [[nodiscard]] std::vector<vec4> operator()(double length, bool backwards) const;

 private:
  /// Part of an interval on which the transfer function is one function, from its lower end to its upper one.
  struct LinearPart {
    std::size_t interval = 0;
    double share = 0;  ///< of the interval's width
    std::array<Optics, 2> ends;
    std::array<double, 2> opacities;  ///< where they are what is linear
  };

  struct EightIntegrals;

  /// The integrals of eight parts, from `first` on in the order of crossing; the last one again where there are less.
  [[nodiscard]] EightIntegrals integrals_from(std::size_t first, double length, bool backwards) const;
  [[nodiscard]] const LinearPart& part(std::size_t i, bool backwards) const {
    return parts_[backwards ? parts_.size() - 1 - i : i];
  }

  std::vector<LinearPart> parts_;
  std::size_t intervals_;
  Emission emission_;
  double units_per_length_;  ///< 0: the extinction is linear
};

}  // namespace raytruth
