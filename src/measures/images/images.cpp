#include "experiments/measure.hpp"
#include "measures/images/drawing.hpp"
#include "measures/images/grid_view.hpp"
#include "measures/images/pictures.hpp"
#include "measures/images/skipped_slabs.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/metrics/banding.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/schemes/virtual_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view certified = "certified";
constexpr double largest_gain = 65536;
constexpr std::int64_t least_banding_window = 8;

/// A way to render a view.
struct Variant {
  std::string name;
  Scene drawing;                                 ///< its members that say how to render; the others have no meaning
  std::optional<FieldKind> reconstruction = {};  ///< none: the view's
  Json scene = {};                               ///< as the experiment and the view say it
};

/// What is looked at; its truth is the certified image, or, where it is lit, that of `reference`.
struct View {
  std::string name;
  std::string field;
  const NamedTransfer* transfer = nullptr;
  GridView camera;
  FieldKind reconstruction = FieldKind::trilinear;
  Json shading = {};  ///< of its truth, and of its variants but for what they change; null: none
  Variant truth = {.name = {}, .drawing = {.transfer = PiecewiseLinear(std::vector<TransferPoint>(1))}};
  std::vector<Variant> variants = {};
};

/// What a result holds to be looked at: variants' images, and their errors, so many times as bright.
struct Pictures {
  std::vector<std::string> views;
  std::vector<std::string> images;
  std::vector<std::string> errors;
  std::string against;
  double gain = 1;
};

struct Options {
  std::vector<View> views;
  std::vector<std::string> against;    ///< variants that others are compared with, beside the certified image
  std::vector<std::string> baselines;  ///< variants that others are to be better than
  std::optional<std::int64_t> window;  ///< in pixels, in which banding is looked for
  Pictures pictures;
};

/// A name that none of these is.
template <class Name>
std::string read_new_name(const JsonReader& json, const std::vector<Name>& names) {
  std::string name = json.text();
  if (name == certified || std::find(names.begin(), names.end(), name) != names.end())
    json.refuse_value(fmt::format("a name that nothing else has, nor \"{}\",", certified));
  return name;
}

std::vector<std::string> read_words(const JsonReader& json, const std::vector<std::string_view>& allowed) {
  std::vector<std::string> words;
  for (const JsonReader& item : json.items(0)) words.push_back(item.word(allowed));
  return words;
}

View read_view(const Experiment& experiment, const JsonReader& json, const std::array<std::int64_t, 2>& size) {
  json.only({"name", "field", "transfer", "camera", "reconstruction", "shading"});
  View view;
  view.field = json.at("field").word(names_of(experiment.fields));
  const std::string transfer = json.at("transfer").word(names_of(experiment.transfers));
  view.transfer = &*std::find_if(experiment.transfers.begin(), experiment.transfers.end(),
                                 [&](const NamedTransfer& item) { return item.name == transfer; });
  view.camera = read_grid_view(json.at("camera"), size);
  if (const auto kind = json.find("reconstruction")) {
    const std::string word = kind->word({field_kind_names.begin(), field_kind_names.end()});
    view.reconstruction = static_cast<FieldKind>(std::find(field_kind_names.begin(), field_kind_names.end(), word) -
                                                 field_kind_names.begin());
  }
  Json truth{{"scheme", "reference"}};
  if (const auto shading = json.find("shading")) truth["shading"] = view.shading = shading->json();
  view.truth = {.name = std::string(certified), .drawing = read_drawing(truth, json), .scene = truth};
  return view;
}

/// Reads what is a scene but for its name, the views that it is for, and what these say.
Variant read_variant(const JsonReader& json, const View& view) {
  for (const char* const of_view : {"volume", "repair", "transfer_function", "emission", "camera"})
    if (const auto found = json.find(of_view)) found->refuse(fmt::format("a {}", of_view), "what the view leaves open");
  Json scene = json.json();
  scene.erase("name");
  scene.erase("views");
  if (!view.shading.is_null()) {
    Json shading = view.shading;
    if (scene.contains("shading")) shading.merge_patch(scene["shading"]);
    scene["shading"] = std::move(shading);
  }
  auto drawing = read_drawing(scene, json);
  Variant variant{.name = json.at("name").text(), .drawing = std::move(drawing), .scene = std::move(scene)};
  if (json.find("reconstruction")) variant.reconstruction = variant.drawing.field;
  return variant;
}

