#include "raytruth/kernels/kernels.hpp"
#include "raytruth/kernels/cell_kernels.hpp"
#include "raytruth/kernels/levels.hpp"
#include "raytruth/kernels/slab_kernels.hpp"
#include "raytruth/kernels/table_kernels.hpp"

// A level's kernels, which version.cpp defines.
#define RAYTRUTH_DECLARE_KERNELS               \
  extern const Kernels<3> kernels_of_3;        \
  extern const Kernels<9> kernels_of_9;        \
  extern const TableKernels kernels_of_tables; \
  extern const SlabKernels kernels_of_slabs;   \
  extern const CellKernels kernels_of_cells;

namespace raytruth {

inline namespace baseline {
RAYTRUTH_DECLARE_KERNELS
}
#ifdef RAYTRUTH_LEVELS
inline namespace x86_64_v3 {
RAYTRUTH_DECLARE_KERNELS
}
inline namespace x86_64_v4 {
RAYTRUTH_DECLARE_KERNELS
}
#endif

namespace {

/// The versions, of the three, that this processor can run, the best one first.
template <class Found>
std::vector<const Found*> find_versions(const Found& baseline_version, [[maybe_unused]] const Found* v3_version,
                                        [[maybe_unused]] const Found* v4_version) {
  std::vector<const Found*> versions;
#ifdef RAYTRUTH_LEVELS
  // The features by which the x86-64 ABI defines its levels, as far as the compiler's code can meet them.
  const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool has_v4 = has_v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (has_v4) versions.push_back(v4_version);
  if (has_v3) versions.push_back(v3_version);
#endif
  versions.push_back(&baseline_version);
  return versions;
}

#ifdef RAYTRUTH_LEVELS
#define RAYTRUTH_VERSIONS(kernels) find_versions(baseline::kernels, &x86_64_v3::kernels, &x86_64_v4::kernels)
#else
#define RAYTRUTH_VERSIONS(kernels) find_versions(baseline::kernels, {}, {})
#endif

constexpr std::array<std::string_view, 3> level_names{"baseline", "x86-64-v3", "x86-64-v4"};

}  // namespace

std::vector<std::string_view> compiled_levels() {
#ifdef RAYTRUTH_LEVELS
  return {level_names.rbegin(), level_names.rend()};
#else
  return {level_names.front()};
#endif
}

std::string_view level_in_use() { return *find_versions(level_names[0], &level_names[1], &level_names[2]).front(); }

template <>
const std::vector<const Kernels<3>*>& kernel_versions<3>() {
  static const auto versions = RAYTRUTH_VERSIONS(kernels_of_3);
  return versions;
}

template <>
const std::vector<const Kernels<9>*>& kernel_versions<9>() {
  static const auto versions = RAYTRUTH_VERSIONS(kernels_of_9);
  return versions;
}

const std::vector<const TableKernels*>& table_kernel_versions() {
  static const auto versions = RAYTRUTH_VERSIONS(kernels_of_tables);
  return versions;
}

const std::vector<const CellKernels*>& cell_kernel_versions() {
  static const auto versions = RAYTRUTH_VERSIONS(kernels_of_cells);
  return versions;
}

const std::vector<const SlabKernels*>& slab_kernel_versions() {
  static const auto versions = RAYTRUTH_VERSIONS(kernels_of_slabs);
  return versions;
}

}  // namespace raytruth
