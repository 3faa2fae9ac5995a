#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/render/pixel_light.hpp"
#include "raytruth/render/scene.hpp"
#include "raytruth/schemes/integral_scheme.hpp"
#include "raytruth/schemes/omissions.hpp"
#include "raytruth/schemes/optics_lookup.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/shading/lit_integral.hpp"
#include "raytruth/signals/point_gradient.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/tables/lit/moment_table.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// A pixel's ray as its lighting sees it: where its points lie, their normals, and light and viewer.
class LitView {
 public:
  LitView(const PointGradient& gradient, Border border, const SceneShading& shading, const PixelRay& pixel);

  [[nodiscard]] const Lighting& lighting() const { return lighting_; }

  /// The gradient, turned to where normals point; t in smallest spacings behind the ray's entry.
  [[nodiscard]] Vector3<double> gradient_at(double t) const;

  /// It over its length, or zero where the gradient is.
  [[nodiscard]] Vector3<double> normal_at(double t) const;

  /// The method's light from the normals at both ends of a slab: ambient light only where one of them is zero, or where
  /// they are antiparallel.
  [[nodiscard]] SlabLight slab_light(const SceneShading& shading, double begin, double end) const;

  /// The normal times the length of the gradient along a segment inside of one cell.
  [[nodiscard]] std::array<Bernstein<3>, 3> normals_along(double begin, double end) const;

 private:
  [[nodiscard]] std::array<double, 3> position(double t) const;

  PointGradient gradient_;
  const PixelRay& pixel_;
  double sign_;  ///< of the gradient in the normal
  double entry_;
  Lighting lighting_;
};

/// Throws InputError for schemes that cannot be lit, and for methods that they or the lighting cannot have.
void refuse_unlit(const Scene& scene);

/// The gradients that the scene's shading asks for; `field` is the scene's reconstruction.
template <class Field>
PointGradient gradient_of(const Scene& scene, const Field& field) {
  return {scene.grid, field.grid(), field.kind(), scene.shading->gradient};
}

/// A lit ray by the scene's scheme. The normal at a point is the gradient there (central differences at the voxels,
/// trilinearly interpolated, unless the scene says otherwise; per world length), normalised; where it is zero only
/// ambient light counts.
///
/// `reference`, and every other scheme without a method of shading, has this normal at every point. With a method it is
/// fetched at the samples only, and the light in between is the method's; a slab with a zero gradient at either end, or
/// with antiparallel normals, has ambient light only.
///
/// The signal is the exact one for `reference` and `cell_cubic`, what the scheme makes of its samples for ideal
/// schemes; both are integrated by LitIntegral. Sampled schemes light the samples that they look up, virtual ones with
/// the normals that the scene asks for. The radius is that
/// integral's sum of differences: an estimate of the quadrature's error, not a bound.
///
/// Holds buffers: one object per thread. Chains and samples have lengths in smallest spacings.
template <int Degree>
class ShadedRay {
 public:
  /// The scene must be one that `refuse_unlit` does not refuse.
  ShadedRay(const Scene& scene, const PointGradient& gradient);

  PixelLight operator()(const PixelRay& pixel, const Chain<Degree>& signal, const Samples<double>& samples,
                        const Omissions& omissions);

 private:
  /// Part of a polynomial piece inside of one segment of the ray.
  template <int AnyDegree>
  struct Part {
    Bernstein<AnyDegree> scalar;
    double begin;  ///< t
    double end;
  };

  template <int AnyDegree>
  PixelLight integrate(const LitView& view, const Chain<AnyDegree>& shape, const Chain<Degree>& signal,
                       const Samples<double>& samples, const Omissions& omissions, LitIntegral<AnyDegree>& integral);
  template <int AnyDegree, class LightSegment>
  LitSum add_segments(const Chain<AnyDegree>& shape, const std::vector<DoubleDouble>& borders,
                      const Omissions& omissions, const LightSegment& light_segment);
  template <int AnyDegree>
  void add_by_method(const LitView& view, double begin, double end, const std::vector<Part<AnyDegree>>& parts,
                     LitIntegral<AnyDegree>& integral, LitSum& sum);
  template <int AnyDegree>
  void add_pointwise(const LitView& view, const std::vector<Part<AnyDegree>>& parts, LitIntegral<AnyDegree>& integral,
                     LitSum& sum);
  PixelLight march_samples(const LitView& view, const Sampled& method, const Chain<Degree>& signal,
                           const Samples<double>& samples, const Omissions& omissions) const;

  const Scene& scene_;
  PointGradient gradient_;
  const IntegralScheme* scheme_;  ///< null: reference
  ClearScalars clear_;
  OpticsLookup<double> look_up_;
  LitIntegral<Degree> exact_;
  LitIntegral<3> approximate_;
  Chain<3> approximation_;
  std::vector<DoubleDouble> borders_;
};

}  // namespace raytruth