/// The names of all variants, each of which the views get that it is for.
std::vector<std::string> read_variants(const JsonReader& json, std::vector<View>& views) {
  std::vector<std::string> names;
  for (const JsonReader& item : json.items()) {
    names.push_back(read_new_name(item.at("name"), names));
    std::vector<std::string> wanted;
    if (const auto its_views = item.find("views")) wanted = read_words(*its_views, names_of(views));
    for (View& view : views)
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), view.name) != wanted.end())
        view.variants.push_back(read_variant(item, view));
  }
  return names;
}

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "views", "variants", "against", "baselines", "banding_window", "pictures"});
  need_transfers(experiment);
  Options options;
  const auto size = read_image_size(json.at("size"));
  for (const JsonReader& item : json.at("views").items()) {
    std::string name = read_new_name(item.at("name"), names_of(options.views));
    options.views.push_back(read_view(experiment, item, size));
    options.views.back().name = std::move(name);
  }
  const std::vector<std::string> names = read_variants(json.at("variants"), options.views);
  std::vector<std::string_view> variants(names.begin(), names.end());
  if (const auto window = json.find("banding_window"))
    options.window = window->integer(least_banding_window, std::min(size[0], size[1]));
  if (const auto against = json.find("against")) options.against = read_words(*against, variants);
  if (const auto baselines = json.find("baselines")) options.baselines = read_words(*baselines, variants);
  if (const auto pictures = json.find("pictures")) {
    pictures->only({"views", "images", "errors", "against", "gain"});
    options.pictures.views = read_words(pictures->at("views"), names_of(options.views));
    options.pictures.errors = read_words(pictures->at("errors"), variants);
    options.pictures.gain = pictures->at("gain").number(1, largest_gain);
    variants.push_back(certified);
    options.pictures.images = read_words(pictures->at("images"), variants);
    options.pictures.against = pictures->at("against").word(variants);
  }
  return options;
}

Scene scene_of(const View& view, const Variant& variant, const Experiment& experiment, const Grid& grid) {
  Scene scene = variant.drawing;
  scene.grid = grid;
  scene.field = variant.reconstruction.value_or(view.reconstruction);
  scene.transfer = view.transfer->transfer;
  scene.emission = experiment.emission;
  scene.camera = aimed(view.camera, grid);
  return scene;
}

/// The variant that differs in nothing but its step, twice as long, or its table, half as large; null if none does.
const Variant* coarser(const std::vector<Variant>& variants, const Variant& variant) {
  const auto with = [&](const char* pointer, double factor) {
    Json scene = variant.scene;
    const Json::json_pointer place(pointer);
    if (scene.contains(place)) scene[place] = factor * scene[place].get<double>();
    return scene;
  };
  for (const Json& wanted : {with("/step", 2), with("/table/size", 0.5)})
    for (const Variant& other : variants)
      if (wanted != variant.scene && other.scene == wanted) return &other;
  return nullptr;
}

/// The column of what a variant is better by than a baseline.
std::string gain_over(const std::string& baseline) { return "gain_over_" + baseline; }
std::string closer_than(const std::string& baseline) { return "closer_than_" + baseline; }
std::string banding_gain_over(const std::string& baseline) { return "banding_gain_over_" + baseline; }

/// A variant's image of a view.
struct Rendered {
  const Variant* variant;
  Image image;
  Image frame;
};

class ViewRows {
 public:
  ViewRows(const Experiment& experiment, const Options& options, const View& view, const Grid& grid)
      : options_(options),
        view_(view),
        truth_(Renderer(scene_of(view, view.truth, experiment, grid)).render()),
        truth_frame_(stored_frame(truth_.image)) {
    for (const Variant& variant : view.variants) {
      Image image = Renderer(scene_of(view, variant, experiment, grid)).render().image;
      Image frame = stored_frame(image);
      images_.push_back({&variant, std::move(image), std::move(frame)});
    }
    add_certified();
    for (const Rendered& rendered : images_) add_errors(experiment, rendered, grid);
    add_pictures();
  }

  std::vector<Row> rows;

 private:
  [[nodiscard]] Row keys(std::string_view variant, const Value& against) const {
    return {{"view", view_.name},
            {"transfer", view_.transfer->name},
            {"variant", std::string(variant)},
            {"against", against}};
  }

