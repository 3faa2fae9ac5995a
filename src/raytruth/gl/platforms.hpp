#pragma once

#include <string_view>
#include <vector>

namespace raytruth {

/// The platforms of OpenGL that this library was built with, as `--gl` calls them. Whether they come up shows when a
/// device is opened.
std::vector<std::string_view> compiled_gl_platforms();

}  // namespace raytruth
