#include "experiments/measure.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/documents/conformance/outside_answers.hpp"
#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/documents/conformance/vectors_score.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_intervals = 1'000'000;

/// What answers are compared with: the true ray, or, of a method that samples it, the true answer for the signal that
/// is linear between the samples. The difference of the two is the samples' fault; the rest is the integrator's.
enum class Against { ray, samples };

constexpr std::array<std::string_view, 2> against_names{"ray", "samples"};

std::string_view name_of(Against against) { return against_names[static_cast<std::size_t>(against)]; }

struct Options {
  std::int64_t intervals = 0;  ///< equal ones along a ray
  VectorForm form = VectorForm::first;
  std::optional<Emission> emission = {};  ///< of the vectors that are asked; none: all
  std::vector<Against> against{Against::ray};
  bool tells_errors = false;  ///< and what is compared with: "against" is stated
};

std::vector<Against> read_against(const JsonReader& json) {
  std::vector<Against> found;
  for (const JsonReader& item : json.items()) {
    const std::string word = item.word({against_names.begin(), against_names.end()});
    const auto against = word == name_of(Against::ray) ? Against::ray : Against::samples;
    if (std::find(found.begin(), found.end(), against) != found.end()) item.refuse_value("each word once");
    found.push_back(against);
  }
  return found;
}

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "intervals", "vectors", "emission", "against"});
  Options options{.intervals = json.at("intervals").integer(1, most_intervals)};
  const auto vectors = json.find("vectors");
  if (vectors && vectors->word({vector_form_names.begin(), vector_form_names.end()}) == vector_form_names.back())
    options.form = VectorForm::second;
  if (const auto emission = json.find("emission"))
    options.emission = emission->word({"associated", "plain"}) == "plain" ? Emission::plain : Emission::associated;
  if (const auto against = json.find("against")) {
    options.against = read_against(*against);
    options.tells_errors = true;
  }
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
  Against against = Against::ray;
  LevelScore score = {};
  std::optional<std::string> version = {};  ///< of a program
  std::optional<std::string> why = {};      ///< a program is refused
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

Columns<LevelScore> error_columns() {
  return {
      {.name = "color_error_max",
       .description = "largest absolute error of a channel of an answer's colour",
       .cell = [](const LevelScore& score) { return score.color.error_max; }},
      {.name = "opacity_error_max",
       .description = "largest absolute error of an answer's opacity",
       .cell = [](const LevelScore& score) { return score.opacity.error_max; }},
      {.name = "error_mean",
       .description = "mean over the answers of the larger one of both errors",
       .cell = &LevelScore::error_mean},
  };
}

Columns<Record> columns(const Experiment& experiment, const Options& options) {
  Columns<Record> columns{
      {.name = "scheme", .description = "whose answers are scored", .is_key = true, .cell = &Record::scheme},
      {.name = "intervals",
       .description = "equal ones along a ray; a slab is one",
       .is_key = true,
       .cell = &Record::intervals},
  };
  if (options.tells_errors)
    columns.push_back({.name = "against",
                       .description = "ray: the certified answer of the vector; samples: that of the signal which is "
                                      "linear between the samples, so that what is left is the integrator's",
                       .is_key = true,
                       .cell = [](const Record& record) { return name_of(record.against); }});
  append_part(columns, &Record::score, score_columns());
  if (options.tells_errors) append_part(columns, &Record::score, error_columns());
  if (!experiment.programs.empty()) {
    columns.push_back(
        {.name = "version", .description = "of the program that answered, in its words", .cell = &Record::version});
    append_refusal(columns, &Record::why);
  }
  return columns;
}

/// The vectors that are asked, and what their answers are compared with.
struct Asked {
  std::vector<ConformanceVector> vectors;
  std::map<Against, std::vector<ScoredVector>> scored = {};
};

Asked asked_vectors(const Experiment& experiment, const Options& options) {
  Asked asked{.vectors = conformance_vectors(experiment.seed, options.form)};
  if (options.emission)
    std::erase_if(asked.vectors, [&](const ConformanceVector& vector) { return vector.emission != *options.emission; });
  for (const Against against : options.against) {
    std::vector<ScoredVector>& scored = asked.scored[against];
    scored.resize(asked.vectors.size());
    tbb::parallel_for(std::size_t{0}, asked.vectors.size(), [&](std::size_t i) {
      const ConformanceVector& vector = asked.vectors[i];
      const Certified truth =
          against == Against::ray ? truth_of(vector) : truth_of(sampled(vector, samples_of(vector, options.intervals)));
      scored[i] = {vector.id, std::string(vector.level), truth, std::nullopt};
    });
  }
  return asked;
}

/// Scores answers, one for each vector or none, against everything asked for.
std::vector<Record> scores_of(const std::string& name, const std::vector<std::optional<Answer>>& answers, Asked& asked,
                              const Options& options) {
  std::vector<Record> records;
  for (const Against against : options.against) {
    std::vector<ScoredVector>& scored = asked.scored[against];
    for (std::size_t i = 0; i < scored.size(); ++i) scored[i].answer = answers[i];
    for (LevelScore& level : score(scored))
      records.push_back(
          {.scheme = name, .intervals = options.intervals, .against = against, .score = std::move(level)});
  }
  return records;
}

std::vector<Record> records_of_program(const OutsideProgram& program, Asked& asked, const Experiment& experiment,
                                       const Options& options) {
  std::vector<std::optional<Answer>> answers(asked.vectors.size());
  try {
    if (!experiment.runs_programs) throw OutsideRefusal(std::string(why_not_run));
    OutsideAnswers found = outside_answers(program, asked.vectors, options.intervals);
    for (std::size_t i = 0; i < answers.size(); ++i)
      if (const auto answer = found.answers.extract(asked.vectors[i].id)) answers[i] = answer.mapped();
    std::vector<Record> records = scores_of(program.name, answers, asked, options);
    for (Record& record : records) record.version = found.version;
    return records;
  } catch (const OutsideRefusal& refusal) {
    Record record{.scheme = program.name, .intervals = options.intervals, .against = options.against.front()};
    record.score.level = "all";
    record.score.cases = static_cast<std::int64_t>(answers.size());
    record.why = refusal.what();
    return {record};
  }
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  Asked asked = asked_vectors(experiment, options);
  std::vector<Record> records;
  const auto take = [&records](std::vector<Record> more) {
    records.insert(records.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  for (const IntegralScheme* const scheme : schemes_of(experiment)) {
    std::vector<std::optional<Answer>> answers(asked.vectors.size());
    tbb::parallel_for(std::size_t{0}, asked.vectors.size(),
                      [&](std::size_t i) { answers[i] = answer_of(*scheme, asked.vectors[i], options.intervals); });
    take(scores_of(std::string(scheme->name), answers, asked, options));
  }
  for (const OutsideProgram& program : experiment.programs)
    take(records_of_program(program, asked, experiment, options));
  return records;
}

}  // namespace

extern const Measure conformance_measure;
const Measure conformance_measure{MeasureDefinition<Options, Record>{
    .name = "conformance",
    .summary = "digits that a scheme's answers to the conformance vectors have right",
    .needs = {.schemes = true, .takes_programs = true},
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
