#include "experiments/measure.hpp"
#include "measures/images/drawing.hpp"
#include "measures/images/pictures.hpp"
#include "measures/images/skipped_slabs.hpp"
#include "measures/images/studied_view.hpp"
#include "measures/images/surface_depths.hpp"
#include "raytruth/documents/outside_image.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/metrics/banding.hpp"
#include "raytruth/metrics/slab_banding.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/schemes/order2.hpp"
#include "raytruth/schemes/virtual_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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
  std::optional<OutsideProgram> program = {};    ///< that renders it, in place of the drawing's scheme
};

/// What is looked at; its truth is the certified image, or, where it is lit, that of `reference`.
struct View {
  StudiedView seen;
  Variant truth;
  FieldKind reconstruction = FieldKind::trilinear;
  Json shading = {};  ///< of its truth, and of its variants but for what they change; null: none
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
  std::vector<std::string> against;         ///< variants that others are compared with, beside the certified image
  std::vector<std::string> baselines;       ///< variants that others are to be better than
  std::optional<std::int64_t> window;       ///< in pixels, in which banding is looked for
  std::optional<std::int64_t> slab_window;  ///< the same, for stripes at slabs' borders
  Pictures pictures;
};

std::vector<std::string> read_words(const JsonReader& json, const std::vector<std::string_view>& allowed) {
  std::vector<std::string> words;
  for (const JsonReader& item : json.items(0)) words.push_back(item.word(allowed));
  return words;
}

/// These names and that of the certified image.
std::vector<std::string_view> with_certified(std::vector<std::string_view> names) {
  names.push_back(certified);
  return names;
}

View read_view(const Experiment& experiment, const JsonReader& json, const std::array<std::int64_t, 2>& size,
               const std::vector<View>& before) {
  json.only({"name", "field", "transfer", "camera", "reconstruction", "border", "shading"});
  StudiedView seen = read_studied_view(experiment, json, size, with_certified(names_of_views(before)));
  Json truth{{"scheme", "reference"}};
  const auto shading = json.find("shading");
  if (shading) truth["shading"] = shading->json();
  if (const auto border = json.find("border")) truth["border"] = border->json();
  Scene drawing = read_drawing(truth, json);
  View view{.seen = std::move(seen),
            .truth = {.name = std::string(certified), .drawing = std::move(drawing), .scene = std::move(truth)}};
  if (shading) view.shading = shading->json();
  if (const auto kind = json.find("reconstruction")) {
    const std::string word = kind->word({field_kind_names.begin(), field_kind_names.end()});
    view.reconstruction = static_cast<FieldKind>(std::find(field_kind_names.begin(), field_kind_names.end(), word) -
                                                 field_kind_names.begin());
  }
  return view;
}

/// Reads what is a scene but for its name, the views that it is for, and what these say.
Variant read_variant(const JsonReader& json, const View& view) {
  for (const char* const of_view : {"volume", "repair", "border", "transfer_function", "emission", "camera"})
    if (const auto found = json.find(of_view)) found->refuse(fmt::format("a {}", of_view), "what the view leaves open");
  Json scene = json.json();
  scene.erase("name");
  scene.erase("views");
  if (!view.shading.is_null()) {
    Json shading = view.shading;
    if (scene.contains("shading")) shading.merge_patch(scene["shading"]);
    scene["shading"] = std::move(shading);
  }
  std::optional<OutsideProgram> program;
  Json rendering = scene;
  if (is_outside_program(json.at("scheme"))) {
    program = read_outside_program(json.at("scheme"));
    rendering["scheme"] = "reference";
  }
  auto drawing = read_drawing(std::move(rendering), json);
  if (program) drawing.scheme = program->name;
  Variant variant{.name = json.at("name").text(),
                  .drawing = std::move(drawing),
                  .scene = std::move(scene),
                  .program = std::move(program)};
  if (json.find("reconstruction")) variant.reconstruction = variant.drawing.field;
  return variant;
}

