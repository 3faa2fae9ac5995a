#pragma once

#include <string_view>
#include <vector>

namespace raytruth {

/// The levels of x86-64 for which the innermost loops are compiled, the best one first; "baseline" is what the compiler
/// was told for everything else.
std::vector<std::string_view> compiled_levels();

/// The one of them that runs on this processor.
std::string_view level_in_use();

}  // namespace raytruth
