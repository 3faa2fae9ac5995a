#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "experiments/runner.hpp"
#include "program/command.hpp"
#include "program/progress_bar.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <nlohmann/json.hpp>

#include <optional>

namespace raytruth {

namespace {

struct RunOptions {
  std::vector<std::string> experiments;
  std::optional<std::string> folder;
  int threads = 0;  ///< 0: all cores
  std::string profile = "full";
  std::optional<std::int64_t> seed;
  std::optional<std::string> gl;
  bool check = false;
  bool resume = false;
  std::string data;
};

/// A bar of what is done.
class BarObserver final : public RunObserver {
 public:
  void begin(std::size_t units) override { bar_.emplace(units); }
  void show(std::string_view unit) override { bar_->show(unit); }
  void advance(bool is_worked) override { bar_->advance(is_worked); }
  void warn(std::string_view line) override {
    bar_->clear();
    say(line);
  }

 private:
  std::optional<ProgressBar> bar_;
};

/// Where the result goes; empty: to standard output.
std::filesystem::path result_file(const RunOptions& options, const Experiment& experiment) {
  if (!options.folder) return {};
  return std::filesystem::path(*options.folder) / (experiment.name + ".json");
}

void refuse_overwriting(const std::string& experiment, const std::filesystem::path& result) {
  std::error_code ignored;
  if (std::filesystem::equivalent(experiment, result, ignored))
    throw InputError(
        fmt::format("{}: found the experiment where its result would go; another folder is allowed", result.string()));
}

int run_experiments(const RunOptions& options) {
  if (!options.folder && options.experiments.size() > 1)
    throw InputError(fmt::format("run: found {} experiments without -o; one is allowed", options.experiments.size()));
  if (!options.folder && options.resume) throw InputError("run: found --resume without -o; -o DIR is needed with it");
  std::vector<Experiment> experiments;
  for (const std::string& path : options.experiments) {
    Experiment experiment = read_experiment(path, options.profile, options.seed, options.gl);
    for (const std::string& warning : experiment.warnings) say(warning);
    for (const Experiment& other : experiments)
      if (other.name == experiment.name) experiment.json.at("name").refuse_value("one experiment of each name");
    experiments.push_back(std::move(experiment));
  }
  for (const Experiment& experiment : experiments)
    for (const std::string& path : options.experiments) refuse_overwriting(path, result_file(options, experiment));
  if (options.folder) make_folder(*options.folder);

  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const RunRequest request{
      .profile = options.profile, .resume = options.resume, .folders = volume_folders(options.data)};
  const auto run = [&request](const Experiment& experiment, const std::filesystem::path& file) {
    BarObserver observer;
    return run_experiment(experiment, request, file, observer);
  };
  bool all_hold = true;
  for (const Experiment& experiment : experiments) {
    const auto file = result_file(options, experiment);
    const auto result = run(experiment, file);
    if (file.empty()) print(result_text(result));
    fmt::print(stderr, "{}", claims_table(result.at("published")));
    for (const std::string& line : broken_checks(result)) {
      all_hold = false;
      say(line);
    }
  }
  return options.check && !all_hold ? 1 : 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<RunOptions>();
  add.operands("experiment", options->experiments, "JSON files; '-' is standard input");
  add.text("-o", "DIR", options->folder, "Write NAME.json into this folder (default: to standard output)");
  add.threads(options->threads);
  add.word("--profile", options->profile, {"quick", "full"}, "quick: a smaller version, in seconds (default: full)");
  add.seed(options->seed, "Instead of the experiment's");
  add.word("--gl", options->gl, {"osmesa", "egl"},
           "Run shaders by osmesa or by egl, a GPU's driver (default: the experiment's)");
  add.flag("--check", options->check, "Exit with 1 if a bound that the experiment states does not hold");
  add.flag("--resume", options->resume, "Finish an interrupted run; needs -o");
  add.data(options->data);
  return [options] { return run_experiments(*options); };
}

}  // namespace

extern const Command run_command;
const Command run_command{.name = "run",
                          .summary = "Run experiments",
                          .example = "raytruth run experiments/xi_adaptive.json -o out --profile quick",
                          .notes = "",
                          .describe = describe};

}  // namespace raytruth
