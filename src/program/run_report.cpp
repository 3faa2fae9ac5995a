#include "program/run_report.hpp"

#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

namespace raytruth {

void BarObserver::begin(std::size_t units) { bar_.emplace(units); }
void BarObserver::show(std::string_view unit) { bar_->show(unit); }
void BarObserver::advance(bool is_worked) { bar_->advance(is_worked); }

void BarObserver::warn(std::string_view line) {
  if (bar_) bar_->clear();
  say(line);
}

namespace {

/// How many rows there are, how many of them have no values and why most of these have none, and where they are.
std::string summary_of(const Experiment& experiment, const nlohmann::ordered_json& rows,
                       const std::filesystem::path& file) {
  std::map<std::string, std::size_t> refused;  // by their reason
  for (const auto& row : rows)
    if (row.value("status", "ok") != "ok") ++refused[row.at("why").is_string() ? row.at("why").get<std::string>() : ""];
  std::string text = fmt::format("{} rows", rows.size());
  if (!refused.empty()) {
    std::size_t count = 0;
    for (const auto& [why, times] : refused) count += times;
    const auto& [why, times] = *std::max_element(refused.begin(), refused.end(),
                                                 [](const auto& a, const auto& b) { return a.second < b.second; });
    text += fmt::format(", {} without values ({}{})", count, times < count ? fmt::format("{} of them: ", times) : "",
                        one_line(why));
  }
  if (file.empty()) return text;
  text += " in " + file.string();
  if (!experiment.json.find("plot")) return text;
  const auto folder = file.parent_path();
  return text +
         fmt::format("; to draw them: raytruth plot {} -o {}", file.string(), folder.empty() ? "." : folder.string());
}

}  // namespace

bool report(const Experiment& experiment, const std::string& profile, const nlohmann::ordered_json& result,
            const std::filesystem::path& file) {
  if (profile == "full") {
    fmt::print(stderr, "{}", claims_table(result.at("published")));
    if (result.at("published").empty()) say(experiment.name + ": no publication claims anything of it");
  } else {
    say(fmt::format("{}: no verdicts: the profile {} is for tests, and has fewer rays and fields", experiment.name,
                    profile));
  }
  const auto broken = broken_checks(result);
  const std::size_t count = result.at("checks").size();
  if (count > 0) say(fmt::format("{}: {} of {} checks hold", experiment.name, count - broken.size(), count));
  for (const std::string& line : broken) say(line);
  say(fmt::format("{}: {}", experiment.name, summary_of(experiment, result.at("rows"), file)));
  return broken.empty();
}

}  // namespace raytruth
