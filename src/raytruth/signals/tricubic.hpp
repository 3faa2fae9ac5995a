#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/ray_displacement.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// The cubic kernels of a tricubic reconstruction.
enum class CubicKernel {
  bspline,      ///< smooth (C2), does not pass through its voxels unless they are prefiltered
  catmull_rom,  ///< passes through its voxels (C1); leaves their range by up to (1.25^3 - 1)/2 of it
};

/// What voxel `voxel` of the four around a cell (at -1, 0, 1, 2) adds to the Bernstein coefficient `coefficient` of the
/// kernel's cubic on the cell [0, 1].
template <class Real>
Real kernel_coefficient(CubicKernel kernel, std::size_t coefficient, std::size_t voxel) {
  // Numbers are sixths. B-spline: C. de Boor, A practical guide to splines; Catmull-Rom: Keys 1981 with a = -1/2.
  constexpr std::array<std::array<int, 4>, 4> bspline{{{1, 4, 1, 0}, {0, 4, 2, 0}, {0, 2, 4, 0}, {0, 1, 4, 1}}};
  constexpr std::array<std::array<int, 4>, 4> catmull_rom{{{0, 6, 0, 0}, {-1, 6, 1, 0}, {0, 1, 6, -1}, {0, 0, 6, 0}}};
  return Real((kernel == CubicKernel::bspline ? bspline : catmull_rom)[coefficient][voxel]) / 6;
}

/// The scalar along a ray through a tricubic reconstruction, exactly: a chain of polynomials of degree 9 with a break
/// at every border of a dual voxel.
///
/// On the box [p, q] that the ray's segment spans in a cell, the reconstruction is a tensor product of cubics with
/// Bernstein coefficients b_ijk, made axis by axis from the 4^3 voxels around the cell. On the box's diagonal the
/// products of Bernstein polynomials are Bernstein polynomials of degree 9, so
///     c_m = sum over i + j + k = m of binomial(3,i) binomial(3,j) binomial(3,k) / binomial(9,m) b_ijk:
/// a mean with positive weights. Neighbouring pieces meet to rounding. Clipping, clamping and errors are those of
/// `trace_trilinear`; for an interpolating B-spline pass the grid of `bspline_coefficients`.
void trace_tricubic(const Grid& grid, CubicKernel kernel, const Ray& ray, Chain<9>& chain,
                    Border border = Border::half_voxel);

/// Bounds as those of `trilinear_error`. `coefficient_error` bounds the error of each voxel of `grid`, for B-spline
/// coefficients that were made from others: `prefilter_error`. B-splines being means, the signal is off by no more.
SignalError tricubic_error(const Grid& grid, CubicKernel kernel, const Ray& ray, const Chain<9>& chain,
                           double coefficient_error = 0, const std::vector<bool>& is_needless = {},
                           const RayDisplacement& displacement = {}, Border border = Border::half_voxel);

/// As `trace_trilinear_precisely`, `coefficient_error` as above.
PreciseChain<9> trace_tricubic_precisely(const Grid& grid, CubicKernel kernel, const Ray& ray, double coefficient_error,
                                         const RayDisplacement& displacement = {}, Border border = Border::half_voxel);

/// The coefficients of the cubic B-spline that passes through the voxels of a clamped grid: on every line the
/// tridiagonal system (c_{i-1} + 4 c_i + c_{i+1}) / 6 = v_i with c_{-1} = c_0, c_n = c_{n-1}, axis after axis (M.
/// Unser, Splines: a perfect fit for signal and image processing, 1999).
Grid bspline_coefficients(const Grid& grid);

/// Bounds how far any of the `coefficients` is from those of the exact B-spline through `voxels`: the largest residual
/// |v - A_x A_y A_z c| of the systems above times 27, for |(A^-1 r)_i| <= 3 max |r|: where |x_i| is largest,
/// 6 |r_i| >= (4 - 1 - 1) |x_i|, or (5 - 1) |x_i| at the ends.
double prefilter_error(const Grid& voxels, const Grid& coefficients);

}  // namespace raytruth
