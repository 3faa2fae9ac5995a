#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/signals/field_option.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>
#include <tuple>

namespace raytruth {

/// The test signal of S. R. Marschner and R. J. Lobb, An evaluation of reconstruction filters for volume rendering,
/// 1994, on [-1, 1]^3, values in [0, 1]:
///     rho = (1 - sin(pi z / 2) + alpha (1 + cos(2 pi f_M cos(pi r / 2)))) / (2 (1 + alpha)),  r = sqrt(x^2 + y^2),
/// f_M = 6, alpha = 1/4. It is separable, g(z) + h(x, y): along any ray the cubic term of its trilinear reconstruction
/// vanishes, so that second-order schemes that sample every cell are exact on it and it must not be the only test.
double marschner_lobb(double x, double y, double z);

/// The signal at `samples`^3 nodes 2 i / (samples - 1) - 1.
struct SampledMarschnerLobb {
  static constexpr Named kind{"marschner_lobb", "the Marschner-Lobb signal sampled at n^3 nodes"};

  std::int64_t samples = 41;  ///< as in the original

  static constexpr auto options() {
    return std::tuple{FieldOption<SampledMarschnerLobb, std::int64_t>{"samples", &SampledMarschnerLobb::samples, 2,
                                                                      largest_generated_size}};
  }
};

/// Throws FieldOptionError.
void check(const SampledMarschnerLobb& field);
Grid make_grid(const SampledMarschnerLobb& field);

inline Grid sampled_marschner_lobb(std::int64_t samples) { return make_grid(SampledMarschnerLobb{.samples = samples}); }

/// The signal itself along a ray in its own coordinates, cut to [-1, 1]^3, as a chain that meets it to rounding
/// (`expand`); t = 0 where the ray enters, or at an origin inside. Throws InputError as `trace_trilinear` does.
Chain<9> trace_marschner_lobb(const Ray& ray);

/// The signal itself along a ray, not expanded: cut to [-1, 1]^3 as `trace_marschner_lobb` does.
struct MarschnerLobbRay {
  Ray ray;
};

}  // namespace raytruth
