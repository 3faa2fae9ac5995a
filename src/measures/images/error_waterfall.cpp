#include "experiments/measure.hpp"
#include "measures/images/drawing.hpp"
#include "measures/images/grid_view.hpp"
#include "measures/images/pictures.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/signals/field_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr double largest_gain = 65536;
constexpr std::int64_t most_entries = 65536;

/// What a renderer does, in the order in which the truth takes its place, from the screen back to the voxels.
enum Stage : std::size_t { frame, arithmetic, early_termination, shading, quadrature, classification, reconstruction };

constexpr std::array<std::string_view, 7> stage_names{"frame",      "arithmetic",     "early_termination", "shading",
                                                      "quadrature", "classification", "reconstruction"};

constexpr std::string_view stage_description =
    "what is exchanged. frame: 8-bit sRGB, or light as it is; arithmetic: binary32 or binary64, of the same rays unlit "
    "and read from a table; early_termination: rays end where they are nearly opaque, or not; shading: by the method "
    "from normals at samples, or with the normal of every point; quadrature: first-order slabs, or the signal itself; "
    "classification: extinction and colour from entries of 8 bits, or from the transfer function; reconstruction: "
    "trilinear, or by the prefiltered cubic B-spline, which is taken for the signal";

/// Those in which the truth is used.
using Stages = std::bitset<stage_names.size()>;

struct View {
  std::string name;
  std::string field;
  const NamedTransfer* transfer = nullptr;
  GridView camera;
  Scene drawing = {.transfer = PiecewiseLinear(std::vector<TransferPoint>(1))};
};

struct Options {
  std::vector<View> views;
  std::size_t entries = 0;  ///< of the transfer function
  double gain = 1;          ///< of errors in pictures
};

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "renderer", "entries", "views", "gain"});
  need_transfers(experiment);
  Options options;
  const auto size = read_image_size(json.at("size"));
  const JsonReader renderer = json.at("renderer");
  renderer.only({"step", "early_termination"});
  renderer.at("step").positive_number();
  for (const JsonReader& item : json.at("views").items()) {
    item.only({"name", "field", "transfer", "camera", "shading"});
    View view{
        .name = item.at("name").text(), .field = item.at("field").word(names_of(experiment.fields)), .camera = {}};
    const auto names = names_of(options.views);
    if (std::find(names.begin(), names.end(), view.name) != names.end())
      item.at("name").refuse_value("a name that no other view has");
    const std::string transfer = item.at("transfer").word(names_of(experiment.transfers));
    view.transfer = &*std::find_if(experiment.transfers.begin(), experiment.transfers.end(),
                                   [&](const NamedTransfer& known) { return known.name == transfer; });
    view.camera = read_grid_view(item.at("camera"), size);
    Json drawing = renderer.json();
    drawing["scheme"] = "order1";
    if (const auto shading = item.find("shading")) drawing["shading"] = shading->json();
    view.drawing = read_drawing(std::move(drawing), item);
    options.views.push_back(std::move(view));
  }
  options.entries = static_cast<std::size_t>(json.at("entries").integer(2, most_entries));
  options.gain = json.at("gain").number(1, largest_gain);
  return options;
}

/// A transfer function as a texture keeps it: at equally spaced scalars from 0 to 1 the colour, and the opacity of a
/// step, in 8 bits. An opacity of 1 has no extinction: it is clamped as elsewhere.
PiecewiseLinear in_8_bits(const PiecewiseLinear& transfer, std::size_t entries, double step) {
  const auto stored = [](double value) { return std::round(255 * std::clamp(value, 0.0, 1.0)) / 255; };
  std::vector<TransferPoint> points;
  for (std::size_t i = 0; i < entries; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(entries - 1);
    Optics optics = transfer.at(s);
    const double opacity = std::min(stored(-std::expm1(-optics.extinction * step)), largest_opacity);
    optics.extinction = -std::log1p(-opacity) / step;
    optics.color = optics.color.unaryExpr(stored);
    points.push_back({s, optics});
  }
  return PiecewiseLinear(std::move(points));
}

/// Light over black, clamped to [0, 1], channel by channel.
using Light = Eigen::ArrayXd;

Light light_of(const Image& image) {
  Light light(static_cast<Eigen::Index>(3 * image.pixels.size()));
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    light.segment<3>(static_cast<Eigen::Index>(3 * i)) = image.pixels[i].head<3>().max(0).min(1);
  return light;
}

