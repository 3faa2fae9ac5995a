#include "experiments/experiment_folder.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "experiments/runner.hpp"
#include "experiments/shard.hpp"
#include "program/command.hpp"
#include "program/interruption.hpp"
#include "program/run_report.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

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
  bool runs_programs = false;
  bool without_times = false;
  std::optional<std::string> shard;
  VolumeOptions volumes;
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

/// What Ctrl-C says.
std::string notice(const RunOptions& options) {
  if (!options.folder)
    return "\nraytruth: interrupted; with -o DIR what is done would be kept, and --resume would go on with it\n";
  std::string command = "raytruth run";
  for (const std::string& experiment : options.experiments) command += " " + experiment;
  if (options.profile != "full") command += " --profile " + options.profile;
  if (options.seed) command += fmt::format(" --seed {}", *options.seed);
  if (options.gl) command += " --gl " + *options.gl;
  if (options.threads > 0) command += fmt::format(" -j {}", options.threads);
  if (!options.volumes.data.empty()) command += " --data " + options.volumes.data;
  if (memory_limit() != default_memory_limit()) command += fmt::format(" --memory-limit {}", memory_limit());
  if (options.check) command += " --check";
  if (options.runs_programs) command += " --programs";
  if (options.without_times) command += " --without-times";
  if (options.shard) command += " --shard " + *options.shard;
  command += fmt::format(" -o {}{}", *options.folder, options.shard ? "" : " --resume");
  return fmt::format("\nraytruth: interrupted; what is done is kept, and this goes on with it: {}\n",
                     one_line(command));
}

/// Does a part of each experiment. What is stated of the whole is judged when the parts are merged.
void run_shards(const std::vector<Experiment>& experiments, const RunOptions& options, const RunRequest& request) {
  const Shard shard = read_shard(*options.shard);
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    const Experiment& experiment = experiments[i];
    BarObserver observer;
    const auto file = run_shard(experiment, options.experiments[i], shard, request, *options.folder, observer);
    const auto units = units_of(experiment);
    say(fmt::format("{}: {} of {} units are in {}", experiment.name, units_of_shard(units, shard).size(), units.size(),
                    file.string()));
  }
}

/// Refuses options that do not go together.
void check_options(const RunOptions& options) {
  if (!options.folder && options.experiments.size() > 1)
    throw InputError(fmt::format("run: found {} experiments without -o; one is allowed", options.experiments.size()));
  if (!options.folder && options.resume) throw InputError("run: found --resume without -o; -o DIR is needed with it");
  if (!options.shard) return;
  read_shard(*options.shard);
  if (!options.folder) throw InputError("run: found --shard without -o; -o DIR is needed with it, for the part");
  for (const auto& [name, is_given] : {std::pair("--check", options.check), {"--without-times", options.without_times}})
    if (is_given)
      throw InputError(fmt::format("run: found {} beside --shard; `raytruth merge` of all parts takes it", name));
}

int run_experiments(const RunOptions& options) {
  check_options(options);
  std::vector<std::string> files;
  for (const std::string& asked : options.experiments) {
    files.push_back(find_experiment(asked));
    if (files.back() != asked) say(fmt::format("{}: {}", asked, files.back()));
  }
  std::vector<Experiment> experiments;
  for (const std::string& path : files) {
    Experiment experiment = read_experiment(path, options.profile, options.seed, options.gl);
    for (const std::string& warning : experiment.warnings) say(warning);
    experiment.runs_programs = options.runs_programs;
    for (const Experiment& other : experiments)
      if (other.name == experiment.name) experiment.json.at("name").refuse_value("one experiment of each name");
    experiments.push_back(std::move(experiment));
  }
  for (const Experiment& experiment : experiments)
    for (const std::string& path : files) refuse_overwriting(path, result_file(options, experiment));
  if (options.folder) make_folder(*options.folder);

  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const RunRequest request{.profile = options.profile,
                           .resume = options.resume,
                           .has_times = !options.without_times,
                           .volumes = volume_access(options.volumes)};
  const auto run = [&request](const Experiment& experiment, const std::filesystem::path& file) {
    BarObserver observer;
    return run_experiment(experiment, request, file, observer);
  };
  const InterruptionNotice told_at_ctrl_c(notice(options));
  if (options.shard) {
    run_shards(experiments, options, request);
    return 0;
  }
  bool all_hold = true;
  for (const Experiment& experiment : experiments) {
    const auto file = result_file(options, experiment);
    const auto result = run(experiment, file);
    if (file.empty()) print(result_text(result));
    all_hold = report(experiment, options.profile, result, file) && all_hold;
  }
  return options.check && !all_hold ? 1 : 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<RunOptions>();
  add.operands("experiment", options->experiments,
               "JSON files, or names that `raytruth list experiments` has; '-' is standard input");
  add.text("-o", "DIR", options->folder, "Write NAME.json into this folder (default: to standard output)");
  add.threads(options->threads);
  add.word("--profile", options->profile, {"quick", "full"}, "quick: a smaller version, in seconds (default: full)");
  add.seed(options->seed, "Instead of the experiment's");
  add.word("--gl", options->gl, {"osmesa", "egl"},
           "Run shaders by osmesa or by egl, a GPU's driver (default: the experiment's)");
  add.flag("--check", options->check, "Exit with 1 if a bound that the experiment states does not hold");
  add.programs(options->runs_programs);
  add.flag("--resume", options->resume, "Finish an interrupted run; needs -o");
  add.text(
      "--shard", "K/N", options->shard,
      "Do the K-th of N parts of the units into NAME.K-of-N.part, needs -o; again after an interruption it goes on");
  add.flag("--without-times", options->without_times,
           "Leave threads, seconds and the time out of the provenance, so that runs compare by their bytes");
  add.data(options->volumes);
  return [options] { return run_experiments(*options); };
}

}  // namespace

extern const Command run_command;
const Command run_command{
    .name = "run",
    .summary = "Run experiments",
    .example = "raytruth run experiments/xi_adaptive.json -o out --profile quick",
    .notes =
        "The parts that --shard makes, on as many machines as there are, become the result of one run by\n"
        "`raytruth merge`. experiments/launch has what GNU parallel, Slurm and MPI need to start them.",
    .describe = describe};

}  // namespace raytruth
