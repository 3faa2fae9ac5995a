#pragma once

#include "gl/context.hpp"
#include "gl/device.hpp"

#include <memory>

namespace raytruth {

/// Passes in a context.
std::unique_ptr<GlDevice> make_passes(std::unique_ptr<GlContext> context);

}  // namespace raytruth
