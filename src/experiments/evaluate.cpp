#include "experiments/evaluate.hpp"

#include "raytruth/documents/case.hpp"
#include "raytruth/documents/conformance/outside_answers.hpp"
#include "raytruth/documents/scene_case.hpp"
#include "raytruth/documents/scene_document.hpp"
#include "raytruth/documents/slab_case.hpp"

#include <tbb/parallel_for.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

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

}  // namespace

nlohmann::ordered_json evaluate_document(const JsonReader& document, const EvaluateRequest& request,
                                         const std::function<void(const std::string&)>& warn) {
  CaseReader reader(request.volumes);
  std::vector<std::string> warnings;
  std::vector<std::size_t> first_warnings;  // of each case
  std::vector<std::variant<Case, SlabCase, SceneFile>> cases;
  for (const JsonReader& item : document.is_array() ? document.items() : std::vector{document}) {
    first_warnings.push_back(warnings.size());
    if (is_slab_case(item)) {
      cases.emplace_back(read_slab_case(item, warnings));
    } else if (is_scene_case(item)) {
      SceneFile scene = read_scene(item, {.volumes = request.volumes, .opacity = {}});
      warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
      cases.emplace_back(std::move(scene));
    } else {
      cases.emplace_back(reader.read(item, warnings));
    }
  }
  first_warnings.push_back(warnings.size());
  for (const std::string& warning : warnings) warn(warning);

  std::vector<nlohmann::ordered_json> answers(cases.size());
  std::vector<std::string> errors(cases.size());
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    try {
      answers[i] = std::visit(Evaluation{request.runs_programs}, cases[i]);
      for (std::size_t warning = first_warnings[i]; warning < first_warnings[i + 1]; ++warning)
        answers[i]["warnings"].push_back(warnings[warning]);
    } catch (const InputError& error) {
      errors[i] = error.what();
    }
  });
  // The first one in the file, whichever thread met one first.
  for (const std::string& error : errors)
    if (!error.empty()) throw InputError(error);
  return document.is_array() ? nlohmann::ordered_json(answers) : answers.front();
}

}  // namespace raytruth
