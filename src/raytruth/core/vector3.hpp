#pragma once

#include <Eigen/Core>

namespace raytruth {

/// Three linear-light channels; arithmetic is per channel, as GLSL's vec3.
template <class Real>
using Vector3 = Eigen::Array<Real, 3, 1>;

}  // namespace raytruth
