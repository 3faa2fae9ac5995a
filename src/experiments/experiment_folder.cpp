#include "experiments/experiment_folder.hpp"

#include "raytruth/documents/json/json_reader.hpp"

#include <algorithm>
#include <system_error>

namespace raytruth {

std::vector<ExperimentFile> find_experiments() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const auto& folder : {std::filesystem::path("experiments"), program / "../../experiments",
                             program / "../share/raytruth/experiments"}) {
    if (!std::filesystem::is_directory(folder, error)) continue;
    std::vector<ExperimentFile> experiments;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() != ".json") continue;
      try {
        const auto file = entry.path().lexically_normal();
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
  return {};
}

}  // namespace raytruth
