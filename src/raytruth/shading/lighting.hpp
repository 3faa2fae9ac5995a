#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/core/vector3.hpp"
#include "raytruth/shading/highlight.hpp"

#include <cmath>

namespace raytruth {

/// What becomes of a cosine below 0, at every point and before anything else is made of it.
enum class Negative {
  clamp,   ///< max(0, x)
  mirror,  ///< |x|: the surface is lit from both sides
  none,    ///< x
};

/// Ambient, diffuse and specular light from one direction, Blinn and Phong's. The highlight does not depend on N.L.
struct Lighting {
  Vector3<double> light{0, 0, 1};  ///< L, a unit vector
  Vector3<double> half{0, 0, 1};   ///< H, a unit vector half-way between light and viewer
  double ambient = 0;              ///< K_a
  double diffuse = 1;              ///< K_d
  double specular = 0;             ///< K_s
  double shininess = 20;           ///< n >= 1
  const Highlight* highlight = find_named(catalogue::highlights(), "lobe");
  Negative negative = Negative::clamp;

  [[nodiscard]] bool is_lobe() const { return highlight->degree == 0; }
};

/// Larger ones are refused: a highlight a thousandth of a radian wide.
inline constexpr double largest_shininess = 1e6;

/// Throws InputError unless light and half are unit vectors, the coefficients >= 0, the shininess at least 1 and, for
/// `none`, whole.
void check(const Lighting& lighting);

/// A lighting as functions of cosines, its coefficients left out.
class Illumination {
 public:
  explicit Illumination(const Lighting& lighting)
      : highlight_(lighting.highlight),
        negative_(lighting.negative),
        shininess_(lighting.shininess),
        exponent_(highlight_->degree == 0 ? shininess_ : highlight_->exponent(shininess_)) {}

  [[nodiscard]] double diffuse(double cosine) const {
    if (negative_ == Negative::clamp) return cosine > 0 ? cosine : 0;
    return negative_ == Negative::mirror ? std::abs(cosine) : cosine;
  }

  /// A lobe whose negative cosines stay has negative powers; all other highlights are clamped at 0.
  [[nodiscard]] double specular(double cosine) const {
    if (is_plain_power()) return std::pow(cosine, shininess_);
    return highlight_->value_at_exponent(diffuse(cosine), exponent_);
  }

  /// Whether the highlight is a power of the cosine, smooth everywhere.
  [[nodiscard]] bool is_plain_power() const { return negative_ == Negative::none && highlight_->degree == 0; }

  /// Before it is clamped at 0 the highlight is (1 + slope (cosine - 1))^power.
  [[nodiscard]] double slope() const { return highlight_->degree == 0 ? 1 : exponent_ / highlight_->degree; }

  /// Where the highlight begins.
  [[nodiscard]] double threshold() const { return 1 - 1 / slope(); }

 private:
  const Highlight* highlight_;
  Negative negative_;
  double shininess_;
  double exponent_;  ///< of the highlight's family
};

}  // namespace raytruth
