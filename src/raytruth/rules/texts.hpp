#pragma once

namespace raytruth {

/// Texts of the rules, which the build puts into the library as they are.

extern const char* const rule_prelude;  ///< of src/raytruth/rules/prelude.glsl
extern const char* const rule_texts;    ///< of the rules, in the order of rules.hpp

}  // namespace raytruth
