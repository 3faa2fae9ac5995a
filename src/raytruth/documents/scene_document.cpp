#include "raytruth/documents/scene_document.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/documents/camera_json.hpp"
#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/deformation_json.hpp"
#include "raytruth/documents/field_document.hpp"
#include "raytruth/documents/mesh_source.hpp"
#include "raytruth/documents/radius_axis_json.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/documents/scene_warnings.hpp"
#include "raytruth/documents/surface_numbers.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/suitable_surfaces.hpp"
#include "raytruth/tables/table3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <variant>

namespace raytruth {

namespace {

constexpr std::int64_t most_table_iterations = 4096;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

template <class Names>
std::vector<std::string_view> words(const Names& names) {
  return {names.begin(), names.end()};
}

/// The value of an enumeration whose names stand in a list.
template <class Enumeration, class Names>
Enumeration read_word(const JsonReader& json, const Names& names) {
  const std::string word = json.word(words(names));
  return static_cast<Enumeration>(std::find(names.begin(), names.end(), word) - names.begin());
}

std::array<double, 3> read_place(const JsonReader& json) {
  const Vector3<double> vector = read_vector(json);
  return {vector[0], vector[1], vector[2]};
}

/// The voxels, and where they come from.
Grid read_voxels(const JsonReader& json, const SceneOptions& options, SceneFile& result) {
  const JsonReader place = json.at("volume");
  const FieldDocument field = read_volume_member(json, true);
  if (const auto* const file = std::get_if<VolumeFile>(&field))
    place.blame_for([&] { return find_volume_file(*file, options.volumes); });  // absent: an error of this place
  SourcedVolume read = make_volume(field, options.volumes);
  result.volume = std::holds_alternative<GeneratedField>(field) ? place.json()
                  : read.file.empty()                           ? nlohmann::ordered_json("inline")
                                                                : nlohmann::ordered_json(read.file);
  result.warnings = std::move(read.warnings);
  if (!read.has_spacing)
    result.warnings.push_back(fmt::format(
        "{}: warning: {}: the file states no spacing, so 1 is taken along every axis; \"spacing\": [x, y, z] "
        "beside \"volume\" states it",
        place.place(), read.file));
  return std::move(read.grid);
}

/// Refuses what stands beside a mesh but belongs to a volume.
void refuse_volumes_members(const JsonReader& json) {
  for (const std::string_view of_a_volume :
       {"volume", "repair", "nan", "time_step", "spacing", "border", "reconstruction", "table", "shading",
        "early_termination", "empty_space", "step", "deformation"})
    if (const auto stated = json.find(of_a_volume))
      stated->refuse(fmt::format("{} beside a mesh", of_a_volume),
                     "a mesh with the reference, or with a scheme and the sampling cells,");
}

/// The tetrahedra, and the voxel that stands where a scene has a grid.
void read_mesh(const JsonReader& json, const SceneOptions& options, SceneFile& result) {
  const JsonReader place = json.at("mesh");
  if (!options.only_renders) place.refuse("a mesh", "one where an image is rendered; here a volume");
  SourcedMesh read = read_mesh_source(place, options.volumes);
  result.volume = read.file.empty() ? nlohmann::ordered_json("inline") : nlohmann::ordered_json(read.file);
  result.warnings = std::move(read.warnings);
  result.scene.mesh = std::move(read.field);
  result.scene.grid = {.size = {1, 1, 1}, .spacing = {1, 1, 1}, .values = {0}};
  result.scene.border = Border::voxel_centres;
}

std::array<std::int64_t, 2> read_image_size(const JsonReader& json) {
  const auto items = json.items(2);
  if (items.size() != 2) json.refuse_value("a list of width and height");
  const std::array<std::int64_t, 2> size{items[0].integer(1, largest_image_side),
                                         items[1].integer(1, largest_image_side)};
  if (size[0] * size[1] > most_pixels) json.refuse("more than 2^28 pixels", "fewer");
  json.blame_for([&size] {
    need_memory(static_cast<std::uint64_t>(size[0] * size[1]) * sizeof(Eigen::Array4d),
                fmt::format("an image of {} x {} pixels", size[0], size[1]));
  });
  return size;
}

/// As around a volume that has the mesh's box.
Camera camera_around(const TetrahedralField& mesh, const std::array<std::int64_t, 2>& size) {
  const auto [low, high] = mesh.box();
  Camera camera = fitted_camera({1, 1, 1}, {high[0] - low[0], high[1] - low[1], high[2] - low[2]}, size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double centre = (low[axis] + high[axis]) / 2;
    camera.eye[axis] += centre;
    camera.target[axis] += centre;
  }
  return camera;
}

/// One that shows the whole volume, for a scene that says none, or only its size.
Camera fit_camera(const std::optional<JsonReader>& json, SceneFile& result) {
  constexpr std::array<std::int64_t, 2> usual_size{512, 512};
  const auto size = json ? read_image_size(json->at("size")) : usual_size;
  const Grid& grid = result.scene.grid;
  Camera camera =
      result.scene.mesh ? camera_around(*result.scene.mesh, size) : fitted_camera(grid.size, grid.spacing, size);
  result.fitted_camera = camera_json(camera);
  return camera;
}

Camera read_camera(const JsonReader& json, const Grid& grid) {
  json.only({"eye", "target", "up", "height", "fov_y", "size"});
  Camera camera{
      .eye = read_place(json.at("eye")), .target = read_place(json.at("target")), .up = read_place(json.at("up"))};
  const auto height = json.find("height");
  const auto angle = json.find("fov_y");
  if (height && angle) angle->refuse_value("either height or fov_y");
  if (angle)
    camera.projection = Perspective{angle->positive_number()};
  else
    camera.projection = Orthographic{json.at("height").positive_number()};
  camera.size = read_image_size(json.at("size"));
  json.blame_for([&] { return CameraView(camera, grid.spacing); });
  return camera;
}

/// The step of samples; none: at cells' borders and midpoints.
std::optional<double> read_step(const JsonReader& json) {
  const auto step = json.find("step");
  if (const auto sampling = json.find("sampling")) {
    const bool is_cells = sampling->word({"constant", "cells"}) == "cells";
    if (is_cells && step) step->refuse("a step with the sampling cells", "no step, or the sampling constant");
    if (!is_cells && !step)
      sampling->refuse("the sampling constant without a step", "one with it, or the sampling cells");
  }
  if (!step) return {};
  return step->positive_number();
}

/// The builders whose tables a scheme reads its slabs from, the default first; none: it has none.
std::vector<std::string_view> builders_of(std::string_view scheme) {
  if (scheme == "order1") {
    auto names = names_of(catalogue::table_builders());
    const auto standard = std::find(names.begin(), names.end(), SceneTable{}.builder);
    std::rotate(names.begin(), standard, standard + 1);
    return names;
  }
  std::vector<std::string_view> names;
  if (scheme == "order2") names = names_of(catalogue::second_order_builders);
  for (const QuadraticGrayBuilder& builder : catalogue::quadratic_gray_builders())
    if (scheme == "order2" || scheme == builder.name) names.push_back(builder.name);
  return names;
}

SceneTable read_table(const JsonReader& json, const std::string& scheme) {
  const std::vector<std::string_view> names = builders_of(scheme);
  if (names.empty())
    json.refuse(fmt::format("a table with the scheme {}", scheme),
                "one with the scheme order1, order2, quadratic_gray or quadratic_gray_printed");
  SceneTable table;
  table.builder = names.front();
  if (const auto builder = json.find("builder")) table.builder = builder->word(names);
  const SecondOrderBuilder* const second_order = find_named(catalogue::second_order_builders, table.builder);
  const QuadraticGrayBuilder* const quadratic = find_named(catalogue::quadratic_gray_builders(), table.builder);
  if (second_order != nullptr && second_order->takes_iterations) {
    json.only({"builder", "iterations", "size", "format", "filter"});
    table.iterations = static_cast<int>(json.at("iterations").integer(1, most_table_iterations));
  } else if (quadratic != nullptr) {
    json.only({"builder", "size", "radius", "format", "filter"});
    if (const auto radius = json.find("radius")) table.radius = read_radius_axis(*radius, quadratic->radius);
  } else {
    json.only({"builder", "size", "format", "filter"});
  }
  std::size_t largest = largest_table_size;
  if (second_order != nullptr) largest = largest_table3_size;
  if (quadratic != nullptr) largest = largest_quadratic_size;
  table.size = static_cast<std::size_t>(json.at("size").integer(2, static_cast<std::int64_t>(largest)));
  if (const auto format = json.find("format")) {
    table.format = *find_named(table_formats, format->word(names_of(table_formats)));
  }
  if (const auto filter = json.find("filter")) table.filter = read_word<TableFilter>(*filter, table_filter_names);
  return table;
}

EmptySpace read_empty_space(const JsonReader& json) {
  json.only({"block", "bounds"});
  EmptySpace empty;
  if (const auto block = json.find("block")) empty.block = block->integer(1, 1024);
  empty.bounds = read_word<BlockBounds>(json.at("bounds"), block_bounds_names);
  return empty;
}

double read_share(const JsonReader& json) { return json.number(0, 1); }

/// A colour, three numbers >= 0.
Vector3<double> read_tone(const JsonReader& json) {
  Vector3<double> tone = read_vector(json);
  if (!(tone >= 0).all()) json.refuse_value("a list of three numbers >= 0");
  return tone;
}

Gooch read_gooch(const JsonReader& json) {
  json.only({"cool", "warm", "cool_share", "warm_share", "diffuse"});
  Gooch gooch;
  if (const auto cool = json.find("cool")) gooch.cool = read_tone(*cool);
  if (const auto warm = json.find("warm")) gooch.warm = read_tone(*warm);
  if (const auto share = json.find("cool_share")) gooch.cool_share = read_share(*share);
  if (const auto share = json.find("warm_share")) gooch.warm_share = read_share(*share);
  if (const auto diffuse = json.find("diffuse")) gooch.diffuse = diffuse->number(0);
  return gooch;
}

/// Ambient, diffuse and specular light.
void read_lighting(const JsonReader& json, Lighting& lighting) {
  lighting.ambient = json.at("ambient").number(0);
  lighting.diffuse = json.at("diffuse").number(0);
  lighting.specular = json.at("specular").number(0);
  lighting.shininess = json.at("shininess").number(1, largest_shininess);
  if (const auto highlight = json.find("highlight")) {
    lighting.highlight = find_named(catalogue::highlights(), highlight->word(names_of(catalogue::highlights())));
  }
  constexpr std::array<std::string_view, 3> treatments{"clamp", "mirror", "none"};
  if (const auto negative = json.find("negative")) lighting.negative = read_word<Negative>(*negative, treatments);
  json.at("shininess").blame_for([&lighting] {
    check(lighting);
    return 0;
  });
}

/// Light and normals; half vectors are the pixels' own.
SceneShading read_shading(const JsonReader& json) {
  SceneShading shading;
  std::vector<std::string_view> methods{"pointwise"};
  for (const Shading& row : catalogue::shadings()) methods.push_back(row.name);
  // "pointwise" is in no list: it has no slabs.
  if (const auto method = json.find("method"))
    shading.method = find_named(catalogue::shadings(), method->word(methods));
  const Vector3<double> light = read_vector(json.at("light"));
  const double norm = light.matrix().stableNorm();
  if (!(norm > 0) || !std::isfinite(norm)) json.at("light").refuse_value("a direction");
  shading.lighting.light = light / norm;
  if (const auto gooch = json.find("gooch")) {
    json.only({"method", "light", "gooch", "normal", "gradient", "virtual_normals"});
    shading.gooch = read_gooch(*gooch);
  } else {
    json.only({"method", "light", "ambient", "diffuse", "specular", "shininess", "highlight", "negative", "normal",
               "gradient", "virtual_normals"});
    read_lighting(json, shading.lighting);
  }
  if (const auto normal = json.find("normal"))
    shading.is_along_gradient = normal->word({"minus_gradient", "gradient"}) == "gradient";
  if (const auto gradient = json.find("gradient"))
    shading.gradient = read_word<GradientKind>(*gradient, gradient_kind_names);
  if (const auto normals = json.find("virtual_normals"))
    shading.virtual_normals = read_word<VirtualNormals>(*normals, virtual_normals_names);
  return shading;
}

std::string read_scheme(const JsonReader& json) {
  std::vector<std::string_view> names{"reference"};
  for (const IntegralScheme& scheme : catalogue::integral_schemes()) names.push_back(scheme.name);
  for (const SurfaceScheme& scheme : catalogue::surface_schemes()) names.push_back(scheme.name);
  return json.word(names);
}

/// What a scene with or without isosurfaces asks of its scheme.
void read_surfaces(const JsonReader& json, Scene& scene) {
  const bool has_surfaces = !scene.isosurfaces.empty();
  const bool is_surface_scheme = find_named(catalogue::surface_schemes(), scene.scheme) != nullptr;
  if (has_surfaces && !is_surface_scheme && scene.scheme != "reference")
    json.at("scheme").refuse(fmt::format("{} with isosurfaces", scene.scheme),
                             "reference, or a scheme that finds them, as every_crossing (`raytruth list surfaces`),");
  if (!has_surfaces && is_surface_scheme)
    json.at("scheme").refuse(fmt::format("{} without isosurfaces", scene.scheme),
                             "a transfer function with isosurfaces, or another scheme,");
  const SurfaceNumbers numbers = read_surface_numbers(json, {scene.scheme});
  scene.surface_tolerance = numbers.tolerance;
  scene.isoslab = numbers.isoslab;
  if (has_surfaces)
    json.at(scene.shading ? "shading" : "scheme").blame_for([&scene] {
      refuse_unsuitable_surfaces(scene);
      return 0;
    });
  if (!is_surface_scheme) return;
  for (const std::string_view key : {"early_termination", "empty_space"})
    if (const auto place = json.find(key))
      place->refuse(fmt::format("it with the scheme {}", scene.scheme), "a scheme without isosurfaces");
}

/// Refuses what does not follow the rays of a deformed volume.
void refuse_with_deformation(const JsonReader& json, const Scene& scene) {
  if (scene.scheme != "reference")
    json.at("scheme").refuse(fmt::format("{} of a deformed volume", scene.scheme), "the scheme reference");
  if (scene.shading) json.at("shading").refuse("light on a deformed volume", "a deformation without shading");
  if (scene.field != FieldKind::trilinear)
    json.at("reconstruction").refuse("tricubic reconstruction of a deformed volume", "trilinear");
}

}  // namespace

SceneFile read_scene(const JsonReader& json, const SceneOptions& options) {
  check_form(json, "scene/1");
  json.only({"raytruth",
             "volume",
             "mesh",
             "repair",
             "nan",
             "time_step",
             "spacing",
             "border",
             "reconstruction",
             "transfer_function",
             "emission",
             "camera",
             "scheme",
             "sampling",
             "step",
             "shading",
             "table",
             "early_termination",
             "empty_space",
             "deformation",
             "surface_tolerance",
             "isoslab"});
  if (json.find("mesh")) refuse_volumes_members(json);
  std::optional<OutsideProgram> program;
  if (is_outside_program(json.at("scheme"))) program = read_outside_program(json.at("scheme"));
  const std::string scheme = program ? "reference" : read_scheme(json.at("scheme"));
  SceneFile result{.scene = {.transfer = PiecewiseLinear(std::vector<TransferPoint>(1)), .scheme = scheme}};
  if (program && json.find("mesh"))
    json.at("scheme").refuse("a program with a mesh", "reference, or a scheme with the sampling cells,");
  if (program) result.document = json.json();
  result.program = std::move(program);
  Scene& scene = result.scene;
  if (const auto kind = json.find("reconstruction")) scene.field = read_word<FieldKind>(*kind, field_kind_names);
  scene.border = read_border(json);
  scene.emission = read_emission(json);
  scene.step = read_step(json);
  if (const auto table = json.find("table")) scene.table = read_table(*table, scheme);
  if (const auto shading = json.find("shading")) scene.shading = read_shading(*shading);
  if (const auto opaque = json.find("early_termination")) scene.opaque = opaque->number(0, 1);
  if (const auto empty = json.find("empty_space")) scene.empty_space = read_empty_space(*empty);
  if (json.find("mesh"))
    read_mesh(json, options, result);
  else
    scene.grid = read_voxels(json, options, result);
  if (const auto deformation = json.find("deformation")) {
    if (!options.only_renders)
      deformation->refuse("a deformation", "one where an image is rendered; here a volume as it is");
    if (result.program) json.at("scheme").refuse("a program with a deformation", "the scheme reference");
    refuse_with_deformation(json, scene);
    scene.deformation = std::make_shared<const Deformation>(
        read_deformation(*deformation, scene.grid, scene.border, scene.grid.spacing));
  }
  const auto camera = json.find("camera");
  const bool says_more_than_size =
      camera && !(camera->is_object() && camera->json().size() == 1 && camera->find("size"));
  scene.camera = says_more_than_size ? read_camera(*camera, scene.grid) : fit_camera(camera, result);
  const JsonReader transfer = json.at("transfer_function");
  const TransferVolume volume = transfer_volume(scene.grid);
  if (scene.mesh && is_of_another_program(transfer))
    transfer.refuse("another program's transfer function with a mesh", "points of this one");
  TransferDocument read = read_transfer_function(transfer,
                                                 {.volume = &volume,
                                                  .opacity = options.opacity,
                                                  .ignores_gradient_opacity = options.ignores_gradient_opacity,
                                                  .takes_isosurfaces = true},
                                                 result.warnings);
  scene.transfer = std::move(read.transfer);
  scene.isosurfaces = std::move(read.isosurfaces);
  if (!scene.isosurfaces.empty() && scene.mesh)
    transfer.refuse("isosurfaces with a mesh", "matter alone, or rays of cases,");
  if (!scene.isosurfaces.empty() && scene.deformation)
    json.at("deformation").refuse("a deformation of isosurfaces", "one of what a transfer function without them shows");
  read_surfaces(json, scene);
  result.transfer_function = std::move(read.description);
  if (scene.shading && scene.transfer.is_linear_in_opacity()) result.transfer_function["lit"] = sampled_opacity;
  // RayIntegral refuses numbers that it cannot calculate with.
  transfer.blame_for([&] { return RayIntegral(scene.transfer, scene.emission); });
  if (!scene.mesh) warn_of_what_is_not_seen(scene, result.warnings);
  return result;
}

}  // namespace raytruth
