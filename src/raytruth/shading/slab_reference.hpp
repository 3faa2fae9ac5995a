#pragma once

#include "raytruth/core/bernstein.hpp"
#include "raytruth/shading/lighting.hpp"
#include "raytruth/shading/shaded_slab.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <array>
#include <cstdint>

namespace raytruth {

/// What a slab sends to its front if its normal is the normalised linear interpolation N(x) of the two normals,
///
///     ambient  = K_a integral_0^D q T dt
///     diffuse  = K_d integral_0^D q n(N.L) T dt
///     specular = K_s integral_0^D e h(n(N.H)) T dt,
///
/// with x = t/D, the scalar linear in x, n the treatment of negative cosines, h the highlight, q = tau c and e = tau
/// (associated) or q = c and e = 1 (plain), T the transmittance up to t. By ball arithmetic in 128 bits, as
/// `arb_integral`: the transfer function is cut at its points, the cosines where they change their sign and where the
/// highlight begins, all isolated as roots of polynomials of degree 1 or 2; between the cuts everything is analytic.
/// Vectors are used as given. A radius above `tolerance` max(1, largest colour, length for `plain`) makes the status
/// not_converged. Throws InputError as `check` does.
CertifiedRadiance slab_reference(const ShadedSlab& slab, const PiecewiseLinear& transfer, Emission emission,
                                 const Lighting& lighting, double tolerance = 1e-13);

/// Coefficients of a cubic in x.
using Cubic = std::array<double, 4>;

/// What a slab sends to its front if its cosines N.L and N.H are given cubics; they stand for themselves, so the
/// normals of `slab` do not count.
CertifiedRadiance cubic_reference(const ShadedSlab& slab, const PiecewiseLinear& transfer, Emission emission,
                                  const Lighting& lighting, const Cubic& light_cosine, const Cubic& half_cosine,
                                  double tolerance = 1e-13);

/// What a piece of a ray sends to its front if its scalar is a cubic in x and its normal the normalised vector of three
/// other ones: the lit truth of one cell. Where the vector is zero, nothing is known of its direction, and the radius
/// is infinite.
CertifiedRadiance gradient_reference(const Bernstein<3>& scalar, double length,
                                     const std::array<Bernstein<3>, 3>& gradient, const PiecewiseLinear& transfer,
                                     Emission emission, const Lighting& lighting, double tolerance = 1e-13);

}  // namespace raytruth
