#pragma once

#include "raytruth/core/named.hpp"

#include <array>
#include <optional>
#include <string>

namespace raytruth {

/// Where along a ray the signal is read.
struct Sampling {
  std::string kind;            ///< of catalogue::samplings
  std::optional<double> step;  ///< voxels; for `constant`
};

namespace catalogue {

inline constexpr std::array samplings{
    Named{"cells", "at every border of the signal's pieces and at the midpoint of each"},
    Named{"constant", "at t = 0, h, 2h, ... and at the end"},
};

}  // namespace catalogue

}  // namespace raytruth
