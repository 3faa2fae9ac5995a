#pragma once

#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/reference/surface_hits.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

inline constexpr std::string_view hit_vector_form = "hit_vectors/1";

/// A ray through voxels, which its polynomials are of: through the place origin + t direction, in voxels, so that t
/// counts lengths of the direction.
struct HitVolume {
  std::array<std::int64_t, 3> size{};
  std::vector<double> values;  ///< x fastest
  std::array<double, 3> origin{};
  std::array<double, 3> direction{};
};

/// A ray and the scalars of isosurfaces. Every number is exact in binary64, and so are the polynomials.
struct HitVector {
  std::string id;
  std::string_view level;
  std::vector<double> breaks;
  std::vector<std::vector<double>> coefficients;  ///< of piece i, in ascending powers of t - breaks[i]
  std::vector<double> scalars;                    ///< ascending
  std::optional<HitVolume> volume = {};
};

/// Levels of the hit vectors, from easy to hard.
std::vector<VectorLevel> hit_levels();

/// The vectors of a seed, level by level: the same bits on every machine.
std::vector<HitVector> hit_vectors(std::uint64_t seed);

/// All its crossings: the polynomials are known exactly, so nothing is unresolved.
SurfaceHits truth_of(const HitVector& vector);

/// The vectors of a seed with their certified hits, as experiments/schemas/hit_vectors.json describes them.
nlohmann::ordered_json hit_vectors_json(std::uint64_t seed);

}  // namespace raytruth
