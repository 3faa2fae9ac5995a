#include "catalogue.hpp"
#include "render/image_error.hpp"
#include "render/image_file.hpp"
#include "render/png_file.hpp"
#include "render/renderer.hpp"
#include "render/skipped_slabs.hpp"
#include "schemes/virtual_samples.hpp"
#include "study/grid_view.hpp"
#include "study/measure.hpp"
#include "study/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view certified = "certified";
constexpr double largest_gain = 65536;

/// What is looked at; its truth is the certified image.
struct View {
  std::string name;
  std::string field;
  const NamedTransfer* transfer = nullptr;
  GridView camera;
  FieldKind reconstruction = FieldKind::trilinear;
};

/// By which the truth is made.
Scene certified_scene() { return {.transfer = PiecewiseLinear(std::vector<TransferPoint>(1))}; }

/// A way to render it.
struct Variant {
  std::string name;
  Scene drawing = certified_scene();             ///< its members that say how to render; the others have no meaning
  std::optional<FieldKind> reconstruction = {};  ///< none: the view's
  Json scene = {};                               ///< as the experiment says it
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
  std::vector<Variant> variants;
  std::vector<std::string> against;    ///< variants that others are compared with, beside the certified image
  std::vector<std::string> baselines;  ///< variants that others are to be better than
  Pictures pictures;
};

template <class Named>
std::vector<std::string_view> names_of(const std::vector<Named>& list) {
  std::vector<std::string_view> names;
  for (const Named& item : list) names.push_back(item.name);
  return names;
}

/// A name that none of the list has.
template <class Named>
std::string read_new_name(const JsonReader& json, const std::vector<Named>& list) {
  std::string name = json.text();
  const auto names = names_of(list);
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
  json.only({"name", "field", "transfer", "camera", "reconstruction"});
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
  return view;
}

/// Reads what is a scene but for its name and what the view says, as a scene.
Variant read_variant(const JsonReader& json) {
  Variant variant;
  variant.scene = json.json();
  for (const char* const of_view : {"volume", "repair", "transfer_function", "emission", "camera"})
    if (const auto found = json.find(of_view)) found->refuse(fmt::format("a {}", of_view), "what the view leaves open");
  variant.scene.erase("name");
  Json scene = variant.scene;
  scene["volume"] = {{"size", {1, 1, 1}}, {"values", {0}}};
  scene["transfer_function"] = {{"points", {{{"s", 0}, {"extinction", 0}, {"color", {0, 0, 0}}}}}};
  scene["camera"] = {{"eye", {0, 0, 1}}, {"target", {0, 0, 0}}, {"up", {0, 1, 0}}, {"height", 1}, {"size", {1, 1}}};
  const JsonReader reader = JsonReader::from_json(std::move(scene), json);
  try {
    variant.drawing = read_scene(reader, {}).scene;
  } catch (const InputError& error) {
    // It names the file, and behind it the place in the scene.
    throw InputError(json.place() + std::string(error.what()).substr(reader.place().size() - 1));
  }
  if (json.find("reconstruction")) variant.reconstruction = variant.drawing.field;
  return variant;
}

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "views", "variants", "against", "baselines", "pictures"});
  need_transfers(experiment);
  Options options;
  const auto size = read_image_size(json.at("size"));
  for (const JsonReader& item : json.at("views").items()) {
    std::string name = read_new_name(item.at("name"), options.views);
    options.views.push_back(read_view(experiment, item, size));
    options.views.back().name = std::move(name);
  }
  for (const JsonReader& item : json.at("variants").items()) {
    std::string name = read_new_name(item.at("name"), options.variants);
    options.variants.push_back(read_variant(item));
    options.variants.back().name = std::move(name);
  }
  auto variants = names_of(options.variants);
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

PngPixels png_of(const Image& image) {
  return read_png(image_file(image, ".png"), largest_image_side, image.size[0] * image.size[1]);
}

/// The stored values of an 8-bit sRGB file, as `raytruth compare` reads them.
Image frame_of(const Image& image) {
  const PngPixels stored = png_of(image);
  Image frame(image.size);
  for (std::size_t i = 0; i < frame.pixels.size(); ++i)
    for (std::size_t channel = 0; channel < 4; ++channel)
      frame.pixels[i][static_cast<Eigen::Index>(channel)] =
          static_cast<double>(stored.channels[4 * i + channel]) / stored.largest;
  return frame;
}

