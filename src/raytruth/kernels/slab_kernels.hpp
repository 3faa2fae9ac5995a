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

/// Where a slab of a diagonal is integrated by a quadrature rule, for all of them the same.
struct DiagonalNode {
  float weight = 0;      ///< its share of the slab; for plain emission of its length
  float place = 0;       ///< in the interval of entries, 0 at the lower and 1 at the upper one
  float depth_rate = 0;  ///< what the lower entry's rate is multiplied by to give the depth from the stretch's front
  float depth_difference = 0;  ///< the same of the difference of the rates
};

/// A stretch of the slabs of a diagonal of a quadratic table that lies between two neighbouring entries.
struct DiagonalStretch {
  std::ptrdiff_t entry = 0;  ///< the lower one, counted from the slab's front
  float depth_rate = 0;
  float depth_difference = 0;
  std::size_t first_node = 0;
  std::size_t node_count = 0;
  bool is_thin = false;         ///< its depth in powers of two is at most 1/2 for every slab
  bool by_moments = false;      ///< thin, and from one of the entries to the other: no nodes are asked for
  bool is_faint = false;        ///< by moments, its depth at most 1/50
  bool falls = false;           ///< from the upper entry to the lower one
  float moment_difference = 0;  ///< by moments: what the difference of the rates is multiplied by to give that of x^2
};

/// Slabs whose ends are equally many entries apart and whose parabola is the same: they meet entries at the same
/// places.
struct DiagonalSlabs {
  const DiagonalStretch* stretches = nullptr;  ///< front to back
  std::size_t stretch_count = 0;
  const DiagonalNode* nodes = nullptr;
  std::size_t first = 0;   ///< entry of the first slab's front
  std::size_t count = 0;   ///< of slabs, each one's front one entry behind the last one's
  std::size_t stride = 4;  ///< floats from texel to texel
  bool is_plain = false;
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

  /// The slabs of a diagonal. Rates are tau length; entries are readable wherever stretches lead, and 16 behind.
  void (*diagonal)(const TransferEntries&, const DiagonalSlabs&, float* texels);

  /// Opacities of `count` slabs of a diagonal: 1 - exp(-sum_k weights[k] rates[i + k]). 16 readable rates follow.
  void (*diagonal_opacities)(const float* rates, const float* weights, std::size_t weight_count, std::size_t count,
                             float* opacities);
};

/// The versions that this processor can run, the best one first.
const std::vector<const SlabKernels*>& slab_kernel_versions();

}  // namespace raytruth
