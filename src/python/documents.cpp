#include "python/documents.hpp"

#include "experiments/advice_result.hpp"
#include "experiments/evaluate.hpp"
#include "experiments/experiment_folder.hpp"
#include "experiments/listing.hpp"
#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "experiments/runner.hpp"
#include "python/document.hpp"
#include "python/threads.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/documents/conformance/score_document.hpp"
#include "raytruth/documents/conformance/vectors.hpp"
#include "raytruth/documents/table_case.hpp"
#include "raytruth/tables/table_file.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth::python {

namespace py = pybind11;
using Json = nlohmann::ordered_json;

namespace {

py::object evaluate(py::handle cases, const std::optional<std::string>& data, std::optional<double> nan, bool programs,
                    int threads) {
  const Threads limit(threads);
  const Document document = read_document(cases, "case");
  const EvaluateRequest request{.volumes = volume_access(document, data, nan), .runs_programs = programs};
  std::vector<std::string> warnings;
  const Json answers = [&] {
    const py::gil_scoped_release without_lock;
    return evaluate_document(document.json, request, [&](const std::string& line) { warnings.push_back(line); });
  }();
  warn(warnings);
  return to_python(answers);
}

/// A table as Python holds it.
struct PythonTable {
  py::array values;  ///< as a file of the format has them
  py::object description;
};

PythonTable make_python_table(py::handle table_case, int threads) {
  const Threads limit(threads);
  const Document document = read_document(table_case, "case");
  std::vector<std::string> warnings;
  Json description;
  const std::string bytes = [&] {
    const py::gil_scoped_release without_lock;
    const TableCase asked = read_table_case(document.json, warnings);
    const MadeTable table = make_table(asked);
    if (const auto beyond = clamped_numbers(asked, table); beyond > 0)
      warnings.push_back(fmt::format("warning: {}: {} numbers above 1 are clamped to it, as {} holds no larger ones",
                                     document.json.place(), beyond, asked.format.name));
    description = table_description(asked, table, "array");
    description["build"] = build_identity();
    return npy_bytes(table.shape, table.values, asked.format);
  }();
  warn(warnings);
  const py::object file = py::module_::import("io").attr("BytesIO")(py::bytes(bytes));
  return {py::module_::import("numpy").attr("load")(file), to_python(description)};
}

VectorForm vector_form_of(const std::string& form) {
  const auto found = std::find(vector_form_names.begin(), vector_form_names.end(), form);
  if (found == vector_form_names.end())
    throw InputError(fmt::format("form: found {}; {} is allowed", form, fmt::join(vector_form_names, ", ")));
  return static_cast<VectorForm>(found - vector_form_names.begin());
}

py::object vectors(std::uint64_t seed, const std::string& form) {
  const VectorForm which = vector_form_of(form);
  const Json document = [&] {
    const py::gil_scoped_release without_lock;
    return vectors_json(seed, which);
  }();
  return to_python(document);
}

/// The answers in a dict of id: (red, green, blue, opacity), or in a CSV file.
std::map<std::string, Answer> answers_of(py::handle given) {
  if (!py::isinstance<py::dict>(given)) {
    std::vector<std::string> warnings;
    auto answers = read_answers(py::str(given).cast<std::string>(), warnings);
    warn(warnings);
    return answers;
  }
  std::map<std::string, Answer> answers;
  for (const auto& [id, value] : given.cast<py::dict>()) {
    const auto name = py::str(id).cast<std::string>();
    const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
    if (!numbers || numbers.ndim() != 1 || numbers.size() != 4) {
      PyErr_Clear();
      throw InputError(
          fmt::format("answers: {}: found no list of 4 numbers; red, green, blue, opacity are allowed", name));
    }
    const double* const x = numbers.data();
    answers[name] = {.color = {x[0], x[1], x[2]}, .opacity = x[3]};
  }
  return answers;
}

py::object score_answers(py::handle vectors_document, py::handle answers, const std::optional<std::string>& emission,
                         bool per_vector) {
  const Document document = read_document(vectors_document, "vectors");
  std::vector<ScoredVector> scored = read_scored_vectors(document.json);
  take_answers(scored, answers_of(answers), "answers", "the vectors");
  if (emission) {
    std::erase_if(scored, [&](const ScoredVector& vector) { return name_of(vector.emission) != *emission; });
    if (scored.empty())
      throw InputError(
          fmt::format("emission: found {}; one that vectors have, associated or plain, is allowed", *emission));
  }
  return to_python(per_vector ? scored_json(scored) : levels_json(score(scored)));
}

py::object available(const std::string& kind, const std::optional<std::string>& data) {
  const auto& kinds = listed_kinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw InputError(fmt::format("kind: found {}; {} is allowed", kind, fmt::join(kinds, ", ")));
  return to_python(list_of(kind, volume_folders(data.value_or(""))));
}

/// Gathers warnings, and hears Ctrl-C after every unit.
class PythonObserver final : public RunObserver {
 public:
  void begin(std::size_t /*units*/) override {}
  void show(std::string_view /*unit*/) override {}
  void advance(bool /*is_worked*/) override {
    const py::gil_scoped_acquire with_lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  void warn(std::string_view line) override { warnings.emplace_back(line); }

  std::vector<std::string> warnings;
};

py::object run(py::handle asked, const std::optional<std::string>& folder, const std::string& profile,
               std::optional<std::int64_t> seed, const std::optional<std::string>& gl,
               const std::optional<std::string>& data, bool programs, bool resume, int threads) {
  const Threads limit(threads);
  if (profile != "full" && profile != "quick")
    throw InputError(fmt::format("profile: found {}; full or quick is allowed", profile));
  if (gl && *gl != "osmesa" && *gl != "egl")
    throw InputError(fmt::format("gl: found {}; osmesa or egl is allowed", *gl));
  if (seed && *seed < 0) throw InputError(fmt::format("seed: found {}; a whole number >= 0 is allowed", *seed));
  if (resume && !folder) throw InputError("resume: found it without a folder; one is needed with it");
  const py::object source = py::isinstance<py::str>(asked)
                                ? py::object(py::str(find_experiment(asked.cast<std::string>())))
                                : py::reinterpret_borrow<py::object>(asked);
  const Document document = read_document(source, "experiment");
  Experiment experiment = read_experiment(document.json, profile, seed, gl);
  experiment.runs_programs = programs;
  warn(experiment.warnings);
  std::filesystem::path file;
  if (folder) {
    make_folder(*folder);
    file = std::filesystem::path(*folder) / (experiment.name + ".json");
  }
  const RunRequest request{.profile = profile, .resume = resume, .volumes = volume_access(document, data)};
  PythonObserver observer;
  const Json result = [&] {
    const py::gil_scoped_release without_lock;
    return run_experiment(experiment, request, file, observer);
  }();
  warn(observer.warnings);
  return to_python(result);
}

/// The error as the command line has it.
std::string error_text(py::handle error) {
  if (py::isinstance<py::str>(error)) return error.cast<std::string>();
  return fmt::format("{}", error.cast<double>());
}

py::object give_advice(py::handle scene, py::handle error, const std::string& of, std::int64_t views, std::int64_t rays,
                       std::uint64_t seed, const std::optional<std::string>& data, std::optional<double> nan,
                       int threads) {
  const Threads limit(threads);
  const Document document = read_document(scene, "scene");
  if (views < 1 || views > 100)
    throw InputError(fmt::format("views: found {}; a number from 1 to 100 is allowed", views));
  if (rays < 1) throw InputError(fmt::format("rays: found {}; a number from 1 on is allowed", rays));
  const AdviceDocument asked = read_advice_document(document.json, {.error = error_text(error),
                                                                    .of = of,
                                                                    .views = views,
                                                                    .seed = seed,
                                                                    .most_rays = rays,
                                                                    .volumes = volume_access(document, data, nan)});
  warn(asked.warnings);
  const Json result = [&] {
    const py::gil_scoped_release without_lock;
    return advice_result(asked, advise(asked.request, [](std::size_t /*done*/, std::size_t /*of*/) {
                           const py::gil_scoped_acquire with_lock;
                           if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                         }));
  }();
  return to_python(result);
}

}  // namespace

void add_documents(py::module_& module) {
  module.def("evaluate", &evaluate, py::arg("cases"), py::kw_only(), py::arg("data") = py::none(),
             py::arg("nan") = py::none(), py::arg("programs") = false, py::arg("threads") = 0,
             "Answers a case, or a list of cases, as `raytruth eval` does.");
  py::class_<PythonTable>(module, "Table", "A pre-integration table.")
      .def_readonly("values", &PythonTable::values, "Its numbers, as the file of `raytruth table` has them.")
      .def_readonly("description", &PythonTable::description, "What that command writes beside the file.");
  module.def("table", &make_python_table, py::arg("case"), py::kw_only(), py::arg("threads") = 0,
             "Makes a pre-integration table and measures its error, as `raytruth table` does.");
  module.def("vectors", &vectors, py::kw_only(), py::arg("seed") = 1,
             py::arg("form") = std::string(vector_form_names.back()), "The conformance vectors.");
  module.def("score", &score_answers, py::arg("vectors"), py::arg("answers"), py::kw_only(),
             py::arg("emission") = py::none(), py::arg("per_vector") = false,
             "How many digits are right in a program's answers to the vectors.");
  module.def("available", &available, py::arg("kind"), py::kw_only(), py::arg("data") = py::none(),
             "What there is of a kind: schemes, shadings, tables, experiments, volumes and so on.");
  module.def("advise", &give_advice, py::arg("scene"), py::arg("error"), py::kw_only(), py::arg("of") = "rmse",
             py::arg("views") = 6, py::arg("rays") = 16384, py::arg("seed") = 1, py::arg("data") = py::none(),
             py::arg("nan") = py::none(), py::arg("threads") = 0,
             "The cheapest way to render a scene that keeps an error, as `raytruth advise` finds it.");
  module.def(
      "schemes", [] { return available("schemes", {}); }, "What available('schemes') gives.");
  module.def("run", &run, py::arg("experiment"), py::kw_only(), py::arg("folder") = py::none(),
             py::arg("profile") = "full", py::arg("seed") = py::none(), py::arg("gl") = py::none(),
             py::arg("data") = py::none(), py::arg("programs") = false, py::arg("resume") = false,
             py::arg("threads") = 0, "Runs an experiment: a dict, a file, or the name of one that is installed.");
}

}  // namespace raytruth::python
