#include "experiments/shard.hpp"

#include "experiments/digest.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t most_shards = 1'000'000'000;
constexpr int most_threads = 1'000'000;

/// Whether the commit says what the program was built from.
bool is_told_by_commit(const Json& build) {
  const auto commit = build.at("commit").get<std::string>();
  return commit != "unknown" && !commit.ends_with("-dirty");
}

/// Digests of a part's document: of its experiment, of its build, and of all else, which its rows are in.
Json digests_of(const Json& document) {
  Json rest = document;
  for (const char* const name : {"experiment", "build", "digests"}) rest.erase(name);
  return {{"experiment", sha256(document.at("experiment").dump())},
          {"build", sha256(document.at("build").dump())},
          {"rows", sha256(rest.dump())}};
}

Json to_json(const Part& part) {
  Json document{{"raytruth", "part/1"},    {"experiment", part.experiment},
                {"build", part.build},     {"profile", part.profile},
                {"file", part.asked},      {"shard", {{"number", part.shard.number}, {"count", part.shard.count}}},
                {"threads", part.threads}, {"started", part.started},
                {"units", Json::array()}};
  Json& units = document["units"];
  for (std::size_t i = 0; i < part.names.size(); ++i) {
    Json& unit = units.emplace_back(Json{{"name", part.names[i]}});
    unit.update(part.outcomes[i]);
  }
  document["digests"] = digests_of(document);
  return document;
}

void check_build(const JsonReader& build) {
  build.only({"version", "commit", "compiler", "flags", "cpu", "program", "gl", "programs"});
  for (const char* const name : {"version", "commit", "compiler", "flags", "cpu"}) build.at(name).text();
  if (const auto programs = build.find("programs"); programs && !programs->boolean())
    programs->refuse_value("true, or nothing,");
  if (const auto gl = build.find("gl"))
    for (const char* const name : {"platform", "vendor", "renderer", "version"}) gl->at(name).text();
}

std::string read_utc(const JsonReader& json) {
  constexpr std::string_view pattern = "0000-00-00T00:00:00Z";
  const std::string time = json.text();
  const auto fits = [](char found, char expected) {
    return expected == '0' ? '0' <= found && found <= '9' : found == expected;
  };
  if (!std::equal(time.begin(), time.end(), pattern.begin(), pattern.end(), fits))
    json.refuse_value("a time, as 2026-11-30T19:14:56Z,");
  return time;
}

/// Refuses what is no outcome of a unit.
void check_outcome(const JsonReader& unit) {
  unit.only({"name", "seconds", "field", "rows", "refused"});
  unit.at("name").text();
  unit.at("seconds").number(0);
  if (const auto refused = unit.find("refused")) {
    refused->text();
    return;
  }
  if (const auto field = unit.find("field")) field->members();
  for (const JsonReader& row : unit.at("rows").items(0)) read_row(row);
}

/// Whether the part is there already and has all it can have.
bool is_finished(const std::filesystem::path& file, const Part& part) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return false;
  try {
    const Part found = read_part(file);
    if (found.experiment == part.experiment && found.build == part.build && found.profile == part.profile)
      return std::none_of(found.outcomes.begin(), found.outcomes.end(), is_refused);
    say(fmt::format("{}: belongs to another experiment or build: starting afresh", file.string()));
  } catch (const InputError& error) {
    say(fmt::format("{}: starting afresh", error.what()));
  }
  return false;
}

}  // namespace

Shard read_shard(const std::string& text) {
  const auto refuse = [&text] {
    throw InputError(one_line(
        fmt::format("--shard: found {}; K/N is allowed, with K from 1 to N, as 3/64 for the third of 64", text)));
  };
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  if (number.ec != std::errc() || number.ptr == end || *number.ptr != '/') refuse();
  const auto count = std::from_chars(number.ptr + 1, end, shard.count);
  if (count.ec != std::errc() || count.ptr != end) refuse();
  if (shard.number < 1 || shard.number > shard.count || shard.count > most_shards) refuse();
  return shard;
}

std::string to_text(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.count); }

std::span<const Unit> units_of_shard(std::span<const Unit> units, const Shard& shard) {
  const auto n = static_cast<std::int64_t>(units.size());
  const auto begin = (shard.number - 1) * n / shard.count;
  const auto end = shard.number * n / shard.count;
  return units.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
}

Shard shard_of_unit(std::size_t i, std::size_t n, std::int64_t count) {
  // The smallest k with i + 1 <= floor(k n / count).
  const auto before = static_cast<std::int64_t>(i + 1) * count + static_cast<std::int64_t>(n) - 1;
  return {before / static_cast<std::int64_t>(n), count};
}

Json build_of_parts(const std::optional<GlIdentity>& gl, bool runs_programs) {
  Json build = build_identity();
  if (!is_told_by_commit(build)) build["program"] = sha256_of_file("/proc/self/exe");
  if (gl) build["gl"] = to_json(*gl);
  if (runs_programs) build["programs"] = true;
  return build;
}

Part read_part(const std::filesystem::path& file) {
  const JsonReader json = JsonReader::from_file(file.string());
  json.at("raytruth").word({"part/1"});
  json.only({"raytruth", "experiment", "build", "profile", "file", "shard", "threads", "started", "units", "digests"});
  json.at("experiment").members();
  check_build(json.at("build"));
  const JsonReader stated = json.at("digests");
  const Json digests = digests_of(json.json());
  for (const auto& [name, digest] : digests.items())
    if (stated.at(name).text() != digest)
      stated.at(name).refuse("a digest that is not that of the " + name,
                             "a part as `raytruth run --shard` wrote it, and makes it again,");
  const JsonReader shard = json.at("shard");
  Part part{.file = file.string(),
            .experiment = json.at("experiment").json(),
            .build = json.at("build").json(),
            .profile = json.at("profile").word({"quick", "full"}),
            .asked = json.at("file").text(),
            .shard = {shard.at("number").integer(1, most_shards), shard.at("count").integer(1, most_shards)},
            .threads = static_cast<int>(json.at("threads").integer(1, most_threads)),
            .started = read_utc(json.at("started")),
            .names = {},
            .outcomes = {}};
  for (const JsonReader& unit : json.at("units").items(0)) {
    check_outcome(unit);
    part.names.push_back(unit.at("name").text());
    part.outcomes.push_back(unit.json());
    part.outcomes.back().erase("name");
  }
  return part;
}

std::filesystem::path run_shard(const Experiment& experiment, const std::string& asked, const Shard& shard,
                                const RunRequest& request, const std::filesystem::path& folder, RunObserver& observer) {
  Part part{.file = {},
            .experiment = experiment.json.json(),
            .build = build_of_parts(gl_identity(experiment), experiment.runs_programs),
            .profile = request.profile,
            .asked = asked,
            .shard = shard,
            .threads = threads_in_use(),
            .started = utc_text(std::chrono::system_clock::now()),
            .names = {},
            .outcomes = {}};
  const auto file = folder / fmt::format("{}.{}-of-{}.part", experiment.name, shard.number, shard.count);
  if (is_finished(file, part)) return file;

  const Json run{{"raytruth", "journal/1"}, {"build", part.build}, {"experiment", part.experiment}};
  Journal journal(file, run, true);
  const auto all = units_of(experiment);
  const auto units = units_of_shard(all, shard);
  for (const Unit& unit : units) part.names.push_back(unit.name);
  part.outcomes = outcomes_of(experiment, units, request.volumes, journal, observer);
  write_whole(file, result_text(to_json(part)));
  journal.remove();
  return file;
}

}  // namespace raytruth
