#include "measures/images/grid_view.hpp"

#include <cmath>
#include <variant>

namespace raytruth {

namespace {

constexpr std::int64_t largest_side = 4096;
constexpr double most_diagonals = 1000;

std::array<double, 3> read_point(const JsonReader& json) {
  const auto items = json.items(3);
  if (items.size() != 3) json.refuse_value("three numbers");
  const auto coordinate = [&items](std::size_t axis) { return items[axis].number(-most_diagonals, most_diagonals); };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

double read_height(const JsonReader& json) {
  json.positive_number();
  return json.number(0, most_diagonals);
}

}  // namespace

GridView read_grid_view(const JsonReader& json, const std::array<std::int64_t, 2>& size) {
  GridView view{.kind = json.at("kind").word({"orthographic", "perspective"}),
                .camera = {.eye = read_point(json.at("from")),
                           .target = {},
                           .up = read_point(json.at("up")),
                           .projection = {},
                           .size = size}};
  if (view.kind == "orthographic") {
    json.only({"kind", "from", "up", "height"});
    view.camera.projection = Orthographic{read_height(json.at("height"))};
  } else {
    json.only({"kind", "from", "up", "fov_y"});
    view.camera.projection = Perspective{json.at("fov_y").positive_number()};
  }
  json.blame_for([&view] { return CameraView(view.camera, {1, 1, 1}); });
  return view;
}

std::array<std::int64_t, 2> read_image_size(const JsonReader& json) {
  const auto sides = json.items(2);
  if (sides.size() != 2) json.refuse_value("width and height");
  return {sides[0].integer(1, largest_side), sides[1].integer(1, largest_side)};
}

Camera aimed(const GridView& view, const Grid& grid) {
  Camera camera = view.camera;
  double diagonal = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double extent = grid.spacing[axis] * static_cast<double>(grid.size[axis]);
    camera.target[axis] = (extent - grid.spacing[axis]) / 2;
    diagonal = std::hypot(diagonal, extent);
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    camera.eye[axis] = camera.target[axis] + diagonal * view.camera.eye[axis];
  if (auto* parallel = std::get_if<Orthographic>(&camera.projection)) parallel->height *= diagonal;
  return camera;
}

}  // namespace raytruth