/// The names of all variants, each of which the views get that it is for.
std::vector<std::string> read_variants(const JsonReader& json, std::vector<View>& views) {
  std::vector<std::string> names;
  for (const JsonReader& item : json.items()) {
    names.push_back(read_new_name(item.at("name"), with_certified({names.begin(), names.end()})));
    std::vector<std::string> wanted;
    if (const auto its_views = item.find("views")) wanted = read_words(*its_views, names_of_views(views));
    for (View& view : views)
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), view.seen.name) != wanted.end())
        view.variants.push_back(read_variant(item, view));
  }
  return names;
}

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "views", "variants", "against", "baselines", "banding_window", "slab_banding_window",
             "pictures"});
  Options options;
  const auto size = read_image_size(json.at("size"));
  for (const JsonReader& item : json.at("views").items())
    options.views.push_back(read_view(experiment, item, size, options.views));
  const std::vector<std::string> names = read_variants(json.at("variants"), options.views);
  const std::vector<std::string_view> variants(names.begin(), names.end());
  if (const auto window = json.find("banding_window"))
    options.window = window->integer(least_banding_window, std::min(size[0], size[1]));
  if (const auto window = json.find("slab_banding_window"))
    options.slab_window = window->integer(least_banding_window, std::min(size[0], size[1]));
  if (const auto against = json.find("against")) options.against = read_words(*against, variants);
  if (const auto baselines = json.find("baselines")) options.baselines = read_words(*baselines, variants);
  if (const auto pictures = json.find("pictures")) {
    pictures->only({"views", "images", "errors", "against", "gain"});
    options.pictures.views = read_words(pictures->at("views"), names_of_views(options.views));
    options.pictures.errors = read_words(pictures->at("errors"), variants);
    options.pictures.gain = pictures->at("gain").number(1, largest_gain);
    options.pictures.images = read_words(pictures->at("images"), with_certified(variants));
    options.pictures.against = pictures->at("against").word(with_certified(variants));
  }
  return options;
}

