#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raytruth {

/// A table of slabs as rays read it: shape (back, front, 4), C order.
struct SlabTable {
  const float* texels = nullptr;
  std::size_t size = 0;  ///< of either axis, at least 2
  float scale = 1;       ///< a scalar times this, plus `offset`, is its place in entries; clamped to the ends
  float offset = 0;
};

/// A transfer function at the entries of a table and linear in between, an array for each property; 16 readable numbers
/// follow the last of them.
struct TransferEntries {
  std::size_t count = 0;
  const float* rate = nullptr;             ///< extinction, in the unit that the kernel asks for
  const float* rate_difference = nullptr;  ///< of the next entry from this one
  std::array<const float*, 3> color{};
  std::array<const float*, 3> color_difference{};
  float most_rate = 0;  ///< the largest of the rates
};

/// The steps of a slab whose scalar is a parabola: weights of its three scalars at each.
struct SecondOrderSteps {
  std::size_t count = 0;
  const float* front_weight = nullptr;
  const float* middle_weight = nullptr;
  const float* back_weight = nullptr;
  bool is_thin = false;  ///< no rate exceeds 1/2
};

/// Neighbouring slabs of second order whose scalars are parabolas open downwards, 2 middle >= lower + upper, one in
/// each lane: by entries of the transfer function.
struct ParabolaRow {
  std::ptrdiff_t lower = 0;      ///< end of lane 0
  std::ptrdiff_t direction = 1;  ///< of the next lane's, 1 or -1
  std::ptrdiff_t middle = 0;
  std::ptrdiff_t upper = 0;  ///< end of all lanes
};

/// The inner loops of renderers that read tables of slabs, and of tables of second order, in the version for one level
/// of x86-64.
struct SlabKernels {
  /// Composites `slabs` slabs of four rays, looked up bilinearly between consecutive scalars. `scalars` has those of
  /// the rays side by side, slabs + 1 times four; `rays` becomes colour and opacity of one ray behind the other.
  void (*march_four)(const SlabTable&, const float* scalars, std::size_t slabs, float* rays);

  /// The slabs of second order of all front entries at one middle and one back entry, homogeneous steps front to back,
  /// into a row of RGBA; scalars beyond the entries are clamped to them. Rates are tau log2(e) times a step, so that
  /// the opacity of a step is 1 - 2^-rate.
  void (*second_order_row)(const TransferEntries&, const SecondOrderSteps&, std::size_t middle, std::size_t back,
                           float* row);

  std::size_t parabola_lanes;
  /// The exact slabs of second order of a row: RGBA of all lanes from the lower end to the upper one, and back.
  /// Rates are 2 tau length. Lanes whose lower end is not an entry, or above the upper end, or whose parabola is open
  /// upwards hold anything. Returns those that are too deep between two entries to be done here, a bit for each.
  std::uint32_t (*parabolas)(const TransferEntries&, const ParabolaRow&, float* rising, float* falling);
};

/// The versions that this processor can run, the best one first.
const std::vector<const SlabKernels*>& slab_kernel_versions();

}  // namespace raytruth
