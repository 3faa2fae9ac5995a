#pragma once

#include "raytruth/kernels/table_kernels.hpp"
#include "raytruth/tables/discrete_transfer.hpp"

#include <array>
#include <vector>

namespace raytruth {

/// The intervals of a transfer function as kernels read them.
class IntervalArrays {
 public:
  IntervalArrays(const DiscreteTransfer& transfer, double length);

  /// Valid as long as this object.
  [[nodiscard]] TableIntervals view() const;

 private:
  std::array<std::vector<float>, 5> arrays_;  ///< rate, RGB and white
  std::size_t count_;
  float length_;
};

}  // namespace raytruth
