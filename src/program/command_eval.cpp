#include "experiments/output.hpp"
#include "program/command.hpp"
#include "raytruth/documents/case.hpp"
#include "raytruth/documents/conformance/outside_answers.hpp"
#include "raytruth/documents/scene_case.hpp"
#include "raytruth/documents/slab_case.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <nlohmann/json.hpp>

#include <utility>
#include <variant>

namespace raytruth {

namespace {

struct EvalOptions {
  std::string file;
  int threads = 0;
  bool runs_programs = false;
  VolumeOptions volumes;
};

/// Answers a case of any kind.
struct Evaluation {
  bool runs_programs;

  nlohmann::ordered_json operator()(const Case& ray) const {
    nlohmann::ordered_json answer = evaluate(ray);
    add_outside_answers(ray, runs_programs, answer);
    return answer;
  }
  nlohmann::ordered_json operator()(const SlabCase& slab) const { return evaluate(slab); }
  nlohmann::ordered_json operator()(const SceneFile& scene) const { return evaluate(scene, runs_programs); }
};

int evaluate_cases(const EvalOptions& options) {
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));

  const JsonReader document = JsonReader::from_file(options.file);
  const VolumeAccess volumes = volume_access(options.volumes);
  CaseReader reader(volumes);
  std::vector<std::string> warnings;
  std::vector<std::size_t> first_warnings;  // of each case
  std::vector<std::variant<Case, SlabCase, SceneFile>> cases;
  for (const JsonReader& item : document.is_array() ? document.items() : std::vector{document}) {
    first_warnings.push_back(warnings.size());
    if (is_slab_case(item)) {
      cases.emplace_back(read_slab_case(item, warnings));
    } else if (is_scene_case(item)) {
      SceneFile scene = read_scene(item, {.volumes = volumes, .opacity = {}});
      warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
      cases.emplace_back(std::move(scene));
    } else {
      cases.emplace_back(reader.read(item, warnings));
    }
  }
  first_warnings.push_back(warnings.size());
  for (const std::string& warning : warnings) say(warning);

  std::vector<nlohmann::ordered_json> answers(cases.size());
  std::vector<std::string> errors(cases.size());
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    try {
      answers[i] = std::visit(Evaluation{options.runs_programs}, cases[i]);
      for (std::size_t warning = first_warnings[i]; warning < first_warnings[i + 1]; ++warning)
        answers[i]["warnings"].push_back(warnings[warning]);
    } catch (const InputError& error) {
      errors[i] = error.what();
    }
  });
  // The first one in the file, whichever thread met one first.
  for (const std::string& error : errors)
    if (!error.empty()) throw InputError(error);
  print((document.is_array() ? nlohmann::ordered_json(answers) : answers.front()).dump(2) + "\n");
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
