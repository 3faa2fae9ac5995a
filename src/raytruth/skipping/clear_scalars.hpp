#pragma once

#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <vector>

namespace raytruth {

/// The scalars at which matter neither absorbs nor shines: extinction 0 and, for plain emission, colour 0.
class ClearScalars {
 public:
  ClearScalars(const PiecewiseLinear& transfer, Emission emission);

  /// Whether all scalars from low to high are clear.
  [[nodiscard]] bool contain(double low, double high) const;

 private:
  struct Interval {
    double low;
    double high;
  };
  std::vector<Interval> intervals_;  ///< closed, ascending, as long as they can be
};

}  // namespace raytruth
