#include "kernels/kernels.hpp"

// A level's kernels, which version.cpp defines.
#define RAYTRUTH_DECLARE_KERNELS        \
  extern const Kernels<3> kernels_of_3; \
  extern const Kernels<9> kernels_of_9;

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

template <int Degree>
std::vector<const Kernels<Degree>*> find_versions() {
  const auto of_degree = [](const Kernels<3>& three, const Kernels<9>& nine) {
    if constexpr (Degree == 3)
      return &three;
    else
      return &nine;
  };
  std::vector<const Kernels<Degree>*> versions;
#ifdef RAYTRUTH_LEVELS
  // The features by which the x86-64 ABI defines its levels, as far as the compiler's code can meet them.
  const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool has_v4 = has_v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (has_v4) versions.push_back(of_degree(x86_64_v4::kernels_of_3, x86_64_v4::kernels_of_9));
  if (has_v3) versions.push_back(of_degree(x86_64_v3::kernels_of_3, x86_64_v3::kernels_of_9));
#endif
  versions.push_back(of_degree(baseline::kernels_of_3, baseline::kernels_of_9));
  return versions;
}

}  // namespace

template <int Degree>
const std::vector<const Kernels<Degree>*>& kernel_versions() {
  static const std::vector<const Kernels<Degree>*> versions = find_versions<Degree>();
  return versions;
}

template const std::vector<const Kernels<3>*>& kernel_versions<3>();
template const std::vector<const Kernels<9>*>& kernel_versions<9>();

}  // namespace raytruth
