#pragma once

#include <string>
#include <string_view>

namespace raytruth {

/// WGSL of functions that are written as the rules are, in the subset of GLSL that they share with C++: `real`, vec4,
/// bool, int and uint; declarations with a value, assignments, `if` and `return`; arithmetic, comparisons, `?:`, `[i]`
/// with a literal, and calls of functions that stand before or that both languages have. Comments are kept.
///
/// Everything else is refused rather than guessed at: loops, `else`, swizzles, overloads, inout parameters, `+=`,
/// assignments to parameters, names that WGSL keeps for itself. `name` is what the text is called in errors.
/// Throws InputError, with the line, what was found and what is allowed.
std::string wgsl_of(std::string_view glsl, std::string_view name);

}  // namespace raytruth
