#include "experiments/experiment_folder.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "experiments/runner.hpp"
#include "program/command.hpp"
#include "program/progress_bar.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <csignal>
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
  VolumeOptions volumes;
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

/// While it lives, Ctrl-C ends the program with a line that names the command which goes on.
class InterruptionNotice {
 public:
  explicit InterruptionNotice(const std::string& line) {
    // What a handler of signals may read: all of it stands before the handler does.
    const std::size_t size = std::min(line.size(), text_.size());
    std::copy_n(line.begin(), size, text_.begin());
    size_ = static_cast<std::sig_atomic_t>(size);
    previous_ = std::signal(SIGINT, &tell);
  }
  ~InterruptionNotice() { std::signal(SIGINT, previous_); }
  InterruptionNotice(const InterruptionNotice&) = delete;
  InterruptionNotice& operator=(const InterruptionNotice&) = delete;
  InterruptionNotice(InterruptionNotice&&) = delete;
  InterruptionNotice& operator=(InterruptionNotice&&) = delete;

 private:
  /// Only calls that POSIX allows in a handler; who started the program learns that the signal ended it.
  static void tell(int signal) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text_.data(), static_cast<std::size_t>(size_));
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

  static inline std::array<char, 4096> text_{};
  static inline volatile std::sig_atomic_t size_ = 0;
  void (*previous_)(int) = nullptr;
};

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
  if (options.volumes.memory_limit) command += fmt::format(" --memory-limit {}", *options.volumes.memory_limit);
  if (options.check) command += " --check";
  if (options.runs_programs) command += " --programs";
  command += fmt::format(" -o {} --resume", *options.folder);
  return fmt::format("\nraytruth: interrupted; what is done is kept, and this goes on with it: {}\n",
                     one_line(command));
}

/// Tells what the publications state beside what was measured, and whether the bounds hold; false where one does not.
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

int run_experiments(const RunOptions& options) {
  if (!options.folder && options.experiments.size() > 1)
    throw InputError(fmt::format("run: found {} experiments without -o; one is allowed", options.experiments.size()));
  if (!options.folder && options.resume) throw InputError("run: found --resume without -o; -o DIR is needed with it");
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
  const RunRequest request{
      .profile = options.profile, .resume = options.resume, .volumes = volume_access(options.volumes)};
  const auto run = [&request](const Experiment& experiment, const std::filesystem::path& file) {
    BarObserver observer;
    return run_experiment(experiment, request, file, observer);
  };
  const InterruptionNotice told_at_ctrl_c(notice(options));
  bool all_hold = true;
  for (const Experiment& experiment : experiments) {
    const auto file = result_file(options, experiment);
    const auto result = run(experiment, file);
    if (file.empty()) print(result_text(result));
    all_hold = report(experiment, options.profile, result) && all_hold;
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
  add.data(options->volumes);
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
