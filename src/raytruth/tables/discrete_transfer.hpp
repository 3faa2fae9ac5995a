#pragma once

#include "raytruth/rules/rules.hpp"
#include "raytruth/tables/table.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <vector>

namespace raytruth {

/// A transfer function as discrete builders see it: n entries, and n - 1 homogeneous intervals between neighbours,
/// which are crossed in equal times. An extinction may be infinite: alpha = 1, which no logarithm may meet.
struct DiscreteTransfer {
  std::vector<Optics> entries;    ///< what slabs hold whose front and back are one entry
  std::vector<Optics> intervals;  ///< interval k lies between entries k and k + 1
  Emission emission = Emission::associated;
};

/// An entry of a transfer function that states the opacity of a unit of length, 0 to 1.
struct OpacityEntry {
  double opacity = 0;
  Vector3<double> color = Vector3<double>::Constant(0);
};

/// Interval k holds what entry k does (nearest look-up, half-open ranges). Throws InputError for fewer than two
/// entries, opacities outside [0, 1], and colours that are negative or not finite.
DiscreteTransfer from_opacities(const std::vector<OpacityEntry>& entries);

/// The discrete transfer function whose entries are read at the table's scalars.
DiscreteTransfer sampled(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

/// Interval k holds the mean extinction between its entries, and the mean emission density over that extinction (for
/// plain emission the mean colour). Opacities are exact; colour is of second order in the interval's width where ranges
/// are long, of first order next to the table's diagonal, where an interval is a whole slab.
DiscreteTransfer interval_means(const PiecewiseLinear& transfer, const TableAxes& axes, Emission emission);

/// The transfer function with its extinction, but all colours white: what a highlight sees (Lum 2004, section 3). Plain
/// emission stays plain.
DiscreteTransfer whitened(DiscreteTransfer transfer);

/// A homogeneous stretch: C = A c (associated) or c length A / D (plain), A = 1 - exp(-D), D = tau length.
template <class Real>
typename Rules<Real>::vec4 homogeneous_stretch(const Optics& optics, Emission emission, const Real& length) {
  using vec4 = typename Rules<Real>::vec4;
  Rules<Real> rules;
  const vec4 color_and_extinction(Real(optics.color[0]), Real(optics.color[1]), Real(optics.color[2]),
                                  Real(optics.extinction));
  if (emission == Emission::plain) return rules.homogeneous_slab(color_and_extinction, length, false);
  // It does not go through q = tau c, which an opaque interval does not have.
  const Real opacity = rules.absorption(color_and_extinction[3] * length, false);
  vec4 slab = opacity * color_and_extinction;
  slab[3] = opacity;
  return slab;
}

}  // namespace raytruth
