#include "experiments/measure.hpp"
#include "measures/images/drawing.hpp"
#include "measures/images/pictures.hpp"
#include "measures/images/studied_view.hpp"
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
#include <optional>
#include <string>
#include <vector>

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
  StudiedView seen;
  Scene drawing;  ///< its members that say how to render; the others have no meaning
};

struct Options {
  std::vector<View> views;
  std::size_t entries = 0;  ///< of the transfer function
  double gain = 1;          ///< of errors in pictures
};

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "renderer", "entries", "views", "gain"});
  Options options;
  const auto size = read_image_size(json.at("size"));
  const JsonReader renderer = json.at("renderer");
  renderer.only({"step", "early_termination"});
  renderer.at("step").positive_number();
  for (const JsonReader& item : json.at("views").items()) {
    item.only({"name", "field", "transfer", "camera", "shading"});
    StudiedView seen = read_studied_view(experiment, item, size, names_of_views(options.views));
    Json drawing = renderer.json();
    drawing["scheme"] = "order1";
    if (const auto shading = item.find("shading")) drawing["shading"] = shading->json();
    options.views.push_back({std::move(seen), read_drawing(std::move(drawing), item)});
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

/// The true image.
struct Truth {
  double radius;  ///< the largest
  std::int64_t not_converged;
};

/// A difference of two images, and what it is to the truth and to the whole error.
struct StageError {
  double rmse;
  double maximum;
  double bias;
  std::optional<double> danskin_hanrahan;  ///< %; none where the truth is black
  std::optional<double> share;             ///< %; none where the renderer makes no error
};

/// What a view tells of: its truth, an error, or a line of a picture.
struct Record {
  std::string view;
  std::string transfer;
  std::string_view part;
  std::optional<std::string_view> stage = {};
  std::optional<StageError> error = {};
  std::optional<double> rmse_left = {};  ///< once the stages so far are mended
  std::optional<Truth> truth = {};
  std::optional<PictureLine> picture = {};
};

/// Renders a view with the truth in some stages, and takes the differences.
class ViewStudy {
 public:
  ViewStudy(const Experiment& experiment, const Options& options, const View& view, const Grid& grid)
      : experiment_(experiment), options_(options), view_(view), grid_(grid), rounding_(rounding()) {
    const Rendering truth = Renderer(scene_with(Stages().set())).render();
    truth_ = truth.image;
    const Image ours = image_with({});
    total_ = light_of(ours) - light_of(truth_);

    add("truth", {}).truth = {.radius = *std::max_element(truth.radii.begin(), truth.radii.end()),
                              .not_converged = truth.not_converged};
    add_error("all", {}, total_);
    for (std::size_t i = 0; i < stage_names.size(); ++i)
      if (const auto stage = static_cast<Stage>(i); !is_missing(stage)) alone_.emplace(stage, alone(stage));
    add_one_by_one("alone", [this](Stage stage) -> Light { return light_of(alone_.at(stage)) - light_of(truth_); });
    add_one_by_one("mended",
                   [&](Stage stage) -> Light { return light_of(ours) - light_of(image_with(Stages().set(stage))); });
    add_in_turn(ours);
    add_pictures(ours);
  }

  std::vector<Record> records;

 private:
  [[nodiscard]] bool is_missing(Stage stage) const { return stage == shading && !view_.drawing.shading; }

  /// With the truth in these stages; what is beyond the pixel is added by `image_with`.
  [[nodiscard]] Scene scene_with(const Stages& is_true) const {
    Scene scene = scene_of(view_.seen, view_.drawing, experiment_, grid_);
    scene.field = is_true[reconstruction] ? FieldKind::bspline_prefiltered : FieldKind::trilinear;
    if (!is_true[classification]) scene.transfer = in_8_bits(scene.transfer, options_.entries, *scene.step);
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

  Record& add(std::string_view part, std::optional<std::string_view> stage) {
    return records.emplace_back(
        Record{.view = view_.seen.name, .transfer = view_.seen.transfer.name, .part = part, .stage = stage});
  }

  Record& add_error(std::string_view part, std::optional<std::string_view> stage, const Light& error) {
    const double light = light_of(truth_).sum();
    const double squares = total_.square().sum();
    Record& record = add(part, stage);
    record.error = {.rmse = std::sqrt(error.square().mean()),
                    .maximum = error.abs().maxCoeff(),
                    .bias = error.mean(),
                    .danskin_hanrahan = {},
                    .share = {}};
    if (light > 0) record.error->danskin_hanrahan = 100 * error.abs().sum() / light;
    if (squares > 0) record.error->share = 100 * (error * total_).sum() / squares;
    return record;
  }

  /// The difference that each stage makes, and what of the total error they leave over.
  void add_one_by_one(std::string_view part, const std::function<Light(Stage)>& difference_of) {
    Light left = total_;
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
      const auto stage = static_cast<Stage>(i);
      if (is_missing(stage)) continue;
      const Light difference = difference_of(stage);
      left -= difference;
      add_error(part, stage_names[i], difference);
    }
    add_error(part, "interaction", left);
  }

  /// The errors that are left when stage after stage is mended: down to the truth's.
  void add_in_turn(const Image& ours) {
    Light before = light_of(ours);
    Stages is_true;
    for (std::size_t i = 0; i < stage_names.size(); ++i) {
      is_true.set(i);
      if (is_missing(static_cast<Stage>(i))) continue;
      const Light light = light_of(is_true.all() ? truth_ : image_with(is_true));
      add_error("in turn", stage_names[i], before - light).rmse_left =
          std::sqrt((light - light_of(truth_)).square().mean());
      before = light;
    }
  }

  void add_picture(std::optional<std::string_view> stage, std::vector<PictureLine> lines) {
    for (PictureLine& line : lines) add("picture", stage).picture = std::move(line);
  }

  void add_pictures(const Image& ours) {
    add_picture({}, color_lines(truth_));
    add_picture("all", error_lines(ours, truth_, options_.gain));
    for (const auto& [stage, image] : alone_)
      add_picture(stage_names[stage], error_lines(image, truth_, options_.gain));
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

Columns<StageError> error_columns() {
  return {
      {.name = "rmse",
       .unit = "of white",
       .description = "root mean square of the difference, light in [0, 1]",
       .cell = &StageError::rmse},
      {.name = "maximum",
       .unit = "of white",
       .description = "its largest magnitude in a channel",
       .cell = &StageError::maximum},
      {.name = "bias", .unit = "of white", .description = "its mean", .cell = &StageError::bias},
      {.name = "danskin_hanrahan",
       .unit = "%",
       .description = "100 sum of its magnitudes / sum of the truth",
       .cell = &StageError::danskin_hanrahan},
      {.name = "share",
       .unit = "%",
       .description = "of the renderer's error E: 100 <difference, E> / <E, E>; those of a part add up to 100",
       .cell = &StageError::share},
  };
}

Columns<Truth> truth_columns() {
  return {
      {.name = "radius",
       .unit = "of white",
       .description = "of the true image, largest; of a lit one measured",
       .cell = &Truth::radius},
      {.name = "not_converged",
       .description = "pixels whose radius is wider than was asked for",
       .cell = &Truth::not_converged},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "view", .description = "what is looked at", .is_key = true, .cell = &Record::view},
      {.name = "transfer", .description = "its transfer function", .is_key = true, .cell = &Record::transfer},
      {.name = "part",
       .description = "truth: the true image; all: the error of the renderer's; alone: of the truth but for one stage "
                      "(shading and early_termination: what they do to the trilinear truth); "
                      "mended: what the renderer's error loses when one stage becomes true; in turn: the same, stage "
                      "after stage, each staying true; picture: the true image, or an error",
       .is_key = true,
       .cell = &Record::part},
      {.name = "stage",
       .description =
           std::string(stage_description) + ". interaction: the renderer's error minus the sum of the others",
       .is_key = true,
       .cell = &Record::stage},
  };
  append_part(columns, &Record::error, error_columns());
  columns.push_back(
      {.name = "rmse_left",
       .unit = "of white",
       .description = "of the image then, against the truth",
       .cell = [](const Record& record) { return cell_if(record.rmse_left.has_value(), record.rmse_left); }});
  append_part(columns, &Record::truth, truth_columns());
  append_part(columns, &Record::picture, picture_columns());
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  return records_of_views(options.views, field,
                          [&](const View& view) { return ViewStudy(experiment, options, view, field.grid).records; });
}

}  // namespace

extern const Measure error_waterfall_measure;
const Measure error_waterfall_measure{MeasureDefinition<Options, Record>{
    .name = "error_waterfall",
    .summary = "what each stage of a renderer adds to an image's error, and what their interaction does",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
