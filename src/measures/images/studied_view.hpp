#pragma once

#include "experiments/experiment.hpp"
#include "measures/images/grid_view.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/render/scene.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

/// What a study of images looks at: a field of the experiment under one of its transfer functions, from a camera.
struct StudiedView {
  std::string name;
  std::string field;
  NamedTransfer transfer;
  GridView camera;
  JsonReader place;  ///< in the experiment, which errors of rendering name
};

/// A name that none of these is. Throws InputError.
std::string read_new_name(const JsonReader& json, const std::vector<std::string_view>& taken);

/// The transfer function of the experiment that "transfer" names. Throws InputError.
const NamedTransfer& read_transfer(const Experiment& experiment, const JsonReader& json);

/// Reads "name", "field", "transfer" and "camera" of a view; names that are taken are refused. Throws InputError.
StudiedView read_studied_view(const Experiment& experiment, const JsonReader& json,
                              const std::array<std::int64_t, 2>& size, const std::vector<std::string_view>& taken);

/// The scene that shows the view of the field's grid; `drawing` says how it is rendered.
Scene scene_of(const StudiedView& view, Scene drawing, const Experiment& experiment, const Grid& grid);

/// The names of views, each of which holds a StudiedView `seen`.
template <class View>
std::vector<std::string_view> names_of_views(const std::vector<View>& views) {
  std::vector<std::string_view> names;
  for (const View& view : views) names.emplace_back(view.seen.name);
  return names;
}

/// The records of all views of a field, in their order; `records_of(view)` gives those of one. An InputError in it is
/// blamed on the view.
template <class View, class RecordsOf>
auto records_of_views(const std::vector<View>& views, const Field& field, const RecordsOf& records_of) {
  decltype(records_of(views.front())) records;
  for (const View& view : views) {
    if (view.seen.field != field.name) continue;
    auto of_view = view.seen.place.blame_for([&] { return records_of(view); });
    records.insert(records.end(), std::make_move_iterator(of_view.begin()), std::make_move_iterator(of_view.end()));
  }
  return records;
}

}  // namespace raytruth
