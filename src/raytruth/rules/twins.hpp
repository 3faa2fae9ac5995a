#pragma once

#include "raytruth/core/real.hpp"
#include "raytruth/core/real50.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace raytruth {

/// What an argument of a local function is, and so the numbers on which its twins are compared.
enum class Domain {
  signal,   ///< a scalar of the signal, or its slope
  signals,  ///< a vec4 of them: coefficients, or a texel
  optics,   ///< a vec4: emission density and extinction
  slab,     ///< a vec4: colour and opacity
  width,    ///< of a slab
  depth,    ///< optical depth
  opacity,
  ratio,  ///< of two lengths
  unit,   ///< a place between two samples, or a weight
  split,  ///< a place between two samples, not too near to either
  is_linear,
  coordinate,  ///< normalised, of a texture
  position,    ///< the same in texels
  texel,       ///< the index of one
  size,        ///< number of texels
  levels,      ///< number of weights
  projection,  ///< of a unit vector on another one
  cosine,      ///< of the angle between two unit vectors that are not opposite
  shininess,   ///< of a highlight, also its exponent
  degree,      ///< of a highlight
};

struct DomainInfo {
  Domain domain;
  std::string_view name;
  std::string_view type;   ///< real, vec4 or bool
  std::string_view unit;   ///< empty: none
  std::string_view range;  ///< in which twins are compared at random
};

/// All domains.
std::span<const DomainInfo> domains();

const DomainInfo& info(Domain domain);

/// How many numbers an argument of this domain is.
std::size_t number_count(Domain domain);

/// Values of a local function, the first `result_count` in use.
template <class Real>
using TwinValues = std::array<Real, 4>;

/// A function of src/raytruth/rules that runs in every arithmetic and, by the same characters, in shaders: a row of
/// twins().
struct Twin {
  /// How far values may be apart, in units in the last place (see gl/twin_errors.hpp).
  struct Bounds {
    double gl = 0;        ///< GLSL from binary32
    double rounding = 0;  ///< binary32 from binary64 and, in its own last places, binary64 from 50 digits
  };

  std::string_view name;
  std::vector<Domain> arguments;
  Bounds bounds;
  std::size_t result_count;  ///< 1 for real, 4 for vec4
  std::function<TwinValues<Binary32>(std::span<const float>)> in_binary32;
  std::function<TwinValues<double>(std::span<const float>)> in_binary64;
  std::function<TwinValues<Real50>(std::span<const float>)> in_50_digits;
  /// The magnitude of what a value is a sum of, where terms may cancel: the last place is that of the larger of both.
  std::function<double(std::span<const float>, std::size_t component)> summand;
  /// Makes arguments drawn one by one agree with each other.
  std::function<void(std::span<float>)> reconcile;

  /// How many numbers its arguments are, of which the functions above read them.
  [[nodiscard]] std::size_t number_count() const;
};

/// How arguments are drawn.
enum class TwinInputs {
  random,       ///< in the range of their domain, evenly or evenly in their logarithm
  adversarial,  ///< zeros, denormals, huge numbers, ends of the range, in turn with all of a kind nearly equal
};

/// Arguments of the twin, drawn by seed and index alone, into numbers.size() = twin.number_count() places.
void draw_arguments(const Twin& twin, TwinInputs inputs, std::uint64_t seed, std::uint64_t index,
                    std::span<float> numbers);

namespace catalogue {

/// Every local function of src/raytruth/rules, in the order of rules.hpp.
const std::vector<Twin>& twins();

}  // namespace catalogue

}  // namespace raytruth