class ViewRows {
 public:
  ViewRows(const Experiment& experiment, const Options& options, const View& view, const Grid& grid)
      : experiment_(experiment), options_(options), view_(view), grid_(grid), rounding_(rounding()) {
    const Rendering truth = Renderer(scene_with(Stages().set())).render();
    truth_ = truth.image;
    const Image ours = image_with({});
    total_ = light_of(ours) - light_of(truth_);

    Row& row = add("truth", {});
    row.insert(row.end(), {{"radius", *std::max_element(truth.radii.begin(), truth.radii.end())},
                           {"not_converged", truth.not_converged}});
    add_errors("all", {}, total_);
    for (std::size_t i = 0; i < stage_names.size(); ++i)
      if (const auto stage = static_cast<Stage>(i); !is_missing(stage)) alone_.emplace(stage, alone(stage));
    add_one_by_one("alone", [this](Stage stage) -> Light { return light_of(alone_.at(stage)) - light_of(truth_); });
    add_one_by_one("mended",
                   [&](Stage stage) -> Light { return light_of(ours) - light_of(image_with(Stages().set(stage))); });
    add_in_turn(ours);
    add_pictures(ours);
  }

  std::vector<Row> rows;

 private:
  [[nodiscard]] bool is_missing(Stage stage) const { return stage == shading && !view_.drawing.shading; }

  /// With the truth in these stages; what is beyond the pixel is added by `image_with`.
  [[nodiscard]] Scene scene_with(const Stages& is_true) const {
    Scene scene = view_.drawing;
    scene.grid = grid_;
    scene.emission = experiment_.emission;
    scene.camera = aimed(view_.camera, grid_);
    scene.field = is_true[reconstruction] ? FieldKind::bspline_prefiltered : FieldKind::trilinear;
    scene.transfer = is_true[classification] ? view_.transfer->transfer
                                             : in_8_bits(view_.transfer->transfer, options_.entries, *scene.step);
    if (is_true[early_termination]) scene.opaque = std::numeric_limits<double>::infinity();
    if (is_true[shading] && scene.shading) scene.shading->method = nullptr;
    // Both are exact along the ray; only the second ends early, and knows methods of shading.
    const bool is_reference = is_true[early_termination] && (is_true[shading] || !scene.shading);
    if (is_true[quadrature]) scene.scheme = is_reference ? "reference" : "cell_cubic";
    return scene;
  }

  [[nodiscard]] static Image render(Scene scene) { return Renderer(std::move(scene)).render().image; }

  /// What binary32 does to the rays of our renderer, unlit: lit images are made in binary64 only.
  [[nodiscard]] Image rounding() const {
    Scene scene = scene_with({});
    scene.shading.reset();
    scene.table = SceneTable{};
    Image difference = render(scene);
    scene.table->in_binary64 = true;
    const Image exact = render(std::move(scene));
    for (std::size_t i = 0; i < difference.pixels.size(); ++i) difference.pixels[i] -= exact.pixels[i];
    return difference;
  }

  [[nodiscard]] Image finished(Image image, const Stages& is_true) const {
    if (!is_true[arithmetic])
      for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += rounding_.pixels[i];
    return is_true[frame] ? image : light_of_frame(image);
  }

  [[nodiscard]] Image image_with(const Stages& is_true) const { return finished(render(scene_with(is_true)), is_true); }

  /// The truth but for one stage.
  [[nodiscard]] Image alone(Stage stage) const {
    const Stages others = Stages().set().reset(stage);
    if (stage == frame || stage == arithmetic) return finished(truth_, others);
    if (stage != early_termination && stage != shading) return image_with(others);
    // Through a cubic reconstruction no exact scheme ends rays early or knows methods of shading: what they do to the
    // trilinear one.
    const Stages trilinear = Stages(others).reset(reconstruction);
    const Image ours = render(scene_with(trilinear));
    const Image theirs = render(scene_with(Stages(trilinear).set(stage)));
    Image image = truth_;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += ours.pixels[i] - theirs.pixels[i];
    return image;
  }

  Row& add(std::string_view part, const Value& stage) {
    return rows.emplace_back(
        Row{{"view", view_.name}, {"transfer", view_.transfer->name}, {"part", std::string(part)}, {"stage", stage}});
  }

