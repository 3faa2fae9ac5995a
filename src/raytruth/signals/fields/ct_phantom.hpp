#pragma once

#include "raytruth/core/named.hpp"
#include "raytruth/signals/field_option.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <variant>

namespace raytruth {

/// A head as a CT scanner would store it, of size^3 voxels, values k / 255 for k = 0 ... 255: air, tissue, contrast
/// agent and bone are levels of a narrow histogram; a skull, walls thinner than a voxel and the scanner's bed are what
/// reconstruction blurs. `phantom_parts` says what it is made of.
///
/// A voxel holds what its parts fill of it (partial volume), convolved on each axis with
/// exp(-k^2 / (2 spread^2)), |k| <= ceil(4 spread), the outermost voxels continued, plus normal noise of the standard
/// deviation `noise`, rounded to 8 bits.
struct CtPhantom {
  static constexpr Named kind{"ct_phantom",
                              "a CT-like head of tissue, bone, vessels and thin walls, 8 bits, from a seed"};

  std::int64_t size = 64;
  double spread = 0.6;  ///< standard deviation of the point spread, in voxels
  double noise = 0.01;  ///< standard deviation, of values in [0, 1]
  std::uint64_t seed = 1;

  static constexpr auto options() {
    return std::tuple{FieldOption<CtPhantom, std::int64_t>{"size", &CtPhantom::size, 2, largest_generated_size},
                      FieldOption<CtPhantom, double>{"spread", &CtPhantom::spread, 0, 16},
                      FieldOption<CtPhantom, double>{"noise", &CtPhantom::noise, 0, 1}};
  }
};

// Parts of the phantom, in the cube [-1, 1]^3; each fills its place with its value, over what was there.

struct PhantomEllipsoid {
  std::array<double, 3> middle;
  std::array<double, 3> half;  ///< half axes
  double value;
};

/// Along z.
struct PhantomCylinder {
  std::array<double, 3> middle;
  double radius;
  double half_length;
  double value;
};

struct PhantomBox {
  std::array<double, 3> middle;
  std::array<double, 3> half;  ///< half sides
  double value;
};

using PhantomPart = std::variant<PhantomEllipsoid, PhantomCylinder, PhantomBox>;

/// The parts, each over those before it.
std::span<const PhantomPart> phantom_parts();

/// Throws FieldOptionError.
void check(const CtPhantom& phantom);
/// Makes the same bytes on any number of threads.
Grid make_grid(const CtPhantom& phantom);

}  // namespace raytruth
