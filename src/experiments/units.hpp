#pragma once

#include "experiments/experiment.hpp"
#include "experiments/row.hpp"
#include "raytruth/documents/volume_source.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// Whom a run tells how it goes on, unit by unit.
class RunObserver {
 public:
  RunObserver() = default;
  virtual ~RunObserver() = default;
  RunObserver(const RunObserver&) = delete;
  RunObserver& operator=(const RunObserver&) = delete;
  RunObserver(RunObserver&&) = delete;
  RunObserver& operator=(RunObserver&&) = delete;

  virtual void begin(std::size_t units) = 0;
  /// This unit is next.
  virtual void show(std::string_view unit) = 0;
  /// It is done; `is_worked`: by this run, not by one that was interrupted.
  virtual void advance(bool is_worked) = 0;
  /// One line for people.
  virtual void warn(std::string_view line) = 0;
};

/// What of an experiment's work is done or not: a measure of one field, or a block of a measure without fields. What
/// comes of it depends on the experiment, the build and the processor alone.
struct Unit {
  std::string name;  ///< FIELD/MEASURE, MEASURE/BLOCK, or MEASURE where it has one block
  const AskedMeasure* measure;
  const FieldSource* field;  ///< null: none
  std::int64_t block;
};

/// All units, in the order of their rows. They live as long as the experiment.
std::vector<Unit> units_of(const Experiment& experiment);

/// Does units, best in their order: the field of the last one is kept.
class UnitWorker {
 public:
  /// What is given must live as long.
  UnitWorker(const Experiment& experiment, const VolumeAccess& volumes, RunObserver& observer);
  ~UnitWorker();
  UnitWorker(const UnitWorker&) = delete;
  UnitWorker& operator=(const UnitWorker&) = delete;
  UnitWorker(UnitWorker&&) = delete;
  UnitWorker& operator=(UnitWorker&&) = delete;

  /// What comes of the unit: `seconds`, `field` (what `describe` says of it, where there is one) and `rows`; or
  /// `refused`, the reason, where the field's volume is absent, which makes a warning. Throws InputError.
  nlohmann::ordered_json work(const Unit& unit);

 private:
  class LazyField;

  const Experiment& experiment_;
  const VolumeAccess& volumes_;
  RunObserver& observer_;
  std::unique_ptr<LazyField> field_;
};

/// Whether the field of the unit was absent.
bool is_refused(const nlohmann::ordered_json& outcome);

/// What the rows and facts of all fields come to.
struct Findings {
  nlohmann::ordered_json fields = nlohmann::ordered_json::object();
  std::vector<Row> rows;
};

/// What the outcomes of all units, in their order, come to: their rows, and what measures conclude from those.
Findings findings_of(const Experiment& experiment, const std::vector<Unit>& units,
                     const std::vector<nlohmann::ordered_json>& outcomes);

}  // namespace raytruth