  Row& add(std::string_view variant, const Value& against) { return rows.emplace_back(keys(variant, against)); }

  void add_certified() {
    const auto pixels = static_cast<double>(truth_.image.pixels.size());
    double opacity = 0;
    for (const auto& pixel : truth_.image.pixels) opacity += pixel[3];
    Row& row = add(certified, {});
    row.insert(row.end(), {{"frame", Value()},
                           {"line", Value()},
                           {"radius", *std::max_element(truth_.radii.begin(), truth_.radii.end())},
                           {"not_converged", truth_.not_converged},
                           {"mean_opacity", opacity / pixels}});
  }

  [[nodiscard]] const Rendered* image_of(const Variant* wanted) const {
    const auto found =
        std::find_if(images_.begin(), images_.end(), [&](const Rendered& item) { return item.variant == wanted; });
    return found == images_.end() ? nullptr : &*found;
  }

  /// Null for the certified image.
  [[nodiscard]] const Rendered* image_of(const std::string& name) const {
    const auto found =
        std::find_if(images_.begin(), images_.end(), [&](const Rendered& item) { return item.variant->name == name; });
    return found == images_.end() ? nullptr : &*found;
  }

  void add_errors(const Experiment& experiment, const Rendered& rendered, const Grid& grid) {
    const double radii = std::accumulate(truth_.radii.begin(), truth_.radii.end(), 0.0);
    Row& row = add_error(rendered, &Rendered::image, certified, truth_.image, radii);
    add_skipped(row, scene_of(view_, *rendered.variant, experiment, grid));
    add_error(rendered, &Rendered::frame, certified, truth_frame_);
    for (const std::string& name : options_.against) {
      const Rendered* const other = image_of(name);
      if (other == nullptr || other == &rendered) continue;
      add_error(rendered, &Rendered::image, name, other->image);
      add_error(rendered, &Rendered::frame, name, other->frame);
    }
  }

  /// `radii`: the sum of the reference's.
  Row& add_error(const Rendered& rendered, Image Rendered::*kind, std::string_view against, const Image& reference,
                 double radii = 0) {
    const Variant& variant = *rendered.variant;
    const ImageError error = image_error(rendered.*kind, reference);
    const auto rmse_of = [&](const Rendered* other) {
      return other != nullptr ? image_error(other->*kind, reference).rmse : 0;
    };
    const bool is_frame = kind == &Rendered::frame;
    Row& row = add(variant.name, std::string(against));
    row.insert(row.end(), {{"frame", is_frame ? "srgb8" : "linear"},
                           {"line", Value()},
                           {"scheme", variant.drawing.scheme},
                           {"step", variant.drawing.step ? Value(*variant.drawing.step) : Value()}});
    if (const auto& shading = variant.drawing.shading)
      row.emplace_back("shading", shading->method != nullptr ? shading->method->name : "pointwise");
    if (const auto& table = variant.drawing.table)
      row.insert(row.end(), {{"table_size", static_cast<std::int64_t>(table->size)},
                             {"table_format", std::string(table->format.name)}});
    if (const double light = light_of(reference); error.relative && light > 3 * radii)
      row.insert(row.end(),
                 {{"danskin_hanrahan", 100 * *error.relative},
                  {"danskin_hanrahan_radius", 100 * (1 + *error.relative) * 3 * radii / (light - 3 * radii)}});
    row.insert(row.end(), {{"rmse", error.rmse},
                           {"psnr", error.psnr ? Value(*error.psnr) : Value()},
                           {"maximum", error.maximum},
                           {"column", error.place[0]},
                           {"row", error.place[1]},
                           {"bias", error.bias}});
    if (options_.window && !is_frame) add_banding(row, rendered, reference);
    if (!is_frame)
      row.emplace_back("radius", radii > 0 ? *std::max_element(truth_.radii.begin(), truth_.radii.end()) : 0.0);
    if (const double coarse = rmse_of(image_of(coarser(view_.variants, variant))); coarse > 0 && error.rmse > 0)
      row.emplace_back("order", std::log2(coarse / error.rmse));
    for (const std::string& name : options_.baselines)
      if (const double base = rmse_of(image_of(name)); base > 0 && error.rmse > 0)
        row.emplace_back(gain_over(name), 20 * std::log10(base / error.rmse));
    for (const std::string& name : options_.baselines)
      if (const Rendered* const base = image_of(name); base != nullptr && base != &rendered)
        if (const auto share = share_closer(rendered.*kind, base->*kind, reference))
          row.emplace_back(closer_than(name), 100 * *share);
    return row;
  }

