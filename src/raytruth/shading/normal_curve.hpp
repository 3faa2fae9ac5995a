#pragma once

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace raytruth {

struct NormalCurve50;

/// A curve from the unit normal at the front of a slab to the one at its back: with w(s) the weight, s = 0 at the
/// front,
///
///     N(s) = w(1-s) N_f + w(s) N_b,
///
/// which every curve in the plane of the normals is that looks the same from both ends (mean_gradient and
/// quadratic_arc_printed do not meet the normals there). The formulas stand in src/raytruth/rules/normal_curves.glsl.
///
/// What is best among the polynomials of degree 3, to which one table per power of s belongs? Let 2a be the angle
/// between the normals, c = cos a, x = 2s-1, y = x^2. A cubic curve that meets the normals is, after averaging with its
/// mirror image and projecting on the plane, which both bring it no farther from a target that is symmetric and plane,
///
///     u = c + U (1-y) along the bisector,   v = x (sin a + V (1-y)) along the chord.
///
/// *Norm.* For U = 1 - c (u = 1 in the middle) and v0 = sin a + V,
///     u^2 + v^2 - 1 = y (1-y) (v0^2 - 2 (1-c) - (v0 - sin a)^2 y).
/// At every y this grows with v0 >= 0. If it has equal extremes of both signs, a larger v0 raises the upper one, a
/// smaller one deepens the lower one, so its maximum is least. y (1-y) (1/2 - y) has equal extremes, sqrt(3)/36 each;
/// v0^2 - 2 (1-c) = (v0 - sin a)^2 / 2 gives `circle_arc_tuned`: v0 / sin a = sqrt((6+2c)/(1+c)) - 1. The squared norm
/// deviates from 1 by sqrt(3)/36 (v0 - sin a)^2, at 90 degrees by 1.7e-4 (quadratic_arc: by up to 9.3e-2).
///
/// *Norm and direction together.* max_s |N(s) - target(s)| is the largest pointwise error of N.L over all directions of
/// the light. It is at least the largest distance E of u from the target's component along the bisector, g(y): c / rho
/// with rho^2 = c^2 + y sin^2 a for `normalized_linear`, cos(a sqrt(y)) for `slerp`. Both are convex in y, both are c
/// at y = 1 and 1 at y = 0, so E is least where the straight line c + U (1-y) is as far below g at y = 0 as it is above
/// g where it is farthest above: a larger U raises the latter, a smaller one deepens the former. That U is 1 - c -
/// kappa (1-c)^2, kappa -> 3/2 (3 - 2 sqrt 2) and (3 - 2 sqrt 2)/6 for small angles. V enters the distance squared as a
/// second term, which for V in an interval nowhere lifts it beyond E^2 (up to 135 degrees for normalized_linear;
/// beyond, the convex problem in U and V has its own minimum). `minimax_arc` and `minimax_circle_arc` fit kappa and V
/// by rational functions of 1 - c; the distance is within 2 % of the least one for angles up to 170 degrees, which a
/// test holds against lower bounds of the convex problem.
struct NormalCurve {
  std::string_view name;
  std::string_view summary;
  std::string_view source;
  /// w(s); `cosine` is that of the angle between the normals, in [-1, 1]. Not finite where the curve is singular.
  double (*weight)(double s, double cosine);
  const NormalCurve50* in_50_digits;  ///< the same in 50 digits (normal_curve50.hpp)
  /// N(s).V = a_0 + a_1 s + a_2 s^2 + a_3 s^3 from the normals' projections N_f.V and N_b.V; null if N is no
  /// polynomial.
  std::array<double, 4> (*coefficients)(double front, double back, double cosine);
  std::string_view color;   ///< of its line in plots
  std::string_view marker;  ///< of its points, as matplotlib names it
};

/// A vector in the plane of two unit normals: along their bisector, and along the chord from front to back.
template <class Real>
struct PlaneVector {
  Real bisector;
  Real chord;

  [[nodiscard]] Real norm() const {
    using std::sqrt;
    return sqrt(bisector * bisector + chord * chord);
  }

  /// The angle from the bisector, positive towards the back; radians.
  [[nodiscard]] Real direction() const {
    using std::atan2;
    return atan2(chord, bisector);
  }
};

/// |one - other|.
template <class Real>
Real between(const PlaneVector<Real>& one, const PlaneVector<Real>& other) {
  return PlaneVector<Real>{Real(one.bisector - other.bisector), Real(one.chord - other.chord)}.norm();
}

/// N(s) from the weights of the front and of the back normal, w(1-s) and w(s).
template <class Real>
PlaneVector<Real> plane_vector(const Real& front, const Real& back, const Real& cosine) {
  using std::sqrt;
  return {Real((front + back) * sqrt((1 + cosine) / 2)), Real((back - front) * sqrt((1 - cosine) / 2))};
}

/// N(s) of a curve.
inline PlaneVector<double> normal_at(const NormalCurve& curve, double s, double cosine) {
  return plane_vector<double>(curve.weight(1 - s, cosine), curve.weight(s, cosine), cosine);
}

namespace catalogue {

/// All of them, in the order of tables and plots; the reference is `normalized_linear`.
const std::vector<NormalCurve>& normal_curves();

}  // namespace catalogue

}  // namespace raytruth
