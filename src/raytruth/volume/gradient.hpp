#pragma once

#include "raytruth/core/vector3.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace raytruth {

/// A way to take gradients of a grid at its voxels; outside the grid has the values of its border.
///
/// Along one axis (s(i+1) - s(i-1)) / 2, over the two others the mean of neighbours with weights 1, `weight`, 1.
/// `exaggeration` epsilon makes N + epsilon (N - N_m) of the unit gradient N, N_m the mean of the unit gradients of
/// the 5^3 voxels around (Guetat 2010, section 4, after Rusinkiewicz, Burns and DeCarlo 2006).
struct GradientFilter {
  std::string_view name;
  std::string_view summary;
  double weight;  ///< infinite: the voxel alone
  double exaggeration = 0;
};

/// A gradient between voxels.
struct Gradient {
  Vector3<double> raw = Vector3<double>::Zero();     ///< scalar per voxel: those at the voxels, interpolated
  Vector3<double> normal = Vector3<double>::Zero();  ///< unit: the unit ones at the voxels, interpolated and normalised
};

/// The gradient at voxel (i, j, k), scalar per voxel, without exaggeration.
Vector3<double> voxel_gradient(const Grid& grid, const GradientFilter& filter, std::int64_t i, std::int64_t j,
                               std::int64_t k);

/// The unit gradient at voxel (i, j, k), exaggerated; zero where the gradient is.
Vector3<double> voxel_normal(const Grid& grid, const GradientFilter& filter, std::int64_t i, std::int64_t j,
                             std::int64_t k);

/// The gradient at a position in voxel coordinates, trilinear between the eight voxels around it.
Gradient gradient_at(const Grid& grid, const GradientFilter& filter, const std::array<double, 3>& position);

namespace catalogue {

const std::vector<GradientFilter>& gradient_filters();

}  // namespace catalogue

}  // namespace raytruth