/// A line of pixels in 8-bit sRGB, two hexadecimal digits for each of red, green and blue.
std::string color_text(const PngPixels& pixels, std::int64_t line) {
  std::string text;
  for (std::int64_t i = line * pixels.size[0]; i < (line + 1) * pixels.size[0]; ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      text += fmt::format("{:02x}", pixels.channels[4 * static_cast<std::size_t>(i) + channel]);
  return text;
}

/// The largest error of a line's pixels over their channels, linear, two hexadecimal digits each.
std::string error_text(const Image& image, const Image& truth, double gain, std::int64_t line) {
  std::string text;
  for (std::int64_t i = line * image.size[0]; i < (line + 1) * image.size[0]; ++i) {
    const auto color = [i](const Image& of) {
      return of.pixels[static_cast<std::size_t>(i)].head<3>().max(0).min(1).eval();
    };
    const double error = (color(image) - color(truth)).abs().maxCoeff();
    text += fmt::format("{:02x}", std::lround(255 * std::min(1.0, gain * error)));
  }
  return text;
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
        truth_(certified_rendering(experiment, view, grid)),
        truth_frame_(frame_of(truth_.image)) {
    for (const Variant& variant : options.variants) {
      Image image = Renderer(scene_of(view, variant, experiment, grid)).render().image;
      Image frame = frame_of(image);
      images_.push_back({&variant, std::move(image), std::move(frame)});
    }
    add_certified();
    for (const Rendered& rendered : images_) add_errors(experiment, rendered, grid);
    add_pictures();
  }

  std::vector<Row> rows;

 private:
  static Rendering certified_rendering(const Experiment& experiment, const View& view, const Grid& grid) {
    return Renderer(scene_of(view, {.name = std::string(certified)}, experiment, grid)).render();
  }

  Row& add(std::string_view variant, const Value& against) {
    return rows.emplace_back(Row{{"view", view_.name},
                                 {"field", view_.field},
                                 {"transfer", view_.transfer->name},
                                 {"variant", std::string(variant)},
                                 {"against", against}});
  }

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
      const Rendered& other = *image_of(name);
      if (&other == &rendered) continue;
      add_error(rendered, &Rendered::image, name, other.image);
      add_error(rendered, &Rendered::frame, name, other.frame);
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
    if (!is_frame)
      row.emplace_back("radius", radii > 0 ? *std::max_element(truth_.radii.begin(), truth_.radii.end()) : 0.0);
    if (const double coarse = rmse_of(image_of(coarser(options_.variants, variant))); coarse > 0 && error.rmse > 0)
      row.emplace_back("order", std::log2(coarse / error.rmse));
    for (const std::string& name : options_.baselines)
      if (const double base = rmse_of(image_of(name)); base > 0 && error.rmse > 0)
        row.emplace_back(gain_over(name), 20 * std::log10(base / error.rmse));
    return row;
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
    const std::int64_t lines = truth_.image.size[1];
    for (const std::string& name : images) {
      const PngPixels stored = png_of(pixels_of(name));
      for (std::int64_t line = 0; line < lines; ++line) {
        Row& row = add(name, {});
        row.insert(row.end(), {{"line", line}, {"pixels", color_text(stored, line)}});
      }
    }
    for (const std::string& name : errors)
      for (std::int64_t line = 0; line < lines; ++line) {
        Row& row = add(name, against);
        row.insert(row.end(),
                   {{"line", line}, {"pixels", error_text(pixels_of(name), pixels_of(against), gain, line)}});
      }
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
      {.name = "line", .unit = "", .description = "of a picture, 0 on top; null: of the whole image", .is_key = true},
      {.name = "scheme", .unit = "", .description = "of the variant"},
      {.name = "step", .unit = "voxel", .description = "of its samples; null: at cells' borders and midpoints"},
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
       .description = "of the certified image, largest; null for 8-bit frames, whose certified one is rounded from the "
                      "middle of the enclosure"},
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
      {.name = "pixels",
       .unit = "",
       .description = "of the line, two hexadecimal digits each: of an image red, green and blue in 8-bit sRGB; of a "
                      "comparison 255 times the gain times the largest error of a channel"},
  };
  for (const std::string& name : asked.baselines)
    columns.push_back({.name = gain_over(name),
                       .unit = "dB",
                       .description = fmt::format("psnr minus that of {}, against the same", name)});
  return columns;
}

std::vector<Row> images_rows(const Experiment& experiment, const JsonReader& json, const Field& field) {
  const Options options = read_options(experiment, json);
  std::vector<Row> rows;
  for (const View& view : options.views) {
    if (view.field != field.name) continue;
    std::vector<Row> of_view = json.blame_for([&] { return ViewRows(experiment, options, view, field.grid).rows; });
    rows.insert(rows.end(), std::make_move_iterator(of_view.begin()), std::make_move_iterator(of_view.end()));
  }
  return rows;
}

}  // namespace raytruth
