#pragma once

#include "raytruth/core/chain.hpp"
#include "raytruth/core/vector3.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// The forms of the vectors. The second has all vectors of the first, bit for bit, and behind them those of levels that
/// the first does not know.
enum class VectorForm { first, second };

inline constexpr std::array<std::string_view, 2> vector_form_names{"vectors/1", "vectors/2"};

/// A level of the conformance vectors: its name, and what makes its vectors hard.
struct VectorLevel {
  std::string_view name;
  std::string_view why;
};

/// All levels of a form: those of the first from easy to hard, and behind them those that the second adds.
std::vector<VectorLevel> vector_levels(VectorForm form = VectorForm::second);

/// A transfer function as renderers hold it: colours in one list, extinctions or opacities in another, each linear
/// between its own points. Two points at one s are a jump, as in PiecewiseLinear.
struct SeparateLists {
  struct Color {
    double s;
    Vector3<double> color;
  };
  struct Density {
    double s;
    double value;  ///< an extinction, or an opacity
  };
  std::vector<Color> colors;
  std::vector<Density> densities;
  double unit_length = 0;  ///< that opacities are of; 0: extinctions
};

/// Both lists as one, with points at every s of either.
PiecewiseLinear joined(const SeparateLists& lists);

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
  std::optional<SeparateLists> lists;  ///< that `transfer` is joined from
};

/// The vectors of a seed, level by level: the same bits on every machine.
std::vector<ConformanceVector> conformance_vectors(std::uint64_t seed, VectorForm form = VectorForm::second);

/// What a vector asks, as experiments/schemas/vectors.json describes it, without the reference.
nlohmann::ordered_json question_json(const ConformanceVector& vector);

/// The scalars at the ends of `intervals` equal intervals along a ray, of one along a slab.
std::vector<double> samples_of(const ConformanceVector& vector, std::int64_t intervals);

/// What a program that has only these samples can know: the ray or slab that is linear between them.
ConformanceVector sampled(const ConformanceVector& vector, const std::vector<double>& samples);

/// The signal of a vector, exactly.
Chain<largest_degree> signal_of(const ConformanceVector& vector);

/// Its certified colour and opacity, by ball arithmetic in 128 bits: the nearest binary64 numbers or their neighbours,
/// the same on every processor.
Certified truth_of(const ConformanceVector& vector);

/// The vectors of a seed with their certified answers, as experiments/schemas/vectors.json describes them.
nlohmann::ordered_json vectors_json(std::uint64_t seed, VectorForm form = VectorForm::second);

/// Such a document of vectors that were made of those of the seed.
nlohmann::ordered_json vectors_json(std::uint64_t seed, VectorForm form, const std::vector<ConformanceVector>& vectors);

}  // namespace raytruth
