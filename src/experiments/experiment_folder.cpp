#include "experiments/experiment_folder.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/json/json_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace raytruth {

namespace {

/// Where experiments are looked for, the first one that exists; empty: nowhere.
std::filesystem::path experiment_folder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const std::array folders{std::filesystem::path("experiments"), program / "../../experiments",
                           program / "../share/raytruth/experiments"};
  const auto found = std::find_if(folders.begin(), folders.end(), [&error](const std::filesystem::path& folder) {
    return std::filesystem::is_directory(folder, error);
  });
  return found == folders.end() ? std::filesystem::path() : found->lexically_normal();
}

}  // namespace

std::vector<ExperimentFile> find_experiments() {
  std::vector<ExperimentFile> experiments;
  const auto folder = experiment_folder();
  if (folder.empty()) return experiments;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".json") continue;
    try {
      const auto& file = entry.path();
      const JsonReader json = JsonReader::from_file(file.string());
      json.at("raytruth").word({"experiment/1"});
      experiments.push_back({json.at("name").text(), json.at("question").text(), file});
    } catch (const InputError&) {
      continue;  // some other JSON
    }
  }
  std::sort(experiments.begin(), experiments.end(),
            [](const ExperimentFile& a, const ExperimentFile& b) { return a.name < b.name; });
  return experiments;
}

std::string find_experiment(const std::string& asked) {
  std::error_code error;
  // What has a folder or an extension, and standard input, is no name: reading it says what is wrong with it.
  const bool is_name = asked != "-" && std::filesystem::path(asked).filename() == asked && !asked.ends_with(".json");
  if (!is_name || std::filesystem::exists(asked, error)) return asked;
  const auto experiments = find_experiments();
  std::vector<std::string_view> names;
  for (const ExperimentFile& experiment : experiments) {
    if (experiment.name == asked) return experiment.file.string();
    names.emplace_back(experiment.name);
  }
  const auto closest = closest_word(asked, names);
  throw InputError(fmt::format(
      "{}: no such file{}; a file is allowed, or a name that `raytruth list experiments` tells", one_line(asked),
      experiments.empty() ? std::string(", and no folder of experiments is at hand")
                          : fmt::format(", nor an experiment in {}{}", experiment_folder().string(),
                                        closest.empty() ? "" : fmt::format(" (perhaps {})", closest))));
}

}  // namespace raytruth