Scene scene_of(const View& view, const Variant& variant, const Experiment& experiment, const Grid& grid) {
  Scene scene = scene_of(view.seen, variant.drawing, experiment, grid);
  scene.field = variant.reconstruction.value_or(view.reconstruction);
  scene.border = view.truth.drawing.border;
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

/// The certified image.
struct CertifiedImage {
  double radius;  ///< the largest
  std::int64_t not_converged;
  double mean_opacity;
};

/// The error by Danskin and Hanrahan, 1992.
struct RelativeError {
  double percent;
  double radius;
};

/// The banding of an image's error, and how much more baselines have.
struct BandingFound {
  Banding banding;
  std::vector<std::optional<double>> gains = {};  ///< dB, by baseline; none without it or where nothing is banded
};

/// The error of what a screen shows of both images, where that is another one.
struct ShownError {
  ImageError error;
  std::int64_t clamped_values = 0;  ///< colours of either image beyond [0, 1]
};

/// A variant's image, or its 8-bit frame, against a reference.
struct Comparison {
  const Variant* variant;
  bool is_frame;
  ImageError error;
  ImageError opacity;  ///< of it alone
  std::optional<ShownError> shown = {};
  std::optional<RelativeError> relative = {};             ///< none where the truth is too uncertain
  std::optional<BandingFound> banding = {};               ///< none of frames, or where it is not asked for
  std::optional<SlabBanding> slab_banding = {};           ///< likewise, and where no window tells it
  double radius = 0;                                      ///< of the reference, the largest
  std::optional<double> order = {};                       ///< from the next coarser variant, if there is one
  std::vector<std::optional<double>> gains = {};          ///< dB, by baseline
  std::vector<std::optional<double>> closer_pixels = {};  ///< % of the pixels that differ, by baseline
  std::optional<SkippedSlabs> skipped = {};               ///< where blocks are skipped
  std::optional<std::string> version = {};                ///< of the program that made the image
};

/// What a view tells of: its certified image, a comparison, or a line of a picture.
struct Record {
  std::string view;
  std::string transfer;
  std::string variant;
  std::optional<std::string> against;
  std::optional<std::string> why = {};  ///< a program gave no image
  std::optional<CertifiedImage> truth = {};
  std::optional<Comparison> comparison = {};
  std::optional<PictureLine> picture = {};
};

/// A variant's image of a view.
struct Rendered {
  const Variant* variant;
  Image image;
  Image frame;
  std::optional<std::string> version = {};  ///< of the program that made it
};

/// Renders a view in all ways, and compares the images.
class ViewStudy {
 public:
  ViewStudy(const Experiment& experiment, const Options& options, const View& view, const Grid& grid)
      : options_(options),
        view_(view),
        truth_(Renderer(scene_of(view, view.truth, experiment, grid)).render()),
        truth_frame_(stored_frame(truth_.image)) {
    for (const Variant& variant : view.variants) {
      OutsideImage found = image_by(variant, experiment, grid);
      if (found.image.pixels.empty()) continue;
      Image frame = stored_frame(found.image);
      images_.push_back({&variant, std::move(found.image), std::move(frame), std::move(found.version)});
    }
    if (options.slab_window) depths_ = surface_depths(scene_of(view, view.truth, experiment, grid));
    add_certified();
    for (const auto& [variant, why] : refused_) add(variant->name, std::string(certified)).why = why;
    for (const Rendered& rendered : images_) add_comparisons(experiment, rendered, grid);
    add_pictures();
  }

  std::vector<Record> records;

 private:
  Record& add(std::string_view variant, const std::optional<std::string>& against) {
    return records.emplace_back(Record{.view = view_.seen.name,
                                       .transfer = view_.seen.transfer.name,
                                       .variant = std::string(variant),
                                       .against = against});
  }

  /// An image without pixels where a program gives none.
  OutsideImage image_by(const Variant& variant, const Experiment& experiment, const Grid& grid) {
    const Scene scene = scene_of(view_, variant, experiment, grid);
    if (!variant.program) return {Renderer(scene).render().image};
    try {
      if (!experiment.runs_programs) throw OutsideRefusal(std::string(why_not_run));
      return outside_image(*variant.program, scene, variant.scene);
    } catch (const OutsideRefusal& refusal) {
      refused_.emplace_back(&variant, refusal.what());
      return {Image({0, 0})};
    }
  }

  void add_certified() {
    const auto pixels = static_cast<double>(truth_.image.pixels.size());
    double opacity = 0;
    for (const auto& pixel : truth_.image.pixels) opacity += pixel[3];
    add(certified, {}).truth = {
        .radius = largest_radius(), .not_converged = truth_.not_converged, .mean_opacity = opacity / pixels};
  }

  [[nodiscard]] double largest_radius() const { return *std::max_element(truth_.radii.begin(), truth_.radii.end()); }

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

  void add_comparisons(const Experiment& experiment, const Rendered& rendered, const Grid& grid) {
    const double radii = std::accumulate(truth_.radii.begin(), truth_.radii.end(), 0.0);
    add_comparison(rendered, &Rendered::image, certified, truth_.image, radii).skipped =
        skipped_in(scene_of(view_, *rendered.variant, experiment, grid));
    add_comparison(rendered, &Rendered::frame, certified, truth_frame_);
    for (const std::string& name : options_.against) {
      const Rendered* const other = image_of(name);
      if (other == nullptr || other == &rendered) continue;
      add_comparison(rendered, &Rendered::image, name, other->image);
      add_comparison(rendered, &Rendered::frame, name, other->frame);
    }
  }

  /// `radii`: the sum of the reference's.
  Comparison& add_comparison(const Rendered& rendered, Image Rendered::*kind, std::string_view against,
                             const Image& reference, double radii = 0) {
    const Variant& variant = *rendered.variant;
    const auto rmse_of = [&](const Rendered* other) {
      return other != nullptr ? image_error(other->*kind, reference).rmse : 0;
    };
    Comparison found{.variant = &variant,
                     .is_frame = kind == &Rendered::frame,
                     .error = image_error(rendered.*kind, reference),
                     .opacity = image_error(rendered.*kind, reference, Channels::opacity),
                     .version = rendered.version};
    const ImageError& error = found.error;
    const ClampedImage shown = clamped(rendered.*kind);
    const ClampedImage shown_reference = clamped(reference);
    if (shown.count + shown_reference.count > 0)
      found.shown = {.error = image_error(shown.image, shown_reference.image),
                     .clamped_values = shown.count + shown_reference.count};
    if (const double light = light_of(reference); error.relative && light > 3 * radii)
      found.relative = {.percent = 100 * *error.relative,
                        .radius = 100 * (1 + *error.relative) * 3 * radii / (light - 3 * radii)};
    if (options_.window && !found.is_frame) found.banding = banding_of(rendered, reference);
    if (options_.slab_window && !found.is_frame) found.slab_banding = slab_banding_of(rendered, reference);
    if (radii > 0) found.radius = largest_radius();
    if (const double coarse = rmse_of(image_of(coarser(view_.variants, variant))); coarse > 0 && error.rmse > 0)
      found.order = std::log2(coarse / error.rmse);
    for (const std::string& name : options_.baselines) {
      const Rendered* const base = image_of(name);
      const double of_base = rmse_of(base);
      found.gains.push_back(of_base > 0 && error.rmse > 0 ? std::optional(20 * std::log10(of_base / error.rmse))
                                                          : std::nullopt);
      found.closer_pixels.push_back(
          base != nullptr && base != &rendered ? percent_closer(rendered.*kind, base->*kind, reference) : std::nullopt);
    }
    return add(variant.name, std::string(against)).comparison.emplace(std::move(found));
  }

  /// The share of pixels, among those in which two images differ by more than half a step of 8 bits, in which the first
  /// is closer to the reference; by the largest channel.
  static std::optional<double> percent_closer(const Image& image, const Image& other, const Image& reference) {
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
    return 100 * (static_cast<double>(closer) / static_cast<double>(different));
  }

  [[nodiscard]] BandingFound banding_of(const Rendered& rendered, const Image& reference) const {
    const auto banding_in = [&](const Rendered& other) {
      return banding(signed_error(other.image, reference), reference.size, *options_.window);
    };
    BandingFound found{.banding = banding_in(rendered)};
    for (const std::string& name : options_.baselines) {
      auto& gain = found.gains.emplace_back();
      if (const Rendered* const base = image_of(name); base != nullptr && found.banding.amplitude > 0)
        if (const double amplitude = banding_in(*base).amplitude; amplitude > 0)
          gain = 20 * std::log10(amplitude / found.banding.amplitude);
    }
    return found;
  }

  /// None without equal steps.
  [[nodiscard]] std::optional<SlabBanding> slab_banding_of(const Rendered& rendered, const Image& reference) const {
    const auto& step = rendered.variant->drawing.step;
    if (!step) return {};
    const double length = *step * (rendered.variant->drawing.scheme == Order2::info.name ? 2 : 1);
    std::vector<double> slabs;
    for (const double depth : depths_) slabs.push_back(depth / length);
    return slab_banding(signed_error(rendered.image, reference), slabs, reference.size, *options_.slab_window);
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
    for (const auto& pixel : image.pixels) light += pixel.head<3>().sum();
    return light;
  }

  static std::optional<SkippedSlabs> skipped_in(const Scene& scene) {
    if (!scene.empty_space || scene.scheme != VirtualCatmullRom3::info.name) return std::nullopt;
    return count_skipped_slabs(scene);
  }

  void add_picture(const std::string& variant, const std::optional<std::string>& reference,
                   std::vector<PictureLine> lines) {
    for (PictureLine& line : lines) add(variant, reference).picture = std::move(line);
  }

  void add_pictures() {
    const auto& [views, images, errors, against, gain] = options_.pictures;
    if (std::find(views.begin(), views.end(), view_.seen.name) == views.end()) return;
    const auto pixels_of = [this](const std::string& name) -> const Image& {
      const Rendered* const rendered = image_of(name);
      return rendered != nullptr ? rendered->image : truth_.image;
    };
    const auto is_here = [this](const std::string& name) { return name == certified || image_of(name) != nullptr; };
    for (const std::string& name : images)
      if (is_here(name)) add_picture(name, {}, color_lines(pixels_of(name)));
    for (const std::string& name : errors)
      if (is_here(name) && is_here(against))
        add_picture(name, against, error_lines(pixels_of(name), pixels_of(against), gain));
  }

  const Options& options_;
  const View& view_;
  Rendering truth_;
  Image truth_frame_;
  std::vector<Rendered> images_;
  std::vector<std::pair<const Variant*, std::string>> refused_;  ///< whose programs gave no image, and why
  std::vector<double> depths_;  ///< of the surface, where stripes at slabs' borders are looked for
};

// --- Columns ---

template <class Get>
CellOf<Comparison> of_error(Get get) {
  return [get](const Comparison& found) { return std::invoke(get, found.error); };
}

/// The cell of the relative error, which a comparison lacks where the light of its reference is too uncertain.
template <class Get>
CellOf<Comparison> of_relative(Get get) {
  return [get](const Comparison& found) -> std::optional<Value> {
    return found.relative ? std::optional(value_of(std::invoke(get, *found.relative))) : std::nullopt;
  };
}

std::optional<Value> shading_of(const Comparison& found) {
  const auto& shading = found.variant->drawing.shading;
  if (!shading) return std::nullopt;
  return value_of(shading->method != nullptr ? shading->method->name : "pointwise");
}

Columns<SceneTable> table_columns() {
  return {
      {.name = "table_size", .description = "entries along each axis of its table", .cell = &SceneTable::size},
      {.name = "table_format",
       .description = "of the table's numbers",
       .cell = [](const SceneTable& table) { return table.format.name; }},
  };
}

/// Only in rows of images with colours beyond [0, 1].
Columns<ShownError> shown_columns() {
  const auto of_error = [](const auto& member) {
    return [member](const ShownError& shown) { return value_of(std::invoke(member, shown.error)); };
  };
  return {
      {.name = "clamped_values",
       .description = "colours of either image beyond [0, 1], which a screen clamps; the columns below are after that",
       .cell = &ShownError::clamped_values},
      {.name = "clamped_danskin_hanrahan",
       .unit = "%",
       .description = "danskin_hanrahan as a screen shows both images",
       .cell = of_error([](const ImageError& error) { return 100 * error.relative.value_or(0); })},
      {.name = "clamped_rmse",
       .unit = "of white",
       .description = "rmse, likewise",
       .cell = of_error(&ImageError::rmse)},
      {.name = "clamped_psnr", .unit = "dB", .description = "psnr, likewise", .cell = of_error(&ImageError::psnr)},
      {.name = "clamped_maximum",
       .unit = "of white",
       .description = "maximum, likewise",
       .cell = of_error(&ImageError::maximum)},
  };
}

/// What a comparison gives, up to what depends on other variants.
Columns<Comparison> comparison_columns() {
  Columns<Comparison> columns{
      {.name = "scheme",
       .description = "of the variant",
       .cell = [](const Comparison& found) { return found.variant->drawing.scheme; }},
      {.name = "step",
       .unit = "voxel",
       .description = "of its samples; null: at cells' borders and midpoints",
       .cell = [](const Comparison& found) { return found.variant->drawing.step; }},
      {.name = "shading",
       .description = "of the variant: how it has normals, or light, between samples",
       .cell = shading_of},
  };
  append_part(
      columns, [](const Comparison& found) -> const auto& { return found.variant->drawing.table; }, table_columns());
  append(columns,
         Columns<Comparison>{
             {.name = "danskin_hanrahan",
              .unit = "%",
              .description = "100 sum |I - I_r| / sum I_r over pixels and channels (Danskin and Hanrahan 1992)",
              .radius = "danskin_hanrahan_radius",
              .cell = of_relative(&RelativeError::percent)},
             {.name = "danskin_hanrahan_radius",
              .unit = "%",
              .description = "from the certified image's radii",
              .cell = of_relative(&RelativeError::radius)},
             {.name = "rmse",
              .unit = "of white",
              .description = "root mean square of I - I_r",
              .radius = "radius",
              .cell = of_error(&ImageError::rmse)},
             {.name = "psnr",
              .unit = "dB",
              .description = "-20 log10 of it: the peak is 1; null for equal images",
              .cell = of_error(&ImageError::psnr)},
             {.name = "maximum",
              .unit = "of white",
              .description = "largest |I - I_r| of a channel",
              .radius = "radius",
              .cell = of_error(&ImageError::maximum)},
             {.name = "column",
              .unit = "pixel",
              .description = "where it is, from the left",
              .cell = of_error([](const ImageError& error) { return error.place[0]; })},
             {.name = "row",
              .unit = "pixel",
              .description = "where it is, from the top",
              .cell = of_error([](const ImageError& error) { return error.place[1]; })},
             {.name = "bias",
              .unit = "of white",
              .description = "mean of I - I_r",
              .radius = "radius",
              .cell = of_error(&ImageError::bias)}});
  append_part(
      columns, [](const Comparison& found) -> const auto& { return found.shown; }, shown_columns());
  return columns;
}

Columns<SlabBanding> slab_banding_columns() {
  return {
      {.name = "slab_banding",
       .description =
           "share of the signed error's variance, mean of the channels, that follows the surface's place in its "
           "slab: polynomials of degree 5 of it, after quadratics of the place in the window; 1: stripes, 0: none",
       .cell = &SlabBanding::share},
      {.name = "slab_banding_amplitude",
       .unit = "of white",
       .description = "root mean square of what follows it",
       .cell = &SlabBanding::amplitude},
      {.name = "slab_jump",
       .unit = "of white",
       .description = "root mean square of the error's change from the back of a slab to the front of the next",
       .cell = &SlabBanding::jump},
      {.name = "slab_windows",
       .description = "windows in which this can be told: slabs two pixels to half a window wide",
       .cell = &SlabBanding::windows},
  };
}

Columns<CertifiedImage> certified_columns() {
  return {
      {.name = "not_converged",
       .description = "pixels whose radius is wider than was asked for",
       .cell = &CertifiedImage::not_converged},
      {.name = "mean_opacity", .description = "of the certified image's pixels", .cell = &CertifiedImage::mean_opacity},
  };
}

Columns<SkippedSlabs> skipped_columns() {
  return {
      {.name = "slabs",
       .description = "of all rays, where blocks are skipped: from each true or virtual sample to the next, by four in "
                      "a step",
       .cell = &SkippedSlabs::slabs},
      {.name = "slabs_skipped",
       .unit = "%",
       .description = "those in skipped blocks only: the samples saved",
       .cell =
           [](const SkippedSlabs& count) {
             return 100 * static_cast<double>(count.skipped) / static_cast<double>(count.slabs);
           }},
      {.name = "slabs_wrongly_skipped",
       .description = "skipped ones that show something",
       .cell = &SkippedSlabs::wrong},
      {.name = "blocks", .description = "of the volume", .cell = &SkippedSlabs::blocks},
      {.name = "blocks_skipped", .description = "of these", .cell = &SkippedSlabs::skipped_blocks},
      {.name = "blocks_wrongly_skipped",
       .description = "skipped ones in which such a slab has its middle",
       .cell = &SkippedSlabs::wrong_blocks},
  };
}

std::optional<Value> frame_of(const Record& record) {
  if (record.picture) return std::nullopt;
  if (!record.comparison) return Value();
  return value_of(record.comparison->is_frame ? "srgb8" : "linear");
}

std::optional<Value> radius_of(const Record& record) {
  if (record.truth) return record.truth->radius;
  if (record.comparison && !record.comparison->is_frame) return record.comparison->radius;
  return std::nullopt;
}

/// The cell of a number that only some records have.
std::optional<Value> found(const std::optional<double>& number) { return cell_if(number.has_value(), number); }

/// The cell of what a comparison has for a baseline.
CellOf<Record> of_baseline(std::vector<std::optional<double>> Comparison::*numbers, std::size_t baseline) {
  return [=](const Record& record) -> std::optional<Value> {
    return record.comparison ? found((*record.comparison.*numbers)[baseline]) : std::nullopt;
  };
}

/// The cell of what a comparison has of banding.
template <class Get>
CellOf<Record> of_banding(Get get) {
  return [get](const Record& record) -> std::optional<Value> {
    return record.comparison && record.comparison->banding ? found(get(*record.comparison->banding)) : std::nullopt;
  };
}

/// The column of what a variant is better by than a baseline.
std::string gain_over(const std::string& baseline) { return "gain_over_" + baseline; }
std::string closer_than(const std::string& baseline) { return "closer_than_" + baseline; }
std::string banding_gain_over(const std::string& baseline) { return "banding_gain_over_" + baseline; }

bool has_programs(const Options& options) {
  return std::any_of(options.views.begin(), options.views.end(), [](const View& view) {
    return std::any_of(view.variants.begin(), view.variants.end(),
                       [](const Variant& variant) { return variant.program.has_value(); });
  });
}

/// The cell of a linear image's error of opacity.
CellOf<Record> of_opacity(double ImageError::*member) {
  return [member](const Record& record) -> std::optional<Value> {
    if (!record.comparison || record.comparison->is_frame) return std::nullopt;
    return value_of(record.comparison->opacity.*member);
  };
}

/// What a study tells besides in which programs make images.
Columns<Record> program_columns() {
  return {{.name = "version",
           .description = "of the program that made the image, in its words",
           .cell = [](const Record& record) -> std::optional<Value> {
             return record.comparison ? cell_if(record.comparison->version.has_value(), record.comparison->version)
                                      : std::nullopt;
           }},
          {.name = "opacity_rmse",
           .description = "root mean square error of the opacity",
           .radius = "radius",
           .cell = of_opacity(&ImageError::rmse)},
          {.name = "opacity_maximum",
           .description = "largest error of the opacity",
           .radius = "radius",
           .cell = of_opacity(&ImageError::maximum)},
          {.name = "opacity_bias",
           .description = "mean error of the opacity",
           .radius = "radius",
           .cell = of_opacity(&ImageError::bias)}};
}

/// What depends on the measure's options is described behind the other columns, but stands among them in the rows.
void describe_baselines(Columns<Record>& columns, const Options& options) {
  if (options.window)
    append(columns, Columns<Record>{
                        {.name = "banding",
                         .description = fmt::format(
                             "how periodic the signed error is, mean of the channels: the largest rise of its "
                             "autocorrelation over 2, in windows of {0} x {0} pixels; 1: stripes, some {1:.2f}: noise",
                             *options.window, 3.0 / static_cast<double>(*options.window))},
                        {.name = "banding_amplitude",
                         .unit = "of white",
                         .description = "the root of banding times the error's mean square about the windows' means"}});
  for (const std::string& name : options.baselines) {
    append(columns, Columns<Record>{{.name = gain_over(name),
                                     .unit = "dB",
                                     .description = fmt::format("psnr minus that of {}, against the same", name)},
                                    {.name = closer_than(name),
                                     .unit = "%",
                                     .description = fmt::format(
                                         "of the pixels in which it and {} differ by more than half a step of "
                                         "8 bits, those in which it is closer to the reference",
                                         name)}});
    if (options.window)
      columns.push_back({.name = banding_gain_over(name),
                         .unit = "dB",
                         .description = fmt::format("20 log10 of its banding amplitude over this one's: {}", name)});
  }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& options) {
  Columns<Record> columns{
      {.name = "view", .description = "what is looked at", .is_key = true, .cell = &Record::view},
      {.name = "transfer", .description = "its transfer function", .is_key = true, .cell = &Record::transfer},
      {.name = "variant",
       .description = "how it is rendered; certified: the image that the others approximate",
       .is_key = true,
       .cell = &Record::variant},
      {.name = "against",
       .description = "the image it is compared with: the certified one, or that of a variant; null: an image itself",
       .is_key = true,
       .cell = &Record::against},
      {.name = "frame",
       .description = "linear: light over black, clamped to [0, 1]; srgb8: the stored values of 8-bit sRGB frames of "
                      "both images, over 255",
       .is_key = true,
       .cell = frame_of},
      written_here<Record>("line", [](const Record& record) { return cell_if(!record.picture, Value()); }),
  };
  append_part(columns, &Record::comparison, comparison_columns());
  if (options.window) {
    append(
        columns,
        {written_here<Record>("banding", of_banding([](const BandingFound& banding) { return banding.banding.share; })),
         written_here<Record>("banding_amplitude",
                              of_banding([](const BandingFound& banding) { return banding.banding.amplitude; }))});
    for (std::size_t i = 0; i < options.baselines.size(); ++i)
      columns.push_back(
          written_here<Record>(banding_gain_over(options.baselines[i]),
                               of_banding([i](const BandingFound& banding) { return banding.gains[i]; })));
  }
  if (options.slab_window)
    append_part(
        columns,
        [](const Record& record) { return record.comparison ? record.comparison->slab_banding : std::nullopt; },
        slab_banding_columns());
  append(
      columns,
      Columns<Record>{
          {.name = "radius",
           .unit = "of white",
           .description =
               "of the certified image, largest; of a lit one measured, not proven; null for 8-bit frames, whose "
               "certified one is rounded from the middle of the enclosure",
           .cell = radius_of},
          {.name = "order",
           .description = "log2 of the RMSE, against the same, of the variant with twice the step or half the table, "
                          "over this one's",
           .cell = [](const Record& record) -> std::optional<Value> {
             return record.comparison ? found(record.comparison->order) : std::nullopt;
           }}});
  append_part(columns, &Record::truth, certified_columns());
  for (std::size_t i = 0; i < options.baselines.size(); ++i)
    columns.push_back(written_here<Record>(gain_over(options.baselines[i]), of_baseline(&Comparison::gains, i)));
  for (std::size_t i = 0; i < options.baselines.size(); ++i)
    columns.push_back(
        written_here<Record>(closer_than(options.baselines[i]), of_baseline(&Comparison::closer_pixels, i)));
  append_part(
      columns, [](const Record& record) { return record.comparison ? record.comparison->skipped : std::nullopt; },
      skipped_columns());
  append_part(columns, &Record::picture, picture_columns());
  if (has_programs(options)) {
    append(columns, program_columns());
    append_refusal(columns, &Record::why);
  }
  describe_baselines(columns, options);
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  return records_of_views(options.views, field,
                          [&](const View& view) { return ViewStudy(experiment, options, view, field.grid).records; });
}

}  // namespace

extern const Measure images_measure;
const Measure images_measure{MeasureDefinition<Options, Record>{
    .name = "images",
    .summary =
        "views of volumes in many ways, against each other and the true image: certified, or, where lit, estimated",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
