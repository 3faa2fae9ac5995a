#pragma once

#include "raytruth/core/slab.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// The quadratic gray-value model of a slab (dissertation, section 5.3; rules/quadratic_gray.glsl has the formulas):
/// the parabola through its front, middle and back scalar,
///
///     h(z) = orientation z^2 + slope z + front,  0 <= z <= scaled_length,  z = t / radius,
///
/// where radius = 1 / sqrt|a| and a is the parabola's second divided difference, per squared length. Where a = 0 the
/// orientation is 0 and z is t.
struct QuadraticGray {
  double front = 0;
  double back = 0;
  double orientation = 0;    ///< sign of a
  double radius = 1;         ///< R
  double scaled_length = 1;  ///< D' = D / R
  double slope = 0;          ///< b' = b R

  static QuadraticGray of_curvature(double front, double back, double curvature, double length);
  static QuadraticGray of_samples(double front, double middle, double back, double length) {
    return of_curvature(front, back, Rules<double>{}.quadratic_gray_curvature(front, middle, back, length), length);
  }

  [[nodiscard]] double value(double z) const {
    return Rules<double>{}.quadratic_gray_value(front, slope, orientation, z);
  }
  /// M, inside the slab or not; the front's scalar where the model is linear.
  [[nodiscard]] double extremum() const { return Rules<double>{}.quadratic_gray_extremum(front, slope, orientation); }
  /// Whether h turns inside the slab: -2 D' < b' < 0 (a > 0), 0 < b' < 2 D' (a < 0).
  [[nodiscard]] bool turns() const { return orientation * slope < 0 && -orientation * slope < 2 * scaled_length; }
};

/// Where a slab passes from one interval of scalars to the next one.
struct QuadraticGrayCut {
  double z = 0;
  std::size_t interval = 0;  ///< the one behind it: that below scalar i is interval i
};

/// The cuts of a slab at these ascending scalars, by the closed form of h's inverse branches; the front comes first,
/// the back last, its interval without a meaning. `cuts` is overwritten and keeps its memory.
void cut(const QuadraticGray& slab, const std::vector<double>& scalars, std::vector<QuadraticGrayCut>& cuts);

/// A transfer function that is linear in extinction, by the intervals between its points: one before the first point,
/// one behind the last.
struct TransferIntervals {
  /// Optics there: value + slope (s - from).
  struct Interval {
    double from = 0;
    std::array<double, 3> color{};
    std::array<double, 3> color_slope{};
    double extinction = 0;
    double extinction_slope = 0;
  };

  /// Throws InputError for a transfer function that is linear in opacity.
  explicit TransferIntervals(const PiecewiseLinear& transfer);

  std::vector<double> scalars = {};  ///< where intervals meet
  std::vector<Interval> intervals = {};
};

/// Light by the gradient of the opacity, along which the normal is linear in z (dissertation, eqs. 5.3.16 to 5.3.20):
/// of
///
///     c(s) (d tau/ds)^slope_power w(z)^weight_power,  w linear from `front` to `back`,
///
/// w being N.L or N.H, or what a table holds of it: 1, z (0 to D'), or 1 + v z. It is the emission density as it
/// stands, whatever the transfer function's convention says. Corrected: the normal has the length 1, so that d tau/ds
/// counts by its sign alone (where it falls the normal points the other way), and the weight is clamped at 0 at every
/// point.
struct GradientLight {
  double slope_power = 1;
  double weight_power = 1;
  double front = 1;
  double back = 1;
  bool is_corrected = false;
};

/// Exact slabs of the model, in its own coordinate: z is cut where h meets the transfer function's points, by the
/// closed form of its inverse branches. Between two cuts tau(h(z)) is a parabola in z: the optical depth is exact, the
/// colour a Gauss-Legendre quadrature of 16 nodes whose parts are at most 2 deep. No singular weight 1 / (2 sqrt|s -
/// M|) is left. Errors are those of rounding, about 1e-14. Equals the slab of `order2`, which the certified reference
/// integrates.
///
/// For transfer functions that are linear in extinction. Holds buffers: one object per thread.
class QuadraticGraySlabs {
 public:
  using vec4 = Rules<double>::vec4;

  /// Throws InputError for a transfer function that is linear in opacity.
  QuadraticGraySlabs(const PiecewiseLinear& transfer, Emission emission);

  /// Light sent to the front, and opacity.
  vec4 operator()(const QuadraticGray& slab);

  /// The slab lit by the gradient of the opacity, and its opacity. Throws InputError where it is not defined: at jumps
  /// of the extinction that the slab crosses, and as printed for powers of negative slopes that are not whole.
  vec4 operator()(const QuadraticGray& slab, const GradientLight& light);

  /// omega = integral of tau(h(z)) over 0..D', so that the opacity is 1 - exp(-R omega).
  double omega(const QuadraticGray& slab);

 private:
  /// Sums up the light: `weight_at` gives what the colour is multiplied by to give the emission density at z; it may
  /// have a kink inside, else 0.
  template <class WeightAt>
  vec4 integrate(const QuadraticGray& slab, const WeightAt& weight_at, double kink = 0);

  TransferIntervals transfer_;
  std::vector<QuadraticGrayCut> cuts_;
  Emission emission_;
};

}  // namespace raytruth
