#include "experiments/merge.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/command.hpp"
#include "program/run_report.hpp"
#include "raytruth/core/one_line.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

struct MergeOptions {
  std::vector<std::string> places;
  std::string result;
  std::optional<std::string> recheck;
  bool mixed_cpus = false;
  bool without_times = false;
  bool check = false;
  bool runs_programs = false;
  int threads = 0;  ///< 0: all cores
  VolumeOptions volumes;
};

/// "1%" as 0.01.
double read_share(const std::string& text) {
  double percent = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, percent);
  if (read.ec != std::errc() || std::string_view(read.ptr, end) != "%" || !(percent > 0 && percent <= 100))
    throw InputError(one_line(fmt::format("--recheck: found {}; more than 0% and at most 100% is allowed", text)));
  return percent / 100;
}

/// The file, or the experiment's in the folder, that the result goes to: a name without an extension is a folder's,
/// which is made. No part is overwritten.
std::filesystem::path result_file(const MergeOptions& options, const Merged& merged) {
  std::filesystem::path file = options.result;
  std::error_code ignored;
  if (!file.has_extension() && !std::filesystem::exists(file, ignored)) make_folder(file);
  if (std::filesystem::is_directory(file, ignored)) file /= merged.experiment->name + ".json";
  for (const std::string& part : merged.parts)
    if (std::filesystem::equivalent(part, file, ignored))
      throw InputError(fmt::format("{}: found a part where the result would go; another file is allowed", part));
  return file;
}

int merge(const MergeOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const MergeRequest request{.places = options.places,
                             .recheck = options.recheck ? read_share(*options.recheck) : 0,
                             .mixed_cpus = options.mixed_cpus,
                             .runs_programs = options.runs_programs,
                             .has_times = !options.without_times,
                             .volumes = volume_access(options.volumes)};
  BarObserver observer;
  const Merged merged = merge_parts(request, observer);
  for (const std::string& warning : merged.experiment->warnings) say(warning);
  const std::filesystem::path file = result_file(options, merged);
  write_whole(file, result_text(merged.result));
  const bool all_hold = report(*merged.experiment, merged.profile, merged.result, file);
  return options.check && !all_hold ? 1 : 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<MergeOptions>();
  add.operands("part", options->places, "Parts that `raytruth run --shard` made, and folders of them");
  add.required_text("-o", "RESULT", options->result,
                    "Write the result to this file, or as NAME.json into this folder (a name without extension)");
  add.text("--recheck", "P%", options->recheck,
           "Do so many percent of the units again, at least one, chosen at random");
  add.flag("--mixed-cpus", options->mixed_cpus,
           "Take parts of several processors, though last digits may differ between them");
  add.flag("--without-times", options->without_times,
           "Leave threads, seconds and the time out of the provenance, so that results compare by their bytes");
  add.flag("--check", options->check, "Exit with 1 if a bound that the experiment states does not hold");
  add.programs(options->runs_programs);
  add.threads(options->threads);
  add.data(options->volumes);
  return [options] { return merge(*options); };
}

}  // namespace

extern const Command merge_command;
const Command merge_command{
    .name = "merge",
    .summary = "Make one result of the parts of an experiment",
    .example = "raytruth merge parts -o out/orders.json --recheck 1%",
    .notes =
        "The result is that of one run, byte for byte, but for the provenance: `seconds` is the sum over all\n"
        "units, `threads` the most of a part, `parts` their number; --without-times leaves these out, there and in\n"
        "`raytruth run`. Parts must be of one experiment, seed, profile, processor and build, that of this program;\n"
        "what two parts hold must agree. Their digests tell damage; who would deceive is found by --recheck alone.",
    .describe = describe};

}  // namespace raytruth
