#include "experiments/measure.hpp"
#include "measures/images/drawing.hpp"
#include "measures/images/grid_view.hpp"
#include "measures/images/pictures.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/render/suitable_surfaces.hpp"
#include "raytruth/schemes/surface_method.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view certified = "certified";

/// So many steps of an 8-bit frame are called the same.
constexpr double same_light = 2.0 / 255;

/// Surfaces of a picture.
struct Part {
  std::string name;
  std::vector<Isosurface> surfaces;
};

/// A way to render them.
struct Variant {
  std::string name;
  std::string scheme;
  const Shading* shading = nullptr;  ///< of isoslabs
  std::size_t table_size = 0;        ///< of isoslabs
};

struct Options {
  std::array<std::int64_t, 2> size{};
  GridView view;
  SceneShading shading;
  double step = 0;
  Isoslab isoslab;
  double tolerance = 0;
  std::vector<Part> parts;
  std::vector<Variant> variants;
  std::string against;
  std::vector<std::string> pictures;
};

Part read_part(const JsonReader& json, const std::vector<Part>& before) {
  json.only({"name", "isosurfaces"});
  Part part{.name = json.at("name").text(), .surfaces = {}};
  if (std::any_of(before.begin(), before.end(), [&](const Part& other) { return other.name == part.name; }))
    json.at("name").refuse_value("a name that no part before has");
  for (const JsonReader& item : json.at("isosurfaces").items()) {
    item.only({"s", "opacity", "color"});
    const auto color = item.at("color").items(3);
    if (color.size() != 3) item.at("color").refuse_value("three numbers");
    part.surfaces.push_back({.s = item.at("s").number(0, 1),
                             .opacity = item.at("opacity").number(0, 1),
                             .color = {color[0].number(0, 1), color[1].number(0, 1), color[2].number(0, 1)}});
  }
  json.at("isosurfaces").blame_for([&] { check(part.surfaces); });
  return part;
}

Variant read_variant(const JsonReader& json, const std::vector<Variant>& before) {
  json.only({"name", "scheme", "shading", "size"});
  Variant variant{.name = json.at("name").text(),
                  .scheme = json.at("scheme").word(names_of(catalogue::surface_schemes()))};
  const auto is_of = [&](const Variant& other) { return other.name == variant.name; };
  if (variant.name == certified || std::any_of(before.begin(), before.end(), is_of))
    json.at("name").refuse_value("a name that nothing else has");
  if (find_named(catalogue::surface_schemes(), variant.scheme)->isoslab) {
    variant.shading = find_named(catalogue::shadings(), json.at("shading").word(names_of(catalogue::shadings())));
    variant.table_size = static_cast<std::size_t>(json.at("size").integer(2, 1024));
    return variant;
  }
  for (const char* const key : {"shading", "size"})
    if (const auto found = json.find(key)) found->refuse("it without a scheme of isoslabs", "it beside one");
  return variant;
}

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "size", "camera", "shading", "step", "isoslab", "tolerance", "parts", "variants", "against",
             "pictures"});
  Options options;
  options.size = read_image_size(json.at("size"));
  options.view = read_grid_view(json.at("camera"), options.size);
  options.shading = *read_drawing(Json{{"scheme", "reference"}, {"shading", json.at("shading").json()}}, json).shading;
  options.step = json.at("step").positive_number();
  const JsonReader isoslab = json.at("isoslab");
  isoslab.only({"width", "slope"});
  options.isoslab.width = isoslab.at("width").positive_number();
  options.isoslab.slope = isoslab.at("slope").positive_number();
  options.tolerance = json.at("tolerance").positive_number();
  for (const JsonReader& part : json.at("parts").items()) options.parts.push_back(read_part(part, options.parts));
  for (const JsonReader& item : json.at("variants").items())
    options.variants.push_back(read_variant(item, options.variants));
  std::vector<std::string_view> names;
  for (const Variant& variant : options.variants) names.emplace_back(variant.name);
  options.against = json.at("against").word(names);
  names.push_back(certified);
  for (const JsonReader& picture : json.at("pictures").items(0)) options.pictures.push_back(picture.word(names));
  return options;
}

Scene scene_of(const Options& options, const Part& part, const Grid& grid) {
  return {.grid = grid,
          .transfer = PiecewiseLinear(std::vector<TransferPoint>(1)),
          .camera = aimed(options.view, grid),
          .step = options.step,
          .shading = options.shading,
          .isosurfaces = part.surfaces,
          .surface_tolerance = options.tolerance,
          .isoslab = options.isoslab};
}

/// An image against another one.
struct Comparison {
  std::string against;
  std::int64_t lit_pixels = 0;
  std::optional<double> same_share = {};        ///< of them, in 8-bit sRGB
  std::optional<double> same_light_share = {};  ///< of them, in linear light
  ImageError error;
};

struct Record {
  std::string part;
  std::string variant;
  std::optional<std::string> scheme = {};
  std::optional<std::string> shading = {};
  std::optional<std::size_t> table_size = {};
  std::optional<Comparison> comparison = {};
  std::optional<PictureLine> picture = {};
};

