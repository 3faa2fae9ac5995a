#include "raytruth/documents/deformation_json.hpp"

#include "raytruth/deformation/displacement.hpp"
#include "raytruth/documents/case_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_cells = 256;  // on an axis
constexpr std::int64_t most_cells_in_all = 1 << 18;
constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};

Eigen::Vector3d read_point(const JsonReader& json) {
  const Vector3<double> vector = read_vector(json);
  return vector.matrix();
}

std::size_t read_axis(const JsonReader& json) {
  const std::string name = json.at("axis").word({axis_names.begin(), axis_names.end()});
  return static_cast<std::size_t>(std::find(axis_names.begin(), axis_names.end(), name) - axis_names.begin());
}

/// The volume's own box.
LatticeBox box_of(const Grid& grid, Border border, const std::array<double, 3>& spacing) {
  LatticeBox box;
  box.edges.setZero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<Eigen::Index>(axis);
    box.origin[index] = -margin_of(border) * spacing[axis];
    box.edges(index, index) = (static_cast<double>(grid.size[axis] - 1) + 2 * margin_of(border)) * spacing[axis];
  }
  return box;
}

LatticeBox read_box(const JsonReader& json, const LatticeBox& of_volume) {
  json.only({"origin", "u", "v", "w"});
  LatticeBox box{.origin = read_point(json.at("origin")), .edges = {}};
  box.edges.col(0) = read_point(json.at("u"));
  box.edges.col(1) = read_point(json.at("v"));
  box.edges.col(2) = read_point(json.at("w"));
  const std::array<std::int64_t, 3> one_cell{1, 1, 1};
  const Lattice lattice =
      json.blame_for([&] { return Lattice(box, one_cell, undisplaced_points(box, one_cell, Placement::greville)); });
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d weights(static_cast<double>(corner & 1U), static_cast<double>(corner >> 1U & 1U),
                                  static_cast<double>(corner >> 2U));
    const Eigen::Vector3d point = of_volume.origin + of_volume.edges * weights;
    const Eigen::Vector3d parameters = lattice.place_of(point).local;
    constexpr double rounding = 1e-12;
    if ((parameters.array() < -rounding).any() || (parameters.array() > 1 + rounding).any())
      json.refuse(fmt::format("a box without the volume's corner [{}, {}, {}]", point[0], point[1], point[2]),
                  "one that holds the whole volume");
  }
  return box;
}

Displacement read_displacement(const JsonReader& json) {
  const std::string kind = json.at("kind").word({"twist", "bend", "taper", "bulge", "affine", "random"});
  if (kind == "twist") {
    json.only({"kind", "axis", "degrees"});
    return Twist{.axis = read_axis(json), .degrees = json.at("degrees").number()};
  }
  if (kind == "bend") {
    json.only({"kind", "axis", "towards", "degrees"});
    json.at("axis").word({"z"});
    json.at("towards").word({"x"});
    return Bend{.degrees = json.at("degrees").number()};
  }
  if (kind == "taper") {
    json.only({"kind", "axis", "scale"});
    const auto scale = json.at("scale").numbers(2);
    if (scale.size() != 2) json.at("scale").refuse_value("a list of two numbers");
    return Taper{.axis = read_axis(json), .scale = {scale[0], scale[1]}};
  }
  if (kind == "bulge") {
    json.only({"kind", "axis", "amount"});
    return Bulge{.axis = read_axis(json), .amount = json.at("amount").number()};
  }
  if (kind == "affine") {
    json.only({"kind", "matrix", "offset"});
    Affine affine;
    const auto rows = json.at("matrix").items(3);
    if (rows.size() != 3) json.at("matrix").refuse_value("a list of three rows");
    for (std::size_t row = 0; row < 3; ++row)
      affine.matrix.row(static_cast<Eigen::Index>(row)) = read_point(rows[row]).transpose();
    if (const auto offset = json.find("offset")) affine.offset = read_point(*offset);
    return affine;
  }
  json.only({"kind", "amplitude", "seed"});
  RandomDisplacement random{.amplitude = json.at("amplitude").number()};
  if (const auto seed = json.find("seed"))
    random.seed = static_cast<std::uint64_t>(seed->integer(0, std::numeric_limits<std::int64_t>::max()));
  return random;
}

}  // namespace

Deformation read_deformation(const JsonReader& json, const Grid& grid, Border border,
                             const std::array<double, 3>& spacing) {
  json.only({"cells", "placement", "box", "displace", "points"});
  std::array<std::int64_t, 3> cells{};
  const auto counts = json.at("cells").items(3);
  if (counts.size() != 3) json.at("cells").refuse_value("a list of three whole numbers");
  std::int64_t in_all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells[axis] = counts[axis].integer(1, most_cells);
    in_all *= cells[axis];
  }
  if (in_all > most_cells_in_all)
    json.at("cells").refuse(fmt::format("{} cells", in_all), fmt::format("at most {}", most_cells_in_all));
  if (has_no_extent(grid, border)) json.refuse("a volume without extent", std::string(why_no_extent));
  const LatticeBox of_volume = box_of(grid, border, spacing);
  const auto stated_box = json.find("box");
  const LatticeBox box = stated_box ? read_box(*stated_box, of_volume) : of_volume;
  auto placement = Placement::greville;
  if (const auto word = json.find("placement"))
    placement = word->word({placement_names.begin(), placement_names.end()}) == "printed" ? Placement::printed
                                                                                          : Placement::greville;
  std::vector<Eigen::Vector3d> points;
  const auto stated = json.find("points");
  const auto displacements = json.find("displace");
  if (stated && displacements) displacements->refuse_value("either points or displace");
  if (stated) {
    for (const JsonReader& point : stated->items()) points.push_back(read_point(point));
  } else {
    points = undisplaced_points(box, cells, placement);
    std::vector<Displacement> list;
    if (displacements)
      for (const JsonReader& item : displacements->items(0)) list.push_back(read_displacement(item));
    displace(box, cells, list, points);
  }
  const JsonReader& place = stated ? *stated : json;
  Lattice lattice = place.blame_for([&] { return Lattice(box, cells, std::move(points)); });
  const LatticeProof proof = proof_of(lattice);
  if (!proof.refusal.empty())
    place.refuse(proof.refusal, "a deformation that is one to one, so a smaller displacement or more cells,");
  return {std::move(lattice), proof.least_determinant};
}

}  // namespace raytruth
