#include "measures/images/studied_view.hpp"

#include "raytruth/core/named.hpp"

#include <algorithm>
#include <utility>

namespace raytruth {

std::string read_new_name(const JsonReader& json, const std::vector<std::string_view>& taken) {
  std::string name = json.text();
  if (std::find(taken.begin(), taken.end(), name) != taken.end()) json.refuse_value("a name that nothing else has");
  return name;
}

const NamedTransfer& read_transfer(const Experiment& experiment, const JsonReader& json) {
  return *find_named(experiment.transfers, json.at("transfer").word(names_of(experiment.transfers)));
}

StudiedView read_studied_view(const Experiment& experiment, const JsonReader& json,
                              const std::array<std::int64_t, 2>& size, const std::vector<std::string_view>& taken) {
  return {.name = read_new_name(json.at("name"), taken),
          .field = json.at("field").word(names_of(experiment.fields)),
          .transfer = read_transfer(experiment, json),
          .camera = read_grid_view(json.at("camera"), size),
          .place = json};
}

Scene scene_of(const StudiedView& view, Scene drawing, const Experiment& experiment, const Grid& grid) {
  drawing.grid = grid;
  drawing.transfer = view.transfer.transfer;
  drawing.emission = experiment.emission;
  drawing.camera = aimed(view.camera, grid);
  return drawing;
}

}  // namespace raytruth