/// A pixel is lit where either image shows more than black.
Comparison comparison_of(const Image& image, const Image& reference, std::string against) {
  Comparison found{.against = std::move(against), .error = image_error(clamped(image).image, clamped(reference).image)};
  const Image frame = stored_frame(image);
  const Image reference_frame = stored_frame(reference);
  std::int64_t same = 0;
  std::int64_t same_in_light = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto color = [i](const Image& of) { return of.pixels[i].head<3>().max(0).min(1).eval(); };
    if ((color(frame) == 0).all() && (color(reference_frame) == 0).all()) continue;
    ++found.lit_pixels;
    // Frames hold whole steps, but for rounding.
    constexpr double slack = 1e-9;
    same += (color(frame) - color(reference_frame)).abs().maxCoeff() <= same_light + slack ? 1 : 0;
    same_in_light += (color(image) - color(reference)).abs().maxCoeff() <= same_light ? 1 : 0;
  }
  if (found.lit_pixels > 0) {
    const auto lit = static_cast<double>(found.lit_pixels);
    found.same_share = static_cast<double>(same) / lit;
    found.same_light_share = static_cast<double>(same_in_light) / lit;
  }
  return found;
}

Columns<Comparison> comparison_columns() {
  return {{.name = "against",
           .description = "the image it is compared with: the certified one, lit and converged, or that of a variant; "
                          "null: of pictures",
           .is_key = true,
           .cell = &Comparison::against},
          {.name = "lit_pixels",
           .description = "pixels that are not black in the 8-bit sRGB frame of both",
           .cell = &Comparison::lit_pixels},
          {.name = "same_share",
           .description = "share of them whose channels all differ by 2 at most, of 255, in these frames",
           .cell = &Comparison::same_share},
          {.name = "same_light_share",
           .description = "share of them whose channels all differ by 2/255 at most, in linear light",
           .cell = &Comparison::same_light_share},
          {.name = "rmse",
           .unit = "of white",
           .description = "root mean square of the difference of linear light, clamped to [0, 1]",
           .cell = [](const Comparison& comparison) { return comparison.error.rmse; }},
          {.name = "maximum",
           .unit = "of white",
           .description = "largest difference of it",
           .cell = [](const Comparison& comparison) { return comparison.error.maximum; }}};
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> list{
      {.name = "part", .description = "which isosurfaces", .is_key = true, .cell = &Record::part},
      {.name = "variant",
       .description = "how they are rendered; certified: lit where they are crossed",
       .is_key = true,
       .cell = &Record::variant},
      {.name = "scheme", .description = "of `raytruth list surfaces`", .cell = &Record::scheme},
      {.name = "shading",
       .description = "of isoslabs, of `raytruth list shadings`",
       .is_key = true,
       .cell = &Record::shading},
      {.name = "table_size", .description = "entries of their table on each axis", .cell = &Record::table_size}};
  append_part(list, &Record::comparison, comparison_columns());
  append_part(list, &Record::picture, picture_columns());
  return list;
}

std::vector<Record> records_of_part(const Options& options, const Part& part, const Grid& grid) {
  Scene truth_scene = scene_of(options, part, grid);
  truth_scene.scheme = "reference";
  const Image truth = Renderer(std::move(truth_scene)).render().image;
  std::vector<Image> images;
  for (const Variant& variant : options.variants) {
    Scene scene = scene_of(options, part, grid);
    scene.scheme = variant.scheme;
    scene.shading->method = variant.shading;
    if (variant.shading != nullptr) scene.isoslab.size = variant.table_size;
    images.push_back(Renderer(std::move(scene)).render().image);
  }

  std::vector<Record> records;
  const auto add_picture = [&](const Record& of, const Image& image) {
    if (std::find(options.pictures.begin(), options.pictures.end(), of.variant) == options.pictures.end()) return;
    for (PictureLine& line : color_lines(image)) {
      records.push_back(of);
      records.back().picture = std::move(line);
    }
  };
  add_picture({.part = part.name, .variant = std::string(certified)}, truth);
  const auto of_baseline =
      static_cast<std::size_t>(std::find_if(options.variants.begin(), options.variants.end(),
                                            [&](const Variant& variant) { return variant.name == options.against; }) -
                               options.variants.begin());
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Variant& variant = options.variants[i];
    Record record{.part = part.name, .variant = variant.name, .scheme = variant.scheme};
    if (variant.shading != nullptr) {
      record.shading = variant.shading->name;
      record.table_size = variant.table_size;
    }
    records.push_back(record);
    records.back().comparison = comparison_of(images[i], truth, std::string(certified));
    if (i != of_baseline) {
      records.push_back(record);
      records.back().comparison = comparison_of(images[i], images[of_baseline], options.against);
    }
    add_picture(record, images[i]);
  }
  return records;
}

std::vector<Record> records_of_field(const Experiment& /*experiment*/, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const Part& part : options.parts) {
    std::vector<Record> of_part = records_of_part(options, part, field.grid);
    records.insert(records.end(), std::make_move_iterator(of_part.begin()), std::make_move_iterator(of_part.end()));
  }
  return records;
}

}  // namespace

extern const Measure isosurface_images_measure;
const Measure isosurface_images_measure{MeasureDefinition<Options, Record>{
    .name = "isosurface_images",
    .summary = "pictures of isosurfaces by the schemes that find them, and how many of their pixels are the same",
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
