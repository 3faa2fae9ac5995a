#include "experiments/merge.hpp"

#include "experiments/experiment_as_run.hpp"
#include "experiments/experiment_folder.hpp"
#include "experiments/measure.hpp"
#include "experiments/result.hpp"
#include "experiments/shard.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <system_error>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(std::string_view place, std::string_view found, std::string_view allowed) {
  throw InputError(one_line(fmt::format("{}: found {}; {}", place, found, allowed)));
}

std::vector<std::filesystem::path> part_files(const std::vector<std::string>& places) {
  std::vector<std::filesystem::path> files;
  for (const std::string& place : places) {
    std::error_code error;
    if (!std::filesystem::is_directory(place, error)) {
      files.emplace_back(place);
      continue;
    }
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(place, error))
      if (entry.path().extension() == ".part") found.push_back(entry.path());
    if (error) refuse(place, "a folder that cannot be read (" + error.message() + ")", "one that can is allowed");
    if (found.empty())
      refuse(place, "no part", "a folder of parts is allowed; `raytruth run EXPERIMENT --shard K/N -o DIR` makes them");
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Refuses a part of which something is not as it is elsewhere, by the first member that differs.
void need_same(const Part& part, std::string_view elsewhere, std::string_view what, const Json& here,
               const Json& there) {
  std::set<std::string> names;
  for (const Json& side : {here, there})
    for (const auto& [name, member] : side.items()) names.insert(name);
  for (const std::string& name : names) {
    const Json is = here.value(name, Json());
    const Json was = there.value(name, Json());
    if (is != was)
      refuse(part.file, fmt::format("\"{}\": {} in its {}", name, shortened(is.dump()), what),
             fmt::format("{}, as in {}, is allowed: parts of one {}", shortened(was.dump()), elsewhere, what));
  }
}

/// The build without the processor, which may differ where that is asked for, and without what ran shaders and whether
/// programs from outside were allowed to run.
Json without_machine(Json build) {
  for (const char* const name : {"cpu", "gl", "programs"}) build.erase(name);
  return build;
}

void need_one_run(const std::vector<Part>& parts, bool mixed_cpus) {
  const Part& first = parts.front();
  for (const Part& part : parts) {
    need_same(part, first.file, "experiment", part.experiment, first.experiment);
    if (part.profile != first.profile)
      refuse(part.file, "the profile " + part.profile,
             fmt::format("{}, as in {}, is allowed", first.profile, first.file));
    if (!mixed_cpus && part.build.at("cpu") != first.build.at("cpu"))
      refuse(part.file, "rows of the processor " + part.build.at("cpu").get<std::string>(),
             fmt::format("{}, as in {}, is allowed: last digits may differ; --mixed-cpus takes them all",
                         first.build.at("cpu").get<std::string>(), first.file));
    Json build = part.build;
    build["cpu"] = first.build.at("cpu");
    need_same(part, first.file, "build", build, first.build);
  }
  const Json own = without_machine(build_of_parts({}, false));
  need_same(first, "this program", "build", without_machine(first.build), own);
}

/// The file that was asked for; where it is no longer at hand, what was typed.
std::string file_of(const std::string& asked) {
  try {
    return find_experiment(asked);
  } catch (const InputError&) {
    return asked;
  }
}

/// Whether programs that the experiment names ran.
bool ran_programs(const Part& part) { return part.build.contains("programs"); }

/// Relative paths of files in it resolve as they did in the file that was run.
std::shared_ptr<const Experiment> experiment_of(const Part& part) {
  try {
    const JsonReader json = JsonReader::from_text(part.experiment.dump(), file_of(part.asked));
    json.at("raytruth").word({"experiment/1"});
    auto experiment = std::make_shared<Experiment>(read_experiment_as_run(json));
    experiment->runs_programs = ran_programs(part);
    return experiment;
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("{}: /experiment: {}", part.file, error.what())));
  }
}

/// A word of a command line for a shell.
std::string shell_word(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.,:/=+@%-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// "3, 5-9 and 12 more": a list of sorted numbers that stays short.
std::string number_list(const std::vector<std::int64_t>& numbers) {
  constexpr std::size_t most = 8;
  std::vector<std::string> ranges;
  std::size_t i = 0;
  while (i < numbers.size() && ranges.size() < most) {
    const std::size_t begin = i;
    while (i + 1 < numbers.size() && numbers[i + 1] == numbers[i] + 1) ++i;
    ranges.push_back(begin == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[begin], numbers[i]));
    ++i;
  }
  const auto left = numbers.size() - i;
  return fmt::format("{}{}", fmt::join(ranges, ", "), left > 0 ? fmt::format(" and {} more", left) : "");
}

/// What the parts say of all units: of each the first outcome, and the part that it stands in.
class Outcomes {
 public:
  Outcomes(const Experiment& experiment, const std::vector<Unit>& units) : units_(units), found_(units.size()) {
    for (const Column& column : result_columns(experiment)) columns_.insert(column.name);
    for (std::size_t i = 0; i < units.size(); ++i) places_[units[i].name] = i;
  }