  void add_errors(std::string_view part, const Value& stage, const Light& error) {
    const double light = light_of(truth_).sum();
    const double squares = total_.square().sum();
    Row& row = add(part, stage);
    row.insert(row.end(), {{"rmse", std::sqrt(error.square().mean())},
                           {"maximum", error.abs().maxCoeff()},
                           {"bias", error.mean()},
                           {"danskin_hanrahan", light > 0 ? Value(100 * error.abs().sum() / light) : Value()},
                           {"share", squares > 0 ? Value(100 * (error * total_).sum() / squares) : Value()}});
  }

  /// The difference that each stage makes, and what of the total error they leave over.
  void add_one_by_one(std::string_view part, const std::function<Light(Stage)>& difference_of) {
    Light left = total_;
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
      const auto stage = static_cast<Stage>(i);
      if (is_missing(stage)) continue;
      const Light difference = difference_of(stage);
      left -= difference;
      add_errors(part, std::string(stage_names[i]), difference);
    }
    add_errors(part, "interaction", left);
  }

  /// The errors that are left when stage after stage is mended: down to the truth's.
  void add_in_turn(const Image& ours) {
    Light before = light_of(ours);
    Stages is_true;
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
      is_true.set(i);
      if (is_missing(static_cast<Stage>(i))) continue;
      const Light light = light_of(is_true.all() ? truth_ : image_with(is_true));
      add_errors("in turn", std::string(stage_names[i]), before - light);
      rows.back().emplace_back("rmse_left", std::sqrt((light - light_of(truth_)).square().mean()));
      before = light;
    }
  }

  void add_pictures(const Image& ours) {
    const auto keys = [this](const Value& stage) {
      return Row{{"view", view_.name}, {"transfer", view_.transfer->name}, {"part", "picture"}, {"stage", stage}};
    };
    add_picture(rows, keys({}), color_lines(truth_));
    add_picture(rows, keys("all"), error_lines(ours, truth_, options_.gain));
    for (const auto& [stage, image] : alone_)
      add_picture(rows, keys(std::string(stage_names[stage])), error_lines(image, truth_, options_.gain));
  }

  const Experiment& experiment_;
  const Options& options_;
  const View& view_;
  const Grid& grid_;
  Image rounding_;
  Image truth_{{1, 1}};
  std::map<Stage, Image> alone_;  ///< the truth but for one stage
  Light total_;
};

}  // namespace

std::vector<Column> error_waterfall_columns(const Experiment& experiment, const JsonReader& options) {
  read_options(experiment, options);
  std::vector<Column> columns{
      {.name = "view", .unit = "", .description = "what is looked at", .is_key = true},
      {.name = "transfer", .unit = "", .description = "its transfer function", .is_key = true},
      {.name = "part",
       .unit = "",
       .description = "truth: the true image; all: the error of the renderer's; alone: of the truth but for one stage "
                      "(shading and early_termination: what they do to the trilinear truth); "
                      "mended: what the renderer's error loses when one stage becomes true; in turn: the same, stage "
                      "after stage, each staying true; picture: the true image, or an error",
       .is_key = true},
      {.name = "stage",
       .unit = "",
       .description =
           std::string(stage_description) + ". interaction: the renderer's error minus the sum of the others",
       .is_key = true},
      {.name = "rmse", .unit = "of white", .description = "root mean square of the difference, light in [0, 1]"},
      {.name = "maximum", .unit = "of white", .description = "its largest magnitude in a channel"},
      {.name = "bias", .unit = "of white", .description = "its mean"},
      {.name = "danskin_hanrahan", .unit = "%", .description = "100 sum of its magnitudes / sum of the truth"},
      {.name = "share",
       .unit = "%",
       .description = "of the renderer's error E: 100 <difference, E> / <E, E>; those of a part add up to 100"},
      {.name = "rmse_left", .unit = "of white", .description = "of the image then, against the truth"},
      {.name = "radius", .unit = "of white", .description = "of the true image, largest; of a lit one measured"},
      {.name = "not_converged", .unit = "", .description = "pixels whose radius is wider than was asked for"},
  };
  append(columns, picture_columns());
  return columns;
}

std::vector<Row> error_waterfall_rows(const Experiment& experiment, const JsonReader& json, const Field& field) {
  const Options options = read_options(experiment, json);
  return rows_of_views(options.views, field, json,
                       [&](const View& view) { return ViewRows(experiment, options, view, field.grid).rows; });
}

}  // namespace raytruth
