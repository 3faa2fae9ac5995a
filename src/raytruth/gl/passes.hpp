#pragma once

#include "raytruth/gl/context.hpp"
#include "raytruth/gl/device.hpp"

#include <memory>

namespace raytruth {

/// Passes in a context.
std::unique_ptr<GlDevice> make_passes(std::unique_ptr<GlContext> context);

}  // namespace raytruth
