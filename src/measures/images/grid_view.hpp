#pragma once

#include "experiments/experiment.hpp"
#include "experiments/row.hpp"
#include "raytruth/documents/json/json_reader.hpp"
#include "raytruth/render/camera.hpp"
#include "raytruth/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

namespace raytruth {

/// A camera for grids of any size: lengths are in units of the grid's diagonal, places relative to its middle.
struct GridView {
  std::string kind;  ///< orthographic or perspective
  Camera camera;     ///< `eye` from the middle of the grid, `height` in diagonals
};

/// Reads "view" of experiments/schemas/experiment.json. Throws InputError.
GridView read_grid_view(const JsonReader& json, const std::array<std::int64_t, 2>& size);

/// Reads the width and height of a study's images.
std::array<std::int64_t, 2> read_image_size(const JsonReader& json);

/// The view of a grid.
Camera aimed(const GridView& view, const Grid& grid);

/// The rows of all views of a field, in their order; `rows_of(view)` gives those of one. An InputError in it is blamed
/// on `json`.
template <class View, class RowsOf>
std::vector<Row> rows_of_views(const std::vector<View>& views, const Field& field, const JsonReader& json,
                               const RowsOf& rows_of) {
  std::vector<Row> rows;
  for (const View& view : views) {
    if (view.field != field.name) continue;
    std::vector<Row> of_view = json.blame_for([&] { return rows_of(view); });
    rows.insert(rows.end(), std::make_move_iterator(of_view.begin()), std::make_move_iterator(of_view.end()));
  }
  return rows;
}

}  // namespace raytruth
