#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/field_option.hpp"
#include "raytruth/volume/grid.hpp"

#include <cstdint>
#include <tuple>

namespace raytruth {

/// The density of an electron in an orbital of hydrogen, at size^3 nodes of the cube [-extent, extent]^3 around the
/// nucleus, over its largest value at a node: in [0, 1], nothing near the corners, lobes around nodal surfaces on which
/// it vanishes. The default is 3d_z2: two lobes and a ring.
struct HydrogenOrbital {
  static constexpr Named kind{"hydrogen_orbital",
                              "the electron's density in an orbital n, l, m of hydrogen, at n^3 nodes"};

  std::int64_t size = 64;
  std::int64_t n = 3;  ///< principal quantum number
  std::int64_t l = 2;  ///< of angular momentum, at most n - 1
  std::int64_t m = 0;  ///< of its component along z, at most l in magnitude
  double extent = 20;  ///< half the side of the cube, in Bohr radii

  static constexpr auto options() {
    return std::tuple{
        FieldOption<HydrogenOrbital, std::int64_t>{"size", &HydrogenOrbital::size, 2, largest_generated_size},
        FieldOption<HydrogenOrbital, std::int64_t>{"n", &HydrogenOrbital::n, 1, 12},
        FieldOption<HydrogenOrbital, std::int64_t>{"l", &HydrogenOrbital::l, 0, 11},
        FieldOption<HydrogenOrbital, std::int64_t>{"m", &HydrogenOrbital::m, -11, 11},
        FieldOption<HydrogenOrbital, double>{"extent", &HydrogenOrbital::extent, 0.1, 1000}};
  }
};

/// The probability density at a place relative to the nucleus, in Bohr radii a, per a^3; its integral over space is 1:
///     |psi|^2 = (2/n)^3 (n-l-1)! / (2n (n+l)!) exp(-rho) rho^(2l) L(rho)^2 Y(cos theta)^2,  rho = 2 r / n,
/// L the associated Laguerre polynomial of degree n-l-1 and order 2l+1, and
///     Y^2 = (2l+1)/(4 pi) (l-|m|)! / (l+|m|)! P(cos theta)^2,  P the associated Legendre function of l and |m|.
/// (L. D. Landau and E. M. Lifshitz, Quantum mechanics, section 36.) It does not depend on the angle around z.
double hydrogen_density(const HydrogenOrbital& orbital, double x, double y, double z);

/// Throws FieldOptionError.
void check(const HydrogenOrbital& orbital);
Grid make_grid(const HydrogenOrbital& orbital);

}  // namespace raytruth
