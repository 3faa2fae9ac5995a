#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// A level of the conformance vectors: its name, and what makes its vectors hard.
struct VectorLevel {
  std::string_view name;
  std::string_view why;
};

/// All levels, from easy to hard.
std::vector<VectorLevel> vector_levels();

/// A ray, or a slab: a ray along which the scalar is linear, from front to back. Every number is exact in binary32, and
/// the polynomials are exact in Bernstein form too, so that programs of any precision are asked the same.
struct ConformanceVector {
  std::string id;
  std::string_view level;
  bool is_slab;
  Emission emission;
  std::vector<double> breaks;                     ///< of the signal's pieces
  std::vector<std::vector<double>> coefficients;  ///< of piece i, in ascending powers of t - breaks[i]
  PiecewiseLinear transfer;
};

/// The vectors of a seed, level by level: the same bits on every machine.
std::vector<ConformanceVector> conformance_vectors(std::uint64_t seed);

/// The signal of a vector, exactly.
Chain<largest_degree> signal_of(const ConformanceVector& vector);

/// Its certified colour and opacity, by ball arithmetic in 128 bits: the nearest binary64 numbers or their neighbours,
/// the same on every processor.
Certified truth_of(const ConformanceVector& vector);

/// The vectors of a seed with their certified answers, as experiments/schemas/vectors.json describes them.
nlohmann::ordered_json vectors_json(std::uint64_t seed);

}  // namespace raytruth
