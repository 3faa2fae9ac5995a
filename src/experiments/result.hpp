#pragma once

#include "experiments/experiment.hpp"
#include "experiments/row.hpp"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

/// Throws std::logic_error for a number that is not finite: rows never hold one.
nlohmann::ordered_json to_json(const Value& value);
nlohmann::ordered_json to_json(const Row& row);
/// Throws InputError for what is no flat record.
Row read_row(const JsonReader& json);

/// When and how long a result was worked at: what no two runs share.
struct RunTimes {
  int threads = 0;
  double seconds = 0;   ///< of a merged result: the sum over all units
  std::string started;  ///< as `utc_text` has it
  bool resumed = false;
  std::int64_t parts = 0;  ///< that it is merged of; 0: it is of one run
};

/// How a result came to be.
struct Provenance {
  std::string profile;
  std::optional<RunTimes> times = {};
  std::optional<GlIdentity> gl = {};  ///< what ran the shaders
  bool programs = false;              ///< whether programs from outside were allowed to run
};

/// "2026-11-30T19:14:56Z".
std::string utc_text(std::chrono::system_clock::time_point time);

/// How many threads measures may use now.
int threads_in_use();

/// What decides about the bytes of rows besides the experiment: version, commit, compiler, flags, cpu.
nlohmann::ordered_json build_identity();

/// The build's identity, and how and when it ran.
nlohmann::ordered_json to_json(const Provenance& provenance);
nlohmann::ordered_json to_json(const GlIdentity& gl);

/// What a result says of a field: size, range of the data, file.
nlohmann::ordered_json describe(const Field& field);

/// The result of an experiment as experiments/schemas/result.json describes it. `fields` has what `describe` gives of
/// every field, or why it is refused.
nlohmann::ordered_json make_result(const Experiment& experiment, const Provenance& provenance,
                                   const nlohmann::ordered_json& fields, const std::vector<Row>& rows);

/// A result whose rows are judged by what its experiment claims, checks and draws now; nothing is measured.
/// Throws InputError where the rows are of another experiment.
nlohmann::ordered_json judged_again(const JsonReader& result, const Experiment& experiment);

/// A document as text that reads well and compares well: a line for every row, column, claim and check.
std::string result_text(const nlohmann::ordered_json& result);

/// Reads a result and checks its form as far as the program uses it. Throws InputError.
JsonReader read_result(const std::string& path);

/// Claims as a result's `published` has them, or the ledger's rows, for a terminal: what is stated, what was measured,
/// the verdict, and the experiment where they name one.
std::string claims_table(const nlohmann::ordered_json& claims);

/// A line for every check of the result that does not hold.
std::vector<std::string> broken_checks(const nlohmann::ordered_json& result);

}  // namespace raytruth
