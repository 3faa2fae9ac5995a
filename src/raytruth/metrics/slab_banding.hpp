#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace raytruth {

/// What of an image's values follows the place of a surface in its slab of the ray: stripes at slabs' borders.
struct SlabBanding {
  double share = 0;          ///< of the variance about smooth values: 0: none, 1: all; of noise about 0, or just below
  double amplitude = 0;      ///< root mean square of what follows the place
  double jump = 0;           ///< root mean square of the change from the back of a slab to the front of the next
  std::int64_t windows = 0;  ///< in which this can be told
};

/// Slabs of equal lengths cut a surface along the curves on which its depth is a whole number of slabs, so what they
/// make of it is a function of the depth's fraction phi. In a window of side x side pixels values are fitted, by least
/// squares, with a smooth part, all quadratics of column and row, and with the polynomials of degree 1 to 5 of phi:
///
///     share = 1 - (squares left by both / degrees of freedom) / (squares left by the smooth part / degrees of
///     freedom),
///
/// summed over windows, which overlap by half. It does not depend on how large values are, noise has none of it, and
/// smooth values and stripes that do not keep to the slabs (those of the voxels) have none. amplitude^2 is what both
/// mean squares differ by. The jump is that of the fitted polynomial, its variance by noise taken off.
///
/// `values` and `depths` row by row, `size` columns and rows; depths in slabs from where samples begin, not a number
/// where there is no surface. A pixel counts where its depth is less than half a slab from those of its four
/// neighbours: else stripes are narrower than two pixels. A window counts where half of its pixels do, and where smooth
/// functions cannot do for phi: the least eigenvalue of the mean products of phi's normalised polynomials, smooth parts
/// taken off, is above 1/4 (1 for phases that are equally frequent and independent of the place; below for less than
/// some two slabs).
///
/// None if no window counts. Throws InputError for a side below 8, or an image smaller than a window.
std::optional<SlabBanding> slab_banding(const std::vector<double>& values, const std::vector<double>& depths,
                                        const std::array<std::int64_t, 2>& size, std::int64_t side);

}  // namespace raytruth