  /// Of the pixels in which two images differ by more than half a step of 8 bits, those in which the first is closer to
  /// the reference; by the largest channel.
  static std::optional<double> share_closer(const Image& image, const Image& other, const Image& reference) {
    constexpr double half_a_step = 1.0 / 510;
    std::int64_t different = 0;
    std::int64_t closer = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const auto color = [i](const Image& of) { return of.pixels[i].head<3>().max(0).min(1).eval(); };
      const auto distance = [](const auto& a, const auto& b) { return (a - b).abs().maxCoeff(); };
      if (distance(color(image), color(other)) <= half_a_step) continue;
      ++different;
      if (distance(color(image), color(reference)) < distance(color(other), color(reference))) ++closer;
    }
    if (different == 0) return {};
    return static_cast<double>(closer) / static_cast<double>(different);
  }

  void add_banding(Row& row, const Rendered& rendered, const Image& reference) const {
    const auto banding_of = [&](const Rendered& other) {
      return banding(signed_error(other.image, reference), reference.size, *options_.window);
    };
    const Banding found = banding_of(rendered);
    row.insert(row.end(), {{"banding", found.share}, {"banding_amplitude", found.amplitude}});
    for (const std::string& name : options_.baselines)
      if (const Rendered* const base = image_of(name); base != nullptr && found.amplitude > 0)
        if (const double amplitude = banding_of(*base).amplitude; amplitude > 0)
          row.emplace_back(banding_gain_over(name), 20 * std::log10(amplitude / found.amplitude));
  }

  /// The mean of a pixel's channels.
  static std::vector<double> signed_error(const Image& image, const Image& reference) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      errors.push_back((image.pixels[i].head<3>().max(0).min(1) - reference.pixels[i].head<3>().max(0).min(1)).mean());
    return errors;
  }

  static double light_of(const Image& image) {
    double light = 0;
    for (const auto& pixel : image.pixels) light += pixel.head<3>().max(0).min(1).sum();
    return light;
  }

  static void add_skipped(Row& row, const Scene& scene) {
    if (!scene.empty_space || scene.scheme != VirtualCatmullRom3::info.name) return;
    const SkippedSlabs count = count_skipped_slabs(scene);
    row.insert(row.end(),
               {{"slabs", count.slabs},
                {"slabs_skipped", 100 * static_cast<double>(count.skipped) / static_cast<double>(count.slabs)},
                {"slabs_wrongly_skipped", count.wrong},
                {"blocks", count.blocks},
                {"blocks_skipped", count.skipped_blocks},
                {"blocks_wrongly_skipped", count.wrong_blocks}});
  }

  void add_pictures() {
    const auto& [views, images, errors, against, gain] = options_.pictures;
    if (std::find(views.begin(), views.end(), view_.name) == views.end()) return;
    const auto pixels_of = [this](const std::string& name) -> const Image& {
      const Rendered* const rendered = image_of(name);
      return rendered != nullptr ? rendered->image : truth_.image;
    };
    const auto is_here = [this](const std::string& name) { return name == certified || image_of(name) != nullptr; };
    for (const std::string& name : images)
      if (is_here(name)) add_picture(rows, keys(name, {}), color_lines(pixels_of(name)));
    for (const std::string& name : errors)
      if (is_here(name) && is_here(against))
        add_picture(rows, keys(name, against), error_lines(pixels_of(name), pixels_of(against), gain));
  }

  const Options& options_;
  const View& view_;
  Rendering truth_;
  Image truth_frame_;
  std::vector<Rendered> images_;
};

}  // namespace

