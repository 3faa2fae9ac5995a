#include "experiments/measure.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <tbb/parallel_for.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_intervals = 1'000'000;

struct Options {
  std::int64_t intervals = 0;  ///< equal ones along a ray
  VectorForm form = VectorForm::first;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "intervals", "vectors"});
  Options options{.intervals = json.at("intervals").integer(1, most_intervals)};
  const auto vectors = json.find("vectors");
  if (vectors && vectors->word({vector_form_names.begin(), vector_form_names.end()}) == vector_form_names.back())
    options.form = VectorForm::second;
  return options;
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

struct Record {
  std::string scheme;
  std::int64_t intervals = 0;
  LevelScore score;
};

Columns<LevelScore> score_columns() {
  return {
      {.name = "level",
       .description = "of the conformance vectors; all: of all of them",
       .is_key = true,
       .cell = &LevelScore::level},
      {.name = "cases", .description = "vectors of the level", .cell = &LevelScore::cases},
      {.name = "answered", .description = "of them; no answer has no digits", .cell = &LevelScore::answered},
      {.name = "digits_min",
       .unit = "decimal digit",
       .description = "right in the worst answer",
       .cell = &LevelScore::digits_min},
      {.name = "digits_median",
       .unit = "decimal digit",
       .description = "right in the median answer",
       .cell = &LevelScore::digits_median},
      {.name = "worst", .description = "id of the vector with the worst answer", .cell = &LevelScore::worst},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "scheme", .description = "whose answers are scored", .is_key = true, .cell = &Record::scheme},
      {.name = "intervals",
       .description = "equal ones along a ray; a slab is one",
       .is_key = true,
       .cell = &Record::intervals},
  };
  append_part(columns, &Record::score, score_columns());
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  const auto vectors = conformance_vectors(experiment.seed, options.form);
  std::vector<ScoredVector> scored(vectors.size());
  tbb::parallel_for(std::size_t{0}, vectors.size(), [&](std::size_t i) {
    scored[i] = {vectors[i].id, std::string(vectors[i].level), truth_of(vectors[i]), std::nullopt};
  });
  std::vector<Record> records;
  for (const IntegralScheme* const scheme : schemes_of(experiment)) {
    tbb::parallel_for(std::size_t{0}, vectors.size(),
                      [&](std::size_t i) { scored[i].answer = answer_of(*scheme, vectors[i], options.intervals); });
    for (const LevelScore& level : score(scored)) records.push_back({scheme->name, options.intervals, level});
  }
  return records;
}

}  // namespace

extern const Measure conformance_measure;
const Measure conformance_measure{MeasureDefinition<Options, Record>{
    .name = "conformance",
    .summary = "digits that a scheme's answers to the conformance vectors have right",
    .needs = {.schemes = true},
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
