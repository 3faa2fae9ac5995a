#pragma once

#include "raytruth/deformation/lattice.hpp"
#include "raytruth/deformation/ray_equations.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace raytruth {

/// The degree of an arc's polynomials.
inline constexpr std::size_t arc_degree = 11;

/// A part of a deformed ray in one cell of the lattice: its local coordinates as polynomials of xi in [-1, 1].
///
/// The curve of dx/dr = h(x) = grad f_1 x grad f_2 (RayEquations) is analytic in a cell. Its series about a point x_0,
/// to which Newton's steps bring f_1 = f_2 = 0, follows coefficient by coefficient: those of h up to k give that of x
/// of k + 1. It is certified afterwards, as what it is, polynomials: with c = h(x_0) / |h(x_0)|, to every xi belongs
/// one point x* of the true curve in the plane across c through x(xi).
///
/// * |x - x*| <= 2 |f| |A| / (c . h), A the matrix of grad f_1 and grad f_2 in that plane, whose determinant is c . h:
///   Newton's and Kantorovich's theorem, where 4 |f| |A|^2 max |f''| <= (c . h)^2, which is checked;
/// * the r of x* and xi differ by the factor c . x' / (c . h(x*)).
///
/// The bounds are sums of the magnitudes of coefficients, with what the products of series leave out.
struct DeformedArc {
  std::array<std::array<double, arc_degree + 1>, 3> local{};  ///< x, y, z in powers of xi
  double scale = 0;                                           ///< r by xi
  Eigen::Vector3d along = Eigen::Vector3d::Zero();            ///< c
  double off = 0;                                             ///< bound of |x - x*|, in local coordinates
  double rate_error = 0;                                      ///< relative bound of dr
  bool is_certified = false;

  [[nodiscard]] Eigen::Vector3d value(double xi) const;
  [[nodiscard]] Eigen::Vector3d derivative(double xi) const;
};

/// Makes arcs of one ray in one cell.
class CellCurve {
 public:
  CellCurve(const RayEquations& equations, const LatticeCell& cell);

  /// The arc about the point of the curve nearest to `middle`, from -r to r.
  [[nodiscard]] DeformedArc arc(Eigen::Vector3d middle, double r) const;

  /// How long r may be about `middle` for the last terms of the series of h to be of this relative size.
  [[nodiscard]] double reach(const DeformedArc& arc, double relative) const;

  /// dx/dr.
  [[nodiscard]] Eigen::Vector3d direction(const Eigen::Vector3d& local) const;
  /// The curve's point at r from one of its points, about (a step of fourth order, then Newton's).
  [[nodiscard]] Eigen::Vector3d step(const Eigen::Vector3d& from, double r) const;
  /// The point of the curve that Newton's steps across it lead to.
  [[nodiscard]] Eigen::Vector3d onto_curve(Eigen::Vector3d local) const;

 private:
  struct Jet {
    std::array<double, 2> value;
    std::array<Eigen::Vector3d, 2> gradient;
  };
  [[nodiscard]] Jet jet(const Eigen::Vector3d& local) const;

  std::array<CellFunction, 2> functions_;
  std::array<double, 2> size_{};  ///< of f_1 and f_2 in the cell, the magnitudes of all powers
  double bends_ = 0;              ///< of both, the root of the sum of squares of second derivatives there
};

}  // namespace raytruth
