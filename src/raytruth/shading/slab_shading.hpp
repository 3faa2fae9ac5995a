#pragma once

#include "raytruth/shading/lighting.hpp"
#include "raytruth/shading/normal_curve.hpp"
#include "raytruth/shading/shaded_slab.hpp"
#include "raytruth/shading/slab_optics.hpp"
#include "raytruth/transfer/emission.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// All that the lighting of a slab depends on besides its optics.
struct SlabCosines {
  double light_front = 0;  ///< N_f.L
  double light_back = 0;   ///< N_b.L
  double half_front = 0;   ///< N_f.H
  double half_back = 0;    ///< N_b.H
  double normals = 1;      ///< N_f.N_b
};

SlabCosines cosines_of(const ShadedSlab& slab, const Lighting& lighting);

/// What lighting makes of a point of a slab, its coefficients left out.
struct LitPoint {
  double diffuse = 0;
  double specular = 0;
  double other_specular = 0;  ///< of two integrals the larger one counts (errata, Guetat 7)
};

/// What the specular term is multiplied by along the ray.
enum class SpecularDensity {
  white,    ///< the emission density of white matter
  colored,  ///< that of the matter itself
  none,     ///< 1: as printed in Guetat 2010, eq. 10, where empty space shines (errata, Guetat 8)
};

/// A method on one slab: the lighting along it.
struct SlabShader {
  std::function<LitPoint(double x, double extinction_slope)> at;
  /// Where in (0, 1) `at` is not smooth; found on demand, for it takes longer than `at`.
  std::function<std::vector<double>()> breaks = [] { return std::vector<double>(); };
  bool has_two_highlights = false;  ///< other_specular is a tent and not the same as specular
  SpecularDensity specular_density = SpecularDensity::white;
};

/// A method that lights a slab whose normals are known at its ends: a row of the catalogue.
struct Shading {
  std::string name;
  std::string summary;
  std::string source;
  /// Why the method cannot take this lighting; empty if it can.
  std::function<std::string_view(const Lighting&)> refusal;
  std::function<SlabShader(const SlabCosines&, const Lighting&)> shader;
  std::string_view color;         ///< of its line in plots
  std::string_view marker;        ///< of its points, as matplotlib names it
  bool needs_extinction = false;  ///< its light depends on the extinction's slope too
};

/// What the method makes of the slab: its shading, integrated with self-attenuation (`slab_integral`) to about 1e-14 of
/// the light there is, so that all its error is the shading's. The method must not refuse the lighting.
ShadedRadiance shade(const Shading& shading, const SlabCosines& cosines, const SlabOptics& optics, Emission emission,
                     const Lighting& lighting);

namespace catalogue {

/// One for every curve between normals, with the cosines treated at every point; then those that are more than a curve.
const std::vector<Shading>& shadings();

}  // namespace catalogue

}  // namespace raytruth
