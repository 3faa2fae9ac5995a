#include "raytruth/documents/mesh_source.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/field_document.hpp"
#include "raytruth/documents/mesh_files/mesh_file.hpp"
#include "raytruth/volume/files/find_volume.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <system_error>
#include <utility>

namespace raytruth {

namespace {

std::shared_ptr<const TetrahedralField> shared_field(TetrahedralMesh mesh) {
  return std::make_shared<const TetrahedralField>(std::move(mesh));
}

SourcedMesh read_mesh_file(const JsonReader& place, const std::string& name, const std::optional<std::string>& array,
                           const VolumeAccess& volumes) {
  const auto path = find_mesh(place, name, volumes);
  MeshFile file = place.blame_for([&] { return read_mesh(path, array); });
  SourcedMesh result{.field = shared_field(std::move(file.mesh)), .file = path.filename().string()};
  for (const std::string& warning : file.warnings)
    result.warnings.push_back(fmt::format("{}: warning: {}: {}", place.place(), result.file, warning));
  return result;
}

SourcedMesh read_inline_mesh(const JsonReader& json) {
  json.only({"points", "tetrahedra", "scalars", "cell_scalars"});
  TetrahedralMesh mesh;
  for (const JsonReader& point : json.at("points").items()) {
    const auto coordinates = point.numbers();
    if (coordinates.size() != 3) point.refuse_value("a list of three numbers");
    mesh.points.push_back({coordinates[0], coordinates[1], coordinates[2]});
  }
  constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
  std::size_t cell = 0;
  for (const JsonReader& tetrahedron : json.at("tetrahedra").items()) {
    const auto corners = tetrahedron.items();
    if (corners.size() != 4) tetrahedron.refuse_value("a list of four points' numbers");
    auto& to = mesh.tetrahedra.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::int64_t point = corners[k].integer(-most, most);
      if (point < 0 || point >= std::ssize(mesh.points))
        tetrahedron.refuse(fmt::format("the point {} in cell {}", point, cell),
                           fmt::format("0 to {}", std::ssize(mesh.points) - 1));
      to[k] = static_cast<std::uint32_t>(point);
    }
    ++cell;
  }
  const auto scalars = json.find("scalars");
  const auto cell_scalars = json.find("cell_scalars");
  if (scalars && cell_scalars) cell_scalars->refuse_value("either scalars or cell_scalars");
  if (cell_scalars)
    mesh.cell_scalars = cell_scalars->numbers();
  else
    mesh.scalars = json.at("scalars").numbers();
  json.blame_for([&mesh] {
    complete(mesh);
    return 0;
  });
  return {.field = shared_field(std::move(mesh))};
}

}  // namespace

std::filesystem::path find_mesh(const JsonReader& owner, const std::string& name, const VolumeAccess& volumes) {
  auto beside = owner.resolve(name);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(beside, ignored)) return beside;
  if (name.find('/') != std::string::npos)
    throw VolumeAbsent(fmt::format("{}: {}: no such file", owner.place(), one_line(name)));
  return owner.blame_for([&] { return find_volume(name, volumes.folders); });
}

SourcedMesh read_mesh_source(const JsonReader& mesh, const VolumeAccess& volumes) {
  if (!mesh.is_object()) return read_mesh_file(mesh, mesh.text(), {}, volumes);
  if (const auto file = mesh.find("file")) {
    mesh.only({"file", "array"});
    std::optional<std::string> array;
    if (const auto name = mesh.find("array")) array = name->text();
    return read_mesh_file(*file, file->text(), array, volumes);
  }
  if (mesh.find("volume")) {
    mesh.only({"volume", "repair", "nan", "time_step", "spacing", "split", "parity"});
    return read_split_volume(mesh, volumes);
  }
  return read_inline_mesh(mesh);
}

SourcedMesh read_split_volume(const JsonReader& owner, const VolumeAccess& volumes) {
  const std::int64_t split = owner.at("split").integer(5, 6);
  SplitParity parity = SplitParity::even;
  if (const auto stated = owner.find("parity")) {
    if (split == 6) stated->refuse_value("a split into 5, for 6 tetrahedra are the same in every cube; no parity");
    if (stated->word({"even", "odd"}) == "odd") parity = SplitParity::odd;
  }
  SourcedVolume volume = make_volume(read_volume_member(owner, false), volumes);
  SourcedMesh result{.field = {}, .file = std::move(volume.file), .warnings = std::move(volume.warnings)};
  if (const auto spacing = owner.find("spacing"))
    result.warnings.push_back(spacing->place() + ": warning: it changes nothing: the mesh is in voxels");
  result.field = owner.at("volume").blame_for(
      [&] { return shared_field(split_grid(volume.grid, static_cast<GridSplit>(split), parity)); });
  return result;
}

}  // namespace raytruth
