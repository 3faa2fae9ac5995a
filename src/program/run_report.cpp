#include "program/run_report.hpp"

#include "experiments/output.hpp"
#include "experiments/result.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace raytruth {

void BarObserver::begin(std::size_t units) { bar_.emplace(units); }
void BarObserver::show(std::string_view unit) { bar_->show(unit); }
void BarObserver::advance(bool is_worked) { bar_->advance(is_worked); }

void BarObserver::warn(std::string_view line) {
  if (bar_) bar_->clear();
  say(line);
}

bool report(const Experiment& experiment, const std::string& profile, const nlohmann::ordered_json& result) {
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
  return broken.empty();
}

}  // namespace raytruth
