#include "raytruth/rules/wgsl.hpp"

#include "raytruth/core/error.hpp"
#include "raytruth/rules/shader_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace raytruth {
namespace {

/// A function around statements.
std::string function(const std::string& body) { return "real f(real x, vec4 v, bool b) {\n  " + body + "\n}\n"; }

std::string translated(const std::string& body) {
  const std::string text = wgsl_of(function(body), "here");
  const std::string head = "fn f(x: f32, v: vec4f, b: bool) -> f32 {\n  ";
  EXPECT_TRUE(text.starts_with(head) && text.ends_with("\n}\n")) << text;
  return text.substr(head.size(), text.size() - head.size() - 3);
}

TEST(Wgsl, HasTheSameMeaning) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"return 1.0;", "return 1.0f;"},
      {"return 2.5e-4 * x;", "return 2.5e-4f * x;"},
      {"real y = x; return y;", "let y: f32 = x; return y;"},
      {"real y = x; y = 1.0; return y;", "var y: f32 = x; y = 1.0f; return y;"},
      {"vec4 w = v; w[3] = x; return w[3];", "var w: vec4f = v; w[3] = x; return w[3];"},
      {"return b ? x : 1.0;", "return select(1.0f, x, b);"},
      {"return b ? x : x > 0.0 ? 2.0 : 3.0;", "return select(select(3.0f, 2.0f, x > 0.0f), x, b);"},
      {"return x * (b ? x : -x);", "return x * (select(-x, x, b));"},
      {"if (b) return x;\n  return -x;", "if (b) { return x; }\n  return -x;"},
      {"if (b && x > 0.0 || x < -1.0) { return x; }\n  return 0.0;",
       "if ((b && x > 0.0f) || x < -1.0f) { return x; }\n  return 0.0f;"},
      {"int k = int(x) - 127; return float(k);", "let k: i32 = i32(x) - 127; return f32(k);"},
      {"return uintBitsToFloat(uint(int(x) + 1) << 23);", "return bitcast<f32>(u32(i32(x) + 1) << 23u);"},
      {"uint n = floatBitsToUint(x) + 0x1fu >> 3u; return x;",
       "let n: u32 = (bitcast<u32>(x) + 0x1fu) >> 3u; return x;"},
      {"as_written real y = x - (x - 1.0);  // why\n  return y;", "let y: f32 = x - (x - 1.0f);  // why\n  return y;"},
      {"return min(max(abs(x), 0.0), floor(sqrt(x)));", "return min(max(abs(x), 0.0f), floor(sqrt(x)));"},
      {"vec4 w = vec4(x, 0.0, 1.0, x) + v / 2.0; return w[0];",
       "let w: vec4f = vec4f(x, 0.0f, 1.0f, x) + v / 2.0f; return w[0];"},
  };
  for (const auto& [glsl, wgsl] : cases) EXPECT_EQ(translated(glsl), wgsl);
}

TEST(Wgsl, KeepsCommentsAndDropsWordsForTheCompilerOfGlsl) {
  EXPECT_EQ(
      wgsl_of("// One.\n#define real float\n#if X\n#define as_written\n#endif\n\n// Two.\nreal one() { return 1.0; }\n"
              "vec4 two() {\n  return vec4(one());  // both\n}\n// Three.\n",
              "here"),
      "// One.\n\n// Two.\nfn one() -> f32 { return 1.0f; }\nfn two() -> vec4f {\n  return vec4f(one());  // both\n}\n"
      "// Three.\n");
}

TEST(Wgsl, RefusesWhatItDoesNotKnow) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"for (int i = 0; i < 3; ++i) x;", "found for"},
      {"if (b) return x; else return -x;", "found else"},
      {"x = 1.0; return x;", "found x"},
      {"real y = x; y += 1.0; return y;", "found +="},
      {"return v.x;", "found ."},
      {"return v[int(x)];", "found int; a literal"},
      {"return mix(x, x, x);", "found mix"},
      {"return exp(x);", "found exp"},
      {"return g(x);", "found g"},
      {"real select = x; return select;", "found select"},
      {"real target = x; return target;", "found target"},
      {"real x = 1.0; return x;", "found x"},
      {"real y; return x;", "found ;; ="},
      {"return - -x == x == b ? x : x;", "found =="},
      {"return --x;", "found --"},
      {"return x << 2 << 3;", "found <<"},
      {"return uint(x) << uint(x);", "found uint"},
      {"return x & 1u;", "found &"},
      {"return x,", "found ,"},
      {"return .5;", "found ."},
      {"return 1.0f;", "found f"},
      {"mat4 m = mat4(1.0); return x;", "found mat4"},
      {"return x;\n}\nreal f(real x) {\n  return x;", "line 4: found f"},
      {"return x;\n}\nreal g(inout real x) {\n  return x;", "line 4: found inout"},
      {"return x;\n}\nreal g(real x) {\n  return h(x);", "line 5: found h"},
      {"return x;\n}\nuniform float u;\nreal g(real x) {\n  return x;", "line 4: found uniform"},
      {"return x;\n#define half 0.5", "line 3: found #define half 0.5"},
      {"return x;\n#include <a>", "line 3: found #include <a>"},
      {"#if A\n  return x;\n#else\n  return -x;\n#endif", "line 3: found return; no code between #if and #endif"},
  };
  for (const auto& [body, message] : cases) {
    try {
      ADD_FAILURE() << body << " became " << wgsl_of(function(body), "here");
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what() << "; " << message;
      EXPECT_TRUE(std::string(error.what()).starts_with("here: line ")) << error.what();
    }
  }
}

TEST(Wgsl, EndsWithAMessageWhereTheTextEnds) {
  for (const std::string text :
       {"real", "real f", "real f(", "real f(real x", "real f(real x) {", "real f(real x) { return x",
        "real f(real x) { real y =", "real f(real x) { if (", "real f(real x) { return x ?"})
    EXPECT_THROW(wgsl_of(text, "here"), InputError) << text;
}

TEST(ShaderText, IsThereInEveryLanguage) {
  for (const ShaderLanguageInfo& language : shader_languages())
    EXPECT_NE(shader_text(language.language).find("--language " + std::string(language.name)), std::string::npos);
}

}  // namespace
}  // namespace raytruth
