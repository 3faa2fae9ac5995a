#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace raytruth {

/// What bands of diagonals are made of: n - 1 homogeneous intervals, an array for each of their properties, with
/// `padding` readable numbers before the first and behind the last of them.
struct TableIntervals {
  static constexpr std::size_t padding = 32;

  std::size_t count = 0;
  const float* rate = nullptr;          ///< tau log2(e), so that 1 - 2^(-rate length) is the opacity
  std::array<const float*, 4> color{};  ///< what the opacity is multiplied by to give light: RGB, and white
  float most_rate = 0;                  ///< the largest of them
  float length = 0;                     ///< of slabs
};

/// The inner loops of table builders, in the version for one level of x86-64.
struct TableKernels {
  /// Diagonals that are done side by side: the widths |j - i| of a band are neighbours.
  std::size_t band_width;
  /// The entries with first_width <= |j - i| < first_width + band_width on one side of the diagonal (`backwards`: i >
  /// j), into a table of shape (back, front, 4). `buffer` holds slab_floats * band_width floats for each entry of an
  /// axis, and for band_width more.
  void (*subranges)(const TableIntervals&, std::size_t first_width, bool backwards, float* buffer, float* const* table);
  static constexpr std::size_t slab_floats = 5;
  /// Those entries of four tables, of moments k = 0 to 3 (tables/moments.hpp), with `moment_floats`.
  void (*moments)(const TableIntervals&, std::size_t first_width, bool backwards, float* buffer, float* const* tables);
  static constexpr std::size_t moment_floats = 21;
};

/// The versions that this processor can run, the best one first.
const std::vector<const TableKernels*>& table_kernel_versions();

}  // namespace raytruth
