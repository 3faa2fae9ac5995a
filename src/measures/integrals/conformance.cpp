#include "experiments/measure.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <tbb/parallel_for.h>

namespace raytruth {

namespace {

constexpr std::int64_t most_intervals = 1'000'000;

std::int64_t read_intervals(const JsonReader& json) {
  json.only({"kind", "intervals"});
  return json.at("intervals").integer(1, most_intervals);
}

/// What the scheme answers to a vector; nothing if it refuses the samples.
std::optional<Answer> answer_of(const IntegralScheme& scheme, const ConformanceVector& vector, std::int64_t intervals) {
  const auto signal = signal_of(vector);
  Samples<double> samples;
  sample_constant(signal, vector.is_slab ? signal.length() : signal.length() / static_cast<double>(intervals), samples);
  const Outcome<> outcome = SchemeIntegral(vector.transfer, vector.emission)(scheme, signal, samples);
  if (!outcome.refusal.empty()) return std::nullopt;
  return Answer{outcome.color, outcome.opacity};
}

}  // namespace

std::vector<Column> conformance_columns(const Experiment& experiment, const JsonReader& options) {
  read_intervals(options);
  need_schemes(experiment);
  return {
      {.name = "scheme", .unit = "", .description = "whose answers are scored", .is_key = true},
      {.name = "intervals", .unit = "", .description = "equal ones along a ray; a slab is one", .is_key = true},
      {.name = "level", .unit = "", .description = "of the conformance vectors; all: of all of them", .is_key = true},
      {.name = "cases", .unit = "", .description = "vectors of the level"},
      {.name = "answered", .unit = "", .description = "of them; no answer has no digits"},
      {.name = "digits_min", .unit = "decimal digit", .description = "right in the worst answer"},
      {.name = "digits_median", .unit = "decimal digit", .description = "right in the median answer"},
      {.name = "worst", .unit = "", .description = "id of the vector with the worst answer"},
  };
}

std::vector<Row> conformance_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const std::int64_t intervals = read_intervals(options);
  const auto vectors = conformance_vectors(experiment.seed);
  std::vector<ScoredVector> scored(vectors.size());
  tbb::parallel_for(std::size_t{0}, vectors.size(), [&](std::size_t i) {
    scored[i] = {vectors[i].id, std::string(vectors[i].level), truth_of(vectors[i]), std::nullopt};
  });
  std::vector<Row> rows;
  for (const IntegralScheme* const scheme : schemes_of(experiment)) {
    tbb::parallel_for(std::size_t{0}, vectors.size(),
                      [&](std::size_t i) { scored[i].answer = answer_of(*scheme, vectors[i], intervals); });
    for (const LevelScore& level : score(scored))
      rows.push_back({{"scheme", scheme->name},
                      {"intervals", intervals},
                      {"level", level.level},
                      {"cases", level.cases},
                      {"answered", level.answered},
                      {"digits_min", level.digits_min},
                      {"digits_median", level.digits_median},
                      {"worst", level.worst}});
  }
  return rows;
}

}  // namespace raytruth
