#include "experiments/measure.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace raytruth {

namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path reports;                   ///< folder of what the benchmark programs wrote
  std::vector<std::string> counters;  ///< ratios within one run, which say more than seconds of one machine
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
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

/// A counter of a benchmark.
struct Ratio {
  std::string report;
  std::string benchmark;
  std::string counter;
  double median;
  double radius;
};

/// A ratio, or why there is none.
struct Record {
  std::optional<Ratio> ratio;
  std::optional<std::string> refusal = {};
};

void add_ratios(std::vector<Record>& records, const fs::path& file, const std::vector<std::string>& counters) {
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

  for (const std::string& name : order)
    for (const std::string& counter : counters) {
      const Repeated repeated = benchmarks[name][counter];
      if (!repeated.median) continue;
      records.push_back({Ratio{.report = file.stem().string(),
                               .benchmark = name,
                               .counter = counter,
                               .median = *repeated.median,
                               .radius = 2 * repeated.deviation.value_or(0)}});
    }
}

Columns<Ratio> ratio_columns() {
  return {
      {.name = "report", .description = "the benchmark program's report", .is_key = true, .cell = &Ratio::report},
      {.name = "benchmark",
       .description = "what was timed against its peer",
       .is_key = true,
       .cell = &Ratio::benchmark},
      {.name = "counter",
       .description = "which ratio, as the benchmark names it",
       .is_key = true,
       .cell = &Ratio::counter},
      {.name = "ratio", .description = "median over the repetitions", .cell = &Ratio::median},
      {.name = "low",
       .description = "two standard deviations over the repetitions below it",
       .cell = [](const Ratio& ratio) { return ratio.median - ratio.radius; }},
      {.name = "high",
       .description = "and above it",
       .cell = [](const Ratio& ratio) { return ratio.median + ratio.radius; }},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::ratio, ratio_columns());
  append_refusal(columns, &Record::refusal);
  return columns;
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const fs::path& file : reports_in(options.reports)) add_ratios(records, file, options.counters);
  if (records.empty()) records.push_back({{}, "no reports of benchmarks; tests/run --benchmarks --update writes them"});
  return records;
}

}  // namespace

extern const Measure costs_measure;
const Measure costs_measure{
    MeasureDefinition<Options, Record>{.name = "costs",
                                       .summary = "ratios of times that the benchmarks' reports hold, each of one run",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_experiment = records}};

}  // namespace raytruth