  void add(const Part& part) {
    for (std::size_t i = 0; i < part.names.size(); ++i) {
      const auto place = places_.find(part.names[i]);
      if (place == places_.end())
        refuse(part.file, "the unit " + Json(part.names[i]).dump(), "units of its experiment are allowed");
      add(part, place->second, part.outcomes[i]);
    }
  }

  /// Throws MissingError for those that no part has.
  void need_all(const Part& first, const std::string& folder) const {
    std::vector<std::string> names;
    std::vector<std::int64_t> shards;
    for (std::size_t i = 0; i < units_.size(); ++i) {
      if (found_[i].part != nullptr) continue;
      names.push_back(units_[i].name);
      const auto shard = shard_of_unit(i, units_.size(), first.shard.count).number;
      if (shards.empty() || shards.back() != shard) shards.push_back(shard);
    }
    if (names.empty()) return;
    std::string command = "raytruth run " + shell_word(first.asked);
    if (ran_programs(first)) command += " --programs";
    if (first.profile != "full") command += " --profile " + first.profile;
    command += fmt::format(" --seed {}", first.experiment.at("seed").dump());
    if (first.experiment.contains("gl")) command += " --gl " + first.experiment.at("gl").get<std::string>();
    command += fmt::format(" --shard {}/{} -o {}", shards.front(), first.shard.count, shell_word(folder));
    constexpr std::size_t shown = 4;
    const auto more = names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "";
    const auto count = names.size();
    names.resize(std::min(count, shown));
    const std::string others =
        shards.size() == 1 ? "" : fmt::format("; so do the shards {}", number_list({shards.begin() + 1, shards.end()}));
    throw MissingError(one_line(fmt::format("{} of {} units are missing: {}{}; this makes the first: {}{}", count,
                                            units_.size(), fmt::join(names, ", "), more, command, others)));
  }

  [[nodiscard]] std::vector<Json> all() const {
    std::vector<Json> outcomes;
    for (const Found& found : found_) outcomes.push_back(*found.outcome);
    return outcomes;
  }

  [[nodiscard]] double seconds() const {
    double seconds = 0;
    for (const Found& found : found_) seconds += found.outcome->at("seconds").get<double>();
    return seconds;
  }

  /// Does a random share of the units again.
  void recheck(double share, UnitWorker& worker, RunObserver& observer) const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < units_.size(); ++i)
      if (!is_refused(*found_[i].outcome)) numbers.push_back(i);
    const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(numbers.size())));
    std::vector<std::size_t> chosen;
    // Whoever made the parts must not know which: this is no randomness of the experiment.
    std::sample(numbers.begin(), numbers.end(), std::back_inserter(chosen), count, std::random_device());
    observer.begin(chosen.size());
    std::size_t done = 0;
    for (const std::size_t i : chosen) {
      observer.show(units_[i].name);
      const Json again = worker.work(units_[i]);
      const Found& found = found_[i];
      observer.advance(true);
      if (is_refused(again)) {
        observer.warn(fmt::format("warning: {}: not done again", units_[i].name));
        continue;
      }
      ++done;
      const std::string difference = first_difference(*found.outcome, again);
      if (!difference.empty())
        refuse(found.part->file, fmt::format("the unit {} with {}", units_[i].name, difference),
               fmt::format("what comes out here, on {}, is allowed", build_identity().at("cpu").get<std::string>()));
    }
    observer.warn(fmt::format("{} of {} units were done again, and came out the same", done, units_.size()));
  }

 private:
  struct Found {
    const Part* part = nullptr;
    const Json* outcome = nullptr;
  };

  void add(const Part& part, std::size_t i, const Json& outcome) {
    const Unit& unit = units_[i];
    check_rows(part, unit, outcome);
    Found& found = found_[i];
    if (found.part != nullptr) {
      const std::string difference = first_difference(outcome, *found.outcome);
      if (!difference.empty())
        refuse(part.file, fmt::format("the unit {} with {}", unit.name, difference),
               fmt::format("the same as in {} is allowed: one of both is wrong, and must go", found.part->file));
      return;
    }
    found = {&part, &outcome};
    if (unit.field == nullptr) return;
    // What one run says of a field it says once.
    const auto [first, is_new] = fields_.try_emplace(unit.field->name, found);
    const Json& here = outcome.contains("field") ? outcome.at("field") : outcome.at("refused");
    const Json& first_outcome = *first->second.outcome;
    const Json& there = first_outcome.contains("field") ? first_outcome.at("field") : first_outcome.at("refused");
    if (!is_new && here != there)
      refuse(part.file, fmt::format("the field {} as {}", unit.field->name, shortened(here.dump())),
             fmt::format("{}, as in {}, is allowed: the same volume on all machines", shortened(there.dump()),
                         first->second.part->file));
  }

  /// Refuses what the unit cannot have given.
  void check_rows(const Part& part, const Unit& unit, const Json& outcome) const {
    const bool has_field = unit.field != nullptr;
    if (is_refused(outcome) ? !has_field || outcome.contains("rows") : has_field != outcome.contains("field"))
      refuse(part.file, fmt::format("no outcome of the unit {}", unit.name),
             "what `raytruth run` makes of it is allowed");
    if (is_refused(outcome)) return;
    const Json measure = unit.measure->measure().name;
    const Json field = has_field ? Json(unit.field->name) : Json();
    for (const Json& row : outcome.at("rows")) {
      for (const auto& [name, value] : row.items())
        if (!columns_.contains(name))
          refuse(part.file, fmt::format("the column {} in the unit {}", Json(name).dump(), unit.name),
                 "columns of its experiment are allowed");
      if (row.value("measure", Json()) != measure || row.value("field", Json()) != field)
        refuse(part.file, fmt::format("a row of another measure or field in the unit {}", unit.name),
               "rows of the unit are allowed");
    }
  }

  /// What of an outcome is another one, but for its seconds; empty: nothing.
  static std::string first_difference(const Json& is, const Json& was) {
    for (const char* const name : {"refused", "field"})
      if (is.value(name, Json()) != was.value(name, Json()))
        return fmt::format("\"{}\" {}, not {}", name, shortened(is.value(name, Json()).dump()),
                           shortened(was.value(name, Json()).dump()));
    if (is_refused(is)) return {};
    const Json& rows = is.at("rows");
    const Json& other = was.at("rows");
    if (rows.size() != other.size()) return fmt::format("{} rows, not {}", rows.size(), other.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].dump() == other[i].dump()) continue;
      for (const auto& [name, value] : rows[i].items())
        if (value.dump() != other[i].value(name, Json()).dump())
          return fmt::format("the {} {} in row {}, not {}", name, shortened(value.dump()), i,
                             shortened(other[i].value(name, Json()).dump()));
      return fmt::format("other columns in row {}", i);
    }
    return {};
  }

  const std::vector<Unit>& units_;
  std::vector<Found> found_;
  std::map<std::string, std::size_t> places_;
  std::map<std::string, Found> fields_;
  std::set<std::string> columns_;
};

