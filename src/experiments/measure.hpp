#pragma once

#include "experiments/columns.hpp"
#include "experiments/experiment.hpp"
#include "experiments/row.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

/// A measure as an experiment asks it: its options are read.
class AskedMeasure {
 public:
  explicit AskedMeasure(const Measure& measure) : measure_(measure) {}
  virtual ~AskedMeasure() = default;
  AskedMeasure(const AskedMeasure&) = delete;
  AskedMeasure& operator=(const AskedMeasure&) = delete;
  AskedMeasure(AskedMeasure&&) = delete;
  AskedMeasure& operator=(AskedMeasure&&) = delete;

  [[nodiscard]] const Measure& measure() const { return measure_; }

  /// The columns of its rows besides `measure`, `field`, `status` and `why`.
  [[nodiscard]] virtual std::vector<Column> columns() const = 0;
  /// Into how many parts its work is divided that an interrupted run keeps once they are done, for each field.
  [[nodiscard]] virtual std::int64_t blocks() const = 0;
  /// The rows of a block, of a field where the measure is one of fields, without `measure` and `field`; without
  /// `status` and `why` unless refused; the same bytes on any number of threads.
  [[nodiscard]] virtual std::vector<Row> rows(const Experiment& experiment, const Field& field,
                                              std::int64_t block) const = 0;
  /// What the rows of all fields come to together: rows of no field, behind those.
  [[nodiscard]] virtual std::vector<Row> conclusions(const Experiment& experiment,
                                                     const std::vector<Row>& rows) const = 0;

 private:
  const Measure& measure_;
};

/// What a measure needs an experiment to state; one that lacks it is refused.
struct Needs {
  bool schemes = false;
  bool takes_programs = false;    ///< schemes may be programs from outside
  bool signal_schemes = false;    ///< schemes, all of which approximate the signal: those of catalogue::Schemes
  bool usable_samplings = false;  ///< samplings that all of these can use
  bool transfers = false;         ///< transfer functions
};

/// How a measure is written: by its options, read once into a type of its own, and by the records that become its rows.
/// One of `of_field`, `of_experiment` and `of_block` is given.
template <class Options, class Record>
struct MeasureDefinition {
  std::string_view name;
  std::string_view summary;
  bool uses_gl = false;
  Needs needs = {};
  /// Refuses options that it does not know.
  Options (*read)(const Experiment&, const JsonReader&);
  Columns<Record> (*columns)(const Experiment&, const Options&);
  /// Asked of every field of the experiment, along its rays.
  std::vector<Record> (*of_field)(const Experiment&, const Options&, const Field&) = nullptr;
  /// Asked once, without fields.
  std::vector<Record> (*of_experiment)(const Experiment&, const Options&) = nullptr;
  /// Asked once where it takes minutes of work: block by block, of so many.
  std::vector<Record> (*of_block)(const Experiment&, const Options&, std::int64_t block) = nullptr;
  std::int64_t (*blocks)(const Options&) = nullptr;
  /// What the rows of all fields come to, for measures of fields.
  std::vector<Record> (*conclusions)(const Experiment&, const Options&, const std::vector<Row>& rows) = nullptr;
};

/// What an experiment can ask: a row of `measures()`. src/README.md says how to add one.
struct Measure {
  template <class Options, class Record>
  explicit Measure(const MeasureDefinition<Options, Record>& definition);

  std::string_view name;
  std::string_view summary;
  bool is_of_fields;  ///< whether it is asked of every field of the experiment; else once
  bool uses_gl;       ///< whether it runs shaders
  Needs needs;
  /// Reads the options.
  std::function<std::shared_ptr<const AskedMeasure>(const Measure&, const Experiment&, const JsonReader& options)> ask;
};

/// Every measure, in the order of help and tables. src/measures/measures.cpp names them.
std::span<const Measure* const> measures();

/// The measure that an item of an experiment's "measures" names. Throws InputError.
const Measure& measure_of(const JsonReader& options);

// --- How a definition becomes a measure ---

namespace detail {

template <class Options, class Record>
class DefinedMeasure final : public AskedMeasure {
 public:
  DefinedMeasure(const Measure& measure, const MeasureDefinition<Options, Record>& definition,
                 const Experiment& experiment, Options options)
      : AskedMeasure(measure),
        definition_(definition),
        options_(std::move(options)),
        columns_(definition.columns(experiment, options_)) {}

  [[nodiscard]] std::vector<Column> columns() const override { return descriptions_of(columns_); }

  [[nodiscard]] std::int64_t blocks() const override {
    return definition_.blocks != nullptr ? definition_.blocks(options_) : 1;
  }

  [[nodiscard]] std::vector<Row> rows(const Experiment& experiment, const Field& field,
                                      std::int64_t block) const override {
    if (definition_.of_field != nullptr) return rows_of(definition_.of_field(experiment, options_, field));
    if (definition_.of_block != nullptr) return rows_of(definition_.of_block(experiment, options_, block));
    return rows_of(definition_.of_experiment(experiment, options_));
  }

  [[nodiscard]] std::vector<Row> conclusions(const Experiment& experiment,
                                             const std::vector<Row>& rows) const override {
    if (definition_.conclusions == nullptr) return {};
    return rows_of(definition_.conclusions(experiment, options_, rows));
  }

 private:
  [[nodiscard]] std::vector<Row> rows_of(const std::vector<Record>& records) const {
    std::vector<Row> rows;
    rows.reserve(records.size());
    for (const Record& record : records) rows.push_back(row_of(columns_, record));
    return rows;
  }

  MeasureDefinition<Options, Record> definition_;
  Options options_;
  Columns<Record> columns_;
};

}  // namespace detail

template <class Options, class Record>
Measure::Measure(const MeasureDefinition<Options, Record>& definition)
    : name(definition.name),
      summary(definition.summary),
      is_of_fields(definition.of_field != nullptr),
      uses_gl(definition.uses_gl),
      needs(definition.needs),
      ask([definition](const Measure& measure, const Experiment& experiment, const JsonReader& options) {
        return std::make_shared<const detail::DefinedMeasure<Options, Record>>(measure, definition, experiment,
                                                                               definition.read(experiment, options));
      }) {}

}  // namespace raytruth
