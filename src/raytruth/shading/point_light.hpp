#pragma once

#include "raytruth/shading/gooch.hpp"
#include "raytruth/shading/lighting.hpp"
#include "raytruth/shading/slab_shading.hpp"

#include <optional>

namespace raytruth {

/// Light that a unit of length sends out at a point: matter q + white e + bare, q the matter's emission density, e that
/// of white matter (tau, or 1 for plain emission).
struct PointLight {
  double matter = 0;
  Vector3<double> white = Vector3<double>::Constant(0);
  double bare = 0;
};

/// Turns what lighting makes of a point's cosines into light: K_a + K_d n(N.L) and K_s h(n(N.H)) (Blinn and Phong), or
/// Gooch's tones, which take the cosine as it is. The specular density is that of the shading method.
class LightModel {
 public:
  LightModel(const Lighting& lighting, const std::optional<Gooch>& gooch, SpecularDensity density)
      : ambient_(lighting.ambient),
        diffuse_(lighting.diffuse),
        specular_(lighting.specular),
        density_(density),
        is_gooch_(gooch.has_value()) {
    if (!gooch) return;
    const double cool = gooch->diffuse * gooch->cool_share;
    const double warm = gooch->diffuse * gooch->warm_share;
    ambient_ = (cool + warm) / 2;
    diffuse_ = (cool - warm) / 2;
    specular_ = 0;
    tone_ = (gooch->cool + gooch->warm) / 2;
    tone_change_ = (gooch->cool - gooch->warm) / 2;
  }

  [[nodiscard]] PointLight operator()(double diffuse, double specular) const {
    PointLight light{.matter = ambient_ + diffuse_ * diffuse};
    if (is_gooch_)
      light.white = tone_ + diffuse * tone_change_;
    else if (density_ == SpecularDensity::white)
      light.white.setConstant(specular_ * specular);
    else if (density_ == SpecularDensity::colored)
      light.matter += specular_ * specular;
    else
      light.bare = specular_ * specular;
    return light;
  }

  /// Where there is no normal only ambient light counts: of Gooch's tones the middle one.
  [[nodiscard]] PointLight without_normal() const { return (*this)(0, 0); }

 private:
  double ambient_;
  double diffuse_;
  double specular_;
  SpecularDensity density_;
  bool is_gooch_;
  Vector3<double> tone_ = Vector3<double>::Constant(0);
  Vector3<double> tone_change_ = Vector3<double>::Constant(0);
};

}  // namespace raytruth