/// All processors of the parts, each once.
std::string cpus_of(const std::vector<Part>& parts) {
  std::set<std::string> cpus;
  for (const Part& part : parts) cpus.insert(part.build.at("cpu").get<std::string>());
  return fmt::format("{}", fmt::join(cpus, "; "));
}

/// As `Provenance` has it, of a part's build.
std::optional<GlIdentity> gl_of(const Part& part) {
  const auto gl = part.build.find("gl");
  if (gl == part.build.end()) return {};
  const auto text = [&gl](const char* name) { return gl->at(name).get<std::string>(); };
  return GlIdentity{text("platform"), text("vendor"), text("renderer"), text("version")};
}

}  // namespace

Merged merge_parts(const MergeRequest& request, RunObserver& observer) {
  std::vector<Part> parts;
  for (const auto& file : part_files(request.places)) parts.push_back(read_part(file));
  need_one_run(parts, request.mixed_cpus);
  const Part& first = parts.front();
  Merged merged{.experiment = experiment_of(first), .profile = first.profile, .result = {}, .parts = {}};
  const Experiment& experiment = *merged.experiment;
  const auto units = units_of(experiment);
  Outcomes outcomes(experiment, units);
  for (const Part& part : parts) {
    outcomes.add(part);
    merged.parts.push_back(part.file);
  }
  std::error_code ignored;
  const std::string& place = request.places.front();
  const auto folder = std::filesystem::path(place).parent_path();
  outcomes.need_all(first, std::filesystem::is_directory(place, ignored) ? place
                           : folder.empty()                              ? "."
                                                                         : folder.string());
  if (request.recheck > 0) {
    if (ran_programs(first) && !request.runs_programs)
      refuse(first.file, "units that ran programs, to be done again",
             "parts without them are allowed; --programs runs these too");
    UnitWorker worker(experiment, request.volumes, observer);
    outcomes.recheck(request.recheck, worker, observer);
  }

  Provenance provenance{.profile = first.profile, .gl = gl_of(first), .programs = ran_programs(first)};
  if (request.has_times) {
    const auto most_threads = std::max_element(parts.begin(), parts.end(),
                                               [](const Part& a, const Part& b) { return a.threads < b.threads; });
    const auto earliest = std::min_element(parts.begin(), parts.end(),
                                           [](const Part& a, const Part& b) { return a.started < b.started; });
    provenance.times = RunTimes{.threads = most_threads->threads,
                                .seconds = outcomes.seconds(),
                                .started = earliest->started,
                                .parts = static_cast<std::int64_t>(parts.size())};
  }
  const Findings findings = findings_of(experiment, units, outcomes.all());
  merged.result = make_result(experiment, provenance, findings.fields, findings.rows);
  merged.result["provenance"]["cpu"] = cpus_of(parts);
  return merged;
}

}  // namespace raytruth
