#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/signals/border.hpp"
#include "raytruth/signals/precise_chain.hpp"
#include "raytruth/signals/ray.hpp"
#include "raytruth/signals/ray_displacement.hpp"
#include "raytruth/signals/signal_error_bound.hpp"
#include "raytruth/volume/grid.hpp"

namespace raytruth {

/// The scalar along a ray through a trilinearly reconstructed grid, exactly: a C0 chain of cubics with a break at every
/// border of a dual voxel, the cube between eight voxel centres (El Hajjar 2008, section 3.1).
///
/// A trilinear function f is affine in each coordinate, so it is the polar form of its own restriction to a segment
/// from p to q, whose Bernstein coefficients are therefore values of f at the corners of the box [p, q]:
///     b_0 = f(p_x, p_y, p_z)
///     b_1 = (f(q_x, p_y, p_z) + f(p_x, q_y, p_z) + f(p_x, p_y, q_z)) / 3
///     b_2 = (f(q_x, q_y, p_z) + f(q_x, p_y, q_z) + f(p_x, q_y, q_z)) / 3
///     b_3 = f(q_x, q_y, q_z).
/// Crossings and cell-local coordinates are carried in 106 bits, so the coefficients are those of the ray at its
/// rounded unit direction, to a few ulps of the largest voxel involved, at any distance; neighbouring pieces share
/// the bits of the value at their common border.
///
/// The field is clamped (as GL_CLAMP_TO_EDGE) and ends at [-1/2, n - 1/2] on every axis, or at [0, n - 1] (`border`);
/// how the ray is clipped to it, and what is refused (InputError), stands at `trace_cells`. `chain` is overwritten and
/// keeps its memory.
void trace_trilinear(const Grid& grid, const Ray& ray, Chain<3>& chain, Border border = Border::half_voxel);

/// The chain as a new one.
Chain<3> trace_trilinear(const Grid& grid, const Ray& ray, Border border = Border::half_voxel);

/// How far the chain of a ray may be from the signal along the ray at its exactly normalised direction: bounds for all
/// that is rounded in the unit vector, the entry, the breaks and the coefficients, made by computing the coefficients a
/// second time in 106 bits (`tracing_error`), in some five to ten times the chain's time. Beyond the field's end, where
/// a chain may reach by rounding, s is the clamped field's. Zero where all voxels in reach are equal. `is_needless`
/// marks pieces whose errors nobody asks for. `displacement`: the signal that is meant is that of a ray so far away.
SignalError trilinear_error(const Grid& grid, const Ray& ray, const Chain<3>& chain,
                            const std::vector<bool>& is_needless = {}, const RayDisplacement& displacement = {},
                            Border border = Border::half_voxel);

/// The ray at its exactly normalised direction in 106 bits, in some ten times the chain's time: at any distance of its
/// origin, and whatever is added to all voxels. Refusals are those of `trace_trilinear`.
PreciseChain<3> trace_trilinear_precisely(const Grid& grid, const Ray& ray, const RayDisplacement& displacement = {},
                                          Border border = Border::half_voxel);

}  // namespace raytruth