std::vector<Column> images_columns(const Experiment& experiment, const JsonReader& options) {
  const Options asked = read_options(experiment, options);
  std::vector<Column> columns{
      {.name = "view", .unit = "", .description = "what is looked at", .is_key = true},
      {.name = "transfer", .unit = "", .description = "its transfer function", .is_key = true},
      {.name = "variant",
       .unit = "",
       .description = "how it is rendered; certified: the image that the others approximate",
       .is_key = true},
      {.name = "against",
       .unit = "",
       .description = "the image it is compared with: the certified one, or that of a variant; null: an image itself",
       .is_key = true},
      {.name = "frame",
       .unit = "",
       .description = "linear: light over black, clamped to [0, 1]; srgb8: the stored values of 8-bit sRGB frames of "
                      "both images, over 255",
       .is_key = true},
      {.name = "scheme", .unit = "", .description = "of the variant"},
      {.name = "step", .unit = "voxel", .description = "of its samples; null: at cells' borders and midpoints"},
      {.name = "shading", .unit = "", .description = "of the variant: how it has normals, or light, between samples"},
      {.name = "table_size", .unit = "", .description = "entries along each axis of its table"},
      {.name = "table_format", .unit = "", .description = "of the table's numbers"},
      {.name = "danskin_hanrahan",
       .unit = "%",
       .description = "100 sum |I - I_r| / sum I_r over pixels and channels (Danskin and Hanrahan 1992)",
       .radius = "danskin_hanrahan_radius"},
      {.name = "danskin_hanrahan_radius", .unit = "%", .description = "from the certified image's radii"},
      {.name = "rmse", .unit = "of white", .description = "root mean square of I - I_r", .radius = "radius"},
      {.name = "psnr", .unit = "dB", .description = "-20 log10 of it: the peak is 1; null for equal images"},
      {.name = "maximum", .unit = "of white", .description = "largest |I - I_r| of a channel", .radius = "radius"},
      {.name = "column", .unit = "pixel", .description = "where it is, from the left"},
      {.name = "row", .unit = "pixel", .description = "where it is, from the top"},
      {.name = "bias", .unit = "of white", .description = "mean of I - I_r", .radius = "radius"},
      {.name = "radius",
       .unit = "of white",
       .description =
           "of the certified image, largest; of a lit one measured, not proven; null for 8-bit frames, whose "
           "certified one is rounded from the middle of the enclosure"},
      {.name = "order",
       .unit = "",
       .description = "log2 of the RMSE, against the same, of the variant with twice the step or half the table, over "
                      "this one's"},
      {.name = "not_converged", .unit = "", .description = "pixels whose radius is wider than was asked for"},
      {.name = "mean_opacity", .unit = "", .description = "of the certified image's pixels"},
      {.name = "slabs",
       .unit = "",
       .description = "of all rays, where blocks are skipped: from each true or virtual sample to the next, by four in "
                      "a step"},
      {.name = "slabs_skipped", .unit = "%", .description = "those in skipped blocks only: the samples saved"},
      {.name = "slabs_wrongly_skipped", .unit = "", .description = "skipped ones that show something"},
      {.name = "blocks", .unit = "", .description = "of the volume"},
      {.name = "blocks_skipped", .unit = "", .description = "of these"},
      {.name = "blocks_wrongly_skipped", .unit = "", .description = "skipped ones in which such a slab has its middle"},
  };
  append(columns, picture_columns());
  if (asked.window) {
    columns.push_back({.name = "banding",
                       .unit = "",
                       .description = fmt::format(
                           "how periodic the signed error is, mean of the channels: the largest rise of its "
                           "autocorrelation over 2, in windows of {0} x {0} pixels; 1: stripes, some {1:.2f}: noise",
                           *asked.window, 3.0 / static_cast<double>(*asked.window))});
    columns.push_back({.name = "banding_amplitude",
                       .unit = "of white",
                       .description = "the root of banding times the error's mean square about the windows' means"});
  }
  for (const std::string& name : asked.baselines) {
    columns.push_back({.name = gain_over(name),
                       .unit = "dB",
                       .description = fmt::format("psnr minus that of {}, against the same", name)});
    columns.push_back({.name = closer_than(name),
                       .unit = "%",
                       .description = fmt::format("of the pixels in which it and {} differ by more than half a step of "
                                                  "8 bits, those in which it is closer to the reference",
                                                  name)});
    if (asked.window)
      columns.push_back({.name = banding_gain_over(name),
                         .unit = "dB",
                         .description = fmt::format("20 log10 of its banding amplitude over this one's: {}", name)});
  }
  return columns;
}

std::vector<Row> images_rows(const Experiment& experiment, const JsonReader& json, const Field& field) {
  const Options options = read_options(experiment, json);
  return rows_of_views(options.views, field, json,
                       [&](const View& view) { return ViewRows(experiment, options, view, field.grid).rows; });
}

}  // namespace raytruth
