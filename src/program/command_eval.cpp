#include "experiments/evaluate.hpp"
#include "experiments/output.hpp"
#include "program/command.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <nlohmann/json.hpp>

#include <string>

namespace raytruth {

namespace {

struct EvalOptions {
  std::string file;
  int threads = 0;
  bool runs_programs = false;
  VolumeOptions volumes;
};

int evaluate_cases(const EvalOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const JsonReader document = JsonReader::from_file(options.file);
  const EvaluateRequest request{.volumes = volume_access(options.volumes), .runs_programs = options.runs_programs};
  print(evaluate_document(document, request, [](const std::string& warning) { say(warning); }).dump(2) + "\n");
  return 0;
}

std::function<int()> describe(CommandOptions& add) {
  const auto options = std::make_shared<EvalOptions>();
  add.operand("case", options->file, "JSON file; '-' is standard input");
  add.threads(options->threads);
  add.programs(options->runs_programs);
  add.data(options->volumes);
  add.nan(options->volumes);
  return [options] { return evaluate_cases(*options); };
}

}  // namespace

extern const Command eval_command;
const Command eval_command{
    .name = "eval",
    .summary = "Evaluate one ray, slab or scene, or an array of them, by the schemes they name",
    .example = "raytruth eval ray.json",
    .notes =
        "The reference of rays, of slabs and of scenes without light is certified: `error_bound` is "
        "proven. That of lit\n"
        "scenes is an estimate: `measured_radius`. Rays through volumes and scenes state where the volume\n"
        "ends, their \"border\": \"half_voxel\" beyond the outermost centres (the default) or at the\n"
        "\"voxel_centres\".\n"
        "\n"
        "A scheme may be a program, {\"program\": [\"python3\", \"mine.py\"], \"name\": \"mine\"}: of a ray it reads\n"
        "vectors as JSON and writes CSV, of a scene it reads that and writes a .npy. It runs with --programs only.",
    .describe = describe};

}  // namespace raytruth
