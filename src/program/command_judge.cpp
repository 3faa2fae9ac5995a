#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <string>

namespace raytruth {

namespace {

struct JudgeOptions {
  std::string experiment;
  std::string result;
  std::string file;
};

int judge_again(const JudgeOptions& options) {
  const Experiment experiment = read_experiment(options.experiment, "full", std::nullopt, std::nullopt);
  const auto judged = judged_again(read_result(options.result), experiment);
  fmt::print(stderr, "{}", claims_table(judged.at("published")));
  for (const std::string& line : broken_checks(judged)) say(experiment.name + ": " + line);
  write_whole(options.file.empty() ? options.result : options.file, result_text(judged));
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<JudgeOptions>();
  add.operand("experiment", options->experiment, "Its JSON file, with the claims, checks and plot as they are now");
  add.operand("result", options->result, "What came of it");
  add.text("-o", "FILE", options->file, "Write the result to this file (default: in place)");
  return [options] { return judge_again(*options); };
}

}  // namespace

extern const Command judge_command;
const Command judge_command{
    .name = "judge",
    .summary = "Judge the rows of a result again, after claims, checks or a plot of its experiment changed",
    .example = "raytruth judge experiments/eta.json out/eta.json",
    .notes = "Nothing is measured. Where fields, measures or anything else that rows follow from changed, run it.\n",
    .describe = describe};

}  // namespace raytruth
