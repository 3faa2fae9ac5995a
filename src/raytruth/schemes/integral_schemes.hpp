#pragma once

#include "raytruth/schemes/integral_scheme.hpp"

#include <vector>

namespace raytruth::catalogue {

/// From samples and a transfer function to colour and opacity. A name that stands among the `Schemes` too is that of
/// the ideal pre-integration of their signal.
const std::vector<IntegralScheme>& integral_schemes();

}  // namespace raytruth::catalogue
