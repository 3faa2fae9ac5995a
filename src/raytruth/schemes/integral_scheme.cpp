#include "raytruth/schemes/integral_scheme.hpp"

#include <array>

namespace raytruth {

std::string_view family(const IntegralScheme& scheme) {
  constexpr std::array<std::string_view, std::variant_size_v<Method>> names{"sampled",    "ideal", "no_attenuation",
                                                                            "iterations", "exact", "exact"};
  return names[scheme.method.index()];
}

bool is_exact(const IntegralScheme& scheme) {
  return std::holds_alternative<Ideal>(scheme.method) || std::holds_alternative<CellCubic>(scheme.method) ||
         std::holds_alternative<CellAdaptive>(scheme.method);
}

}  // namespace raytruth
