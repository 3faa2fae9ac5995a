#include "experiments/measure.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>

namespace raytruth {

namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path reports;                   ///< folder of what the benchmark programs wrote
  std::vector<std::string> counters;  ///< ratios within one run, which say more than seconds of one machine
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "reports", "counters"});
  Options options{json.at("reports").resolve(json.at("reports").text()), {}};
  for (const JsonReader& counter : json.at("counters").items()) options.counters.push_back(counter.text());
  return options;
}

std::vector<fs::path> reports_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// The benchmark's name without what Google Benchmark says about how it took the time.
std::string plain_name(const JsonReader& entry) {
  std::string name = entry.at("run_name").text();
  for (const char* const option : {"/min_time:", "/manual_time"})
    if (const auto place = name.find(option); place != std::string::npos) name.resize(place);
  return name;
}

/// Median and standard deviation of a counter over the repetitions of a benchmark.
struct Repeated {
  std::optional<double> median;
  std::optional<double> deviation;
};

std::vector<Row> rows_of(const fs::path& file, const std::vector<std::string>& counters) {
  std::vector<std::string> order;
  std::map<std::string, std::map<std::string, Repeated>> benchmarks;
  const JsonReader report = JsonReader::from_file(file.string());
  for (const JsonReader& entry : report.at("benchmarks").items()) {
    const auto aggregate = entry.find("aggregate_name");
    if (!aggregate) continue;
    const std::string name = plain_name(entry);
    const auto [benchmark, is_new] = benchmarks.try_emplace(name);
    if (is_new) order.push_back(name);
    for (const std::string& counter : counters)
      if (const auto value = entry.find(counter)) {
        if (aggregate->json() == "median") benchmark->second[counter].median = value->number();
        if (aggregate->json() == "stddev") benchmark->second[counter].deviation = value->number();
      }
  }

  std::vector<Row> rows;
  for (const std::string& name : order)
    for (const std::string& counter : counters) {
      const Repeated repeated = benchmarks[name][counter];
      if (!repeated.median) continue;
      const double radius = 2 * repeated.deviation.value_or(0);
      rows.push_back({{"report", file.stem().string()},
                      {"benchmark", name},
                      {"counter", counter},
                      {"ratio", *repeated.median},
                      {"low", *repeated.median - radius},
                      {"high", *repeated.median + radius}});
    }
  return rows;
}

}  // namespace

std::vector<Column> costs_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {{.name = "report", .unit = "", .description = "the benchmark program's report", .is_key = true},
          {.name = "benchmark", .unit = "", .description = "what was timed against its peer", .is_key = true},
          {.name = "counter", .unit = "", .description = "which ratio, as the benchmark names it", .is_key = true},
          {.name = "ratio", .unit = "", .description = "median over the repetitions"},
          {.name = "low", .unit = "", .description = "two standard deviations over the repetitions below it"},
          {.name = "high", .unit = "", .description = "and above it"}};
}

std::vector<Row> costs_rows(const Experiment& /*experiment*/, const JsonReader& options, const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  for (const fs::path& file : reports_in(asked.reports))
    for (Row& row : rows_of(file, asked.counters)) rows.push_back(std::move(row));
  if (rows.empty())
    rows.push_back(
        {{"status", "refused"}, {"why", "no reports of benchmarks; tests/run --benchmarks --update writes them"}});
  return rows;
}

}  // namespace raytruth
