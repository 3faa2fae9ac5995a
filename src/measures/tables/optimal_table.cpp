#include "experiments/measure.hpp"
#include "measures/images/pictures.hpp"
#include "measures/images/studied_view.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/renderer.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear_value.hpp"
#include "raytruth/statistics/grid_interpolation.hpp"
#include "raytruth/statistics/linear_fit.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/look_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t largest_size = 2048;
constexpr double largest_gain = 65536;
constexpr std::int64_t most_slabs = 1'000'000;
constexpr std::size_t histogram_bins = 256;

/// Cases to be looked at: the image without a table, and the errors with tables, so many times as bright.
struct Pictures {
  std::vector<std::string> fields;
  std::vector<std::string> transfers;  ///< of these
  std::vector<std::size_t> sizes;
  double gain = 1;
};

struct Options {
  std::array<std::int64_t, 2> size{};
  GridView camera;
  std::vector<std::size_t> sizes = {};  ///< of tables, ascending
  std::size_t reference = 0;            ///< of the dissertation's reference image
  double threshold = 0;                 ///< %
  std::int64_t slabs = 0;
  std::size_t slab_table = 0;  ///< of the table that the slabs are read from
  Pictures pictures = {};
};

std::size_t read_size(const JsonReader& json) { return static_cast<std::size_t>(json.integer(2, largest_size)); }

Pictures read_pictures(const Experiment& experiment, const JsonReader& json) {
  json.only({"cases", "sizes", "gain"});
  Pictures pictures;
  for (const JsonReader& item : json.at("cases").items()) {
    item.only({"field", "transfer"});
    pictures.fields.push_back(item.at("field").word(names_of(experiment.fields)));
    pictures.transfers.push_back(read_transfer(experiment, item).name);
  }
  for (const JsonReader& size : json.at("sizes").items()) pictures.sizes.push_back(read_size(size));
  pictures.gain = json.at("gain").number(1, largest_gain);
  return pictures;
}

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "camera", "sizes", "reference", "threshold", "slabs", "slab_table", "pictures"});
  Options options{.size = read_image_size(json.at("size")), .camera = read_grid_view(json.at("camera"), options.size)};
  for (const JsonReader& size : json.at("sizes").items()) {
    options.sizes.push_back(read_size(size));
    if (options.sizes.size() > 1 && !(options.sizes.end()[-2] < options.sizes.back()))
      size.refuse_value("a size above the one before");
  }
  options.reference = read_size(json.at("reference"));
  options.threshold = json.at("threshold").positive_number();
  options.slabs = json.at("slabs").integer(1, most_slabs);
  options.slab_table = read_size(json.at("slab_table"));
  if (const auto pictures = json.find("pictures")) options.pictures = read_pictures(experiment, *pictures);
  return options;
}

// --- What the rows tell ---

/// An image with a table of this size, and its errors; none over black.
struct ImageOfSize {
  std::size_t table_size;
  std::optional<double> error;               ///< %, against the same steps without a table
  std::optional<double> error_to_reference;  ///< %
};

/// What is known of a volume under a transfer function.
struct CaseFacts {
  std::size_t voxels;
  double mean_opacity;
  double bend;
  double slab_error;                                 ///< %
  std::optional<std::size_t> smallest;               ///< size from which on all errors are below the threshold
  std::optional<std::size_t> smallest_to_reference;  ///< the same against the reference image
  std::optional<double> error_without_table;         ///< %, against the certified image
};

/// A line of the image without a table, or of the error with one.
struct CasePicture {
  std::optional<std::size_t> table_size;
  PictureLine line;
};

/// A model, and what is kept from it.
struct Asked {
  std::string_view model;
  std::string_view held_out;
};

/// A prediction of a case.
struct Predicted {
  std::string volume;
  Asked asked;
  double smallest;  ///< as the case has it
  double predicted;
  double octaves;
};

/// All of a model's predictions.
struct Quality {
  Asked asked;
  std::size_t cases;
  double rms_octaves;
  double largest_octaves;
  std::optional<double> skill;  ///< none where the model mean errs nowhere
  double within_half_octave;    ///< %
  double sufficient;            ///< %
  std::optional<double> excess = {};
};

struct Record {
  std::string transfer;  ///< empty: of all
  std::variant<ImageOfSize, CaseFacts, CasePicture, Predicted, Quality> part;
};

// --- What a case is, and what is known of it ---

/// integral of the opacity of a unit of length over all scalars (dissertation, eq. 5.6.2), exactly: it is
/// 1 - exp(-tau) on every interval of linear tau.
double mean_opacity(const PiecewiseLinear& transfer) {
  const auto& points = transfer.points();
  const auto part = [](double width, double front, double back) {
    const double slope = back - front;
    // The mean of exp(-tau) between them; where they are nearly equal that of a homogeneous slab, to 1e-13.
    const double through =
        std::abs(slope) < 1e-6 ? std::exp(-(front + back) / 2) : -std::exp(-front) * std::expm1(-slope) / slope;
    return width * (1 - through);
  };
  double sum =
      part(std::clamp(points.front().s, 0.0, 1.0), points.front().optics.extinction, points.front().optics.extinction) +
      part(1 - std::clamp(points.back().s, 0.0, 1.0), points.back().optics.extinction, points.back().optics.extinction);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    sum += part(points[i + 1].s - points[i].s, points[i].optics.extinction, points[i + 1].optics.extinction);
  return sum;
}

/// The emission density, summed over channels.
double density(const Optics& optics) { return optics.extinction * optics.color.sum(); }

/// How strongly the emission density q bends where the volume has its scalars:
///     sum_k |jump of q' at point k| p(s_k) / integral q p ds,
/// p the density of the volume's scalars, from a histogram. A table's entries err by h^2/8 times their second
/// derivative; halved along a slab this is what they lack, h = 1/(n - 1), but for a constant factor. Between points
/// the product of linear extinction and colour bends too: it is split into its own chords.
double bend_of(const Grid& grid, const PiecewiseLinear& transfer) {
  std::vector<double> shares(histogram_bins, 0.0);
  const auto bin_of = [](double s) {
    return static_cast<std::size_t>(std::lround(std::clamp(s, 0.0, 1.0) * (histogram_bins - 1)));
  };
  for (const double s : grid.values) shares[bin_of(s)] += 1.0 / static_cast<double>(grid.values.size());
  // Neighbouring bins together, as slabs join neighbouring scalars.
  const auto share_near = [&](std::size_t bin) {
    const std::size_t first = bin < 2 ? 0 : bin - 2;
    const std::size_t last = std::min(bin + 2, histogram_bins - 1);
    return std::accumulate(shares.begin() + static_cast<std::ptrdiff_t>(first),
                           shares.begin() + static_cast<std::ptrdiff_t>(last) + 1, 0.0) /
           static_cast<double>(last - first + 1);
  };
  const auto q = [&](std::size_t bin) { return density(transfer.at(static_cast<double>(bin) / (histogram_bins - 1))); };
  double light = 0;
  double bend = 0;
  constexpr double step = 1.0 / (histogram_bins - 1);
  for (std::size_t bin = 0; bin < histogram_bins; ++bin) {
    light += shares[bin] * q(bin);
    if (bin > 0 && bin + 1 < histogram_bins)
      bend += std::abs(q(bin - 1) - 2 * q(bin) + q(bin + 1)) / step * share_near(bin) / step;
  }
  return light > 0 ? bend / light : 0;
}

/// The error of look-ups in a table of this size, over random slabs of a unit's length in the volume, relative to
/// their light.
double slab_error(const Experiment& experiment, const Grid& grid, const PiecewiseLinear& transfer,
                  const Options& options) {
  const TableAxes axes{.size = options.slab_table, .low = 0, .high = 1, .length = 1};
  const Table<double> table = exact_table(transfer, axes, experiment.emission);
  const auto texel = [&table](std::size_t front, std::size_t back) { return table.at(front, back); };
  RayIntegral exact(transfer, experiment.emission);
  Chain<3> slab;
  slab.pieces = {{0.0, 1.0, {}}};
  slab.end = 1.0;
  double light = 0;
  double error = 0;
  for (std::int64_t i = 0; i < options.slabs; ++i) {
    const Ray ray = random_ray(grid, 1, experiment.seed, static_cast<std::uint64_t>(i));
    std::array<double, 3> end{};
    for (std::size_t axis = 0; axis < 3; ++axis) end[axis] = ray.origin[axis] + ray.direction[axis];
    const double front = trilinear_value(grid, ray.origin);
    const double back = trilinear_value(grid, end);
    slab.pieces[0].polynomial.coefficients = {front, std::lerp(front, back, 1.0 / 3), std::lerp(front, back, 2.0 / 3),
                                              back};
    const Vector3<double> truth = exact(slab).color;
    light += truth.sum();
    error += (bilinear<double>(axes, texel, {front, back}).head<3>() - truth).abs().sum();
  }
  return light > 0 ? error / light : 0;
}

// --- Images of a case ---

/// Renders a case with tables of all sizes.
class CaseStudy {
 public:
  CaseStudy(const Experiment& experiment, const Options& options, const Field& field, const NamedTransfer& transfer)
      : experiment_(experiment), options_(options), field_(field), transfer_(transfer) {
    const Image exact = render("order1", {});
    const Image reference = render("order1", options.reference);
    std::vector<std::optional<double>> errors;
    std::vector<std::optional<double>> errors_to_reference;
    for (const std::size_t size : options.sizes) {
      const Image image = render("order1", size);
      errors.push_back(percent(image, exact));
      errors_to_reference.push_back(percent(image, reference));
      add(ImageOfSize{size, errors.back(), errors_to_reference.back()});
    }
    add(CaseFacts{.voxels = field.grid.values.size(),
                  .mean_opacity = mean_opacity(transfer.transfer),
                  .bend = bend_of(field.grid, transfer.transfer),
                  .slab_error = 100 * slab_error(experiment, field.grid, transfer.transfer, options),
                  .smallest = smallest(errors),
                  .smallest_to_reference = smallest(errors_to_reference),
                  .error_without_table = percent(exact, render("reference", {}))});
    add_pictures(exact);
  }

  std::vector<Record> records;

 private:
  template <class Part>
  void add(Part part) {
    records.push_back({transfer_.name, std::move(part)});
  }

  void add_pictures(const Image& exact) {
    const Pictures& pictures = options_.pictures;
    for (std::size_t i = 0; i < pictures.fields.size(); ++i) {
      if (pictures.fields[i] != field_.name || pictures.transfers[i] != transfer_.name) continue;
      for (PictureLine& line : color_lines(exact)) add(CasePicture{{}, std::move(line)});
      for (const std::size_t size : pictures.sizes)
        for (PictureLine& line : error_lines(render("order1", size), exact, pictures.gain))
          add(CasePicture{size, std::move(line)});
    }
  }

  [[nodiscard]] Image render(const std::string& scheme, std::optional<std::size_t> table) const {
    Scene scene{.grid = field_.grid, .transfer = transfer_.transfer};
    scene.emission = experiment_.emission;
    scene.camera = aimed(options_.camera, field_.grid);
    scene.scheme = scheme;
    if (scheme != "reference") scene.step = 1;
    if (table) scene.table = SceneTable{.size = *table};
    return Renderer(std::move(scene)).render().image;
  }

  static std::optional<double> percent(const Image& image, const Image& reference) {
    const auto relative = image_error(image, reference).relative;
    return relative ? std::optional(100 * *relative) : std::nullopt;
  }

  /// The size from which on all errors are below the threshold.
  [[nodiscard]] std::optional<std::size_t> smallest(const std::vector<std::optional<double>>& errors) const {
    std::optional<std::size_t> found;
    for (std::size_t i = errors.size(); i-- > 0 && errors[i] && *errors[i] < options_.threshold;)
      found = options_.sizes[i];
    return found;
  }

  const Experiment& experiment_;
  const Options& options_;
  const Field& field_;
  const NamedTransfer& transfer_;
};

// --- Predictions ---

/// A case with an answer.
struct Case {
  std::string field;
  std::string transfer;
  double voxels;
  double mean_opacity;
  double bend;
  double slab_error;
  double smallest;  ///< log2
};

using Prediction = std::function<double(const Case&)>;

struct Model {
  std::string_view name;
  std::string_view description;
  Prediction (*fit)(const std::vector<Case>&);
};

template <class FeaturesOf>
Prediction linear_prediction(const std::vector<Case>& cases, FeaturesOf features_of) {
  std::vector<Observation> observations;
  for (const Case& item : cases) observations.push_back({features_of(item), item.smallest});
  return [fit = fit_linear(observations), features_of](const Case& item) { return fit(features_of(item)); };
}

constexpr std::array models{
    Model{"mean", "the geometric mean, whatever the case",
          [](const std::vector<Case>& cases) {
            return linear_prediction(cases, [](const Case&) { return std::vector<double>{}; });
          }},
    Model{"interpolated", "as published: interpolated between the sizes and mean opacities of the other cases",
          [](const std::vector<Case>& cases) -> Prediction {
            std::vector<PlaneValue> values;
            for (const Case& item : cases) values.push_back({item.voxels, item.mean_opacity, item.smallest});
            return
                [plane = GridInterpolation(values)](const Case& item) { return plane(item.voxels, item.mean_opacity); };
          }},
    Model{"refitted", "log2 n linear in log2 of the size and in the mean opacity",
          [](const std::vector<Case>& cases) {
            return linear_prediction(cases, [](const Case& item) {
              return std::vector<double>{std::log2(item.voxels), item.mean_opacity};
            });
          }},
    Model{"bend", "log2 n linear in log2 of the bend of the emission density under the histogram",
          [](const std::vector<Case>& cases) {
            return linear_prediction(cases, [](const Case& item) { return std::vector<double>{std::log2(item.bend)}; });
          }},
    Model{"slabs", "log2 n linear in log2 of the look-up error of random slabs",
          [](const std::vector<Case>& cases) {
            return linear_prediction(cases,
                                     [](const Case& item) { return std::vector<double>{std::log2(item.slab_error)}; });
          }},
};

/// The cases of rows whose table size is known; one in which nothing is visible, or no table suffices, is none.
std::vector<Case> cases_of(const std::vector<Row>& rows) {
  std::vector<Case> cases;
  for (const Row& row : rows) {
    const auto number = [&row](std::string_view name) { return as_number(cell(row, name)).value_or(0); };
    if (number("smallest") == 0 || number("bend") == 0 || number("slab_error") == 0) continue;
    cases.push_back({std::get<std::string>(cell(row, "field")), std::get<std::string>(cell(row, "transfer")),
                     number("voxels"), number("mean_opacity"), number("bend"), number("slab_error"),
                     std::log2(number("smallest"))});
  }
  return cases;
}

/// What is kept from a model that is to predict a case.
struct HeldOut {
  std::string_view name;
  bool (*is_held_out)(const Case& known, const Case& asked);
};

constexpr std::array held_out_kinds{
    HeldOut{"volume", [](const Case& known, const Case& asked) { return known.field == asked.field; }},
    HeldOut{"volume and transfer function",
            [](const Case& known, const Case& asked) {
              return known.field == asked.field || known.transfer == asked.transfer;
            }},
};

std::optional<double> predict(const Model& model, const std::vector<Case>& cases, const HeldOut& held_out,
                              const Case& asked) {
  std::vector<Case> known;
  for (const Case& item : cases)
    if (!held_out.is_held_out(item, asked)) known.push_back(item);
  if (known.empty()) return {};
  return model.fit(known)(asked);
}

/// A model's predictions of all cases, and what they come to.
class ModelStudy {
 public:
  ModelStudy(const Options& options, const std::vector<Case>& cases, const Model& model, const HeldOut& held_out)
      : sizes_(options.sizes), asked_{model.name, held_out.name} {
    for (const Case& item : cases)
      if (const auto predicted = predict(model, cases, held_out, item)) add(item, *predicted);
  }

  [[nodiscard]] const std::vector<Record>& predictions() const { return predictions_; }

  /// In octaves.
  [[nodiscard]] double sum_of_squares() const {
    return std::inner_product(octaves_.begin(), octaves_.end(), octaves_.begin(), 0.0);
  }

  /// `of_mean`: the model mean's sum of squares. There are predictions.
  [[nodiscard]] Record quality(double of_mean) const {
    const auto count = static_cast<double>(octaves_.size());
    const double squares = sum_of_squares();
    const auto largest = std::max_element(octaves_.begin(), octaves_.end(),
                                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    Quality quality{.asked = asked_,
                    .cases = octaves_.size(),
                    .rms_octaves = std::sqrt(squares / count),
                    .largest_octaves = std::abs(*largest),
                    .skill = of_mean > 0 ? std::optional(1 - squares / of_mean) : std::nullopt,
                    .within_half_octave = 100 * static_cast<double>(within_) / count,
                    .sufficient = 100 * static_cast<double>(excesses_.size()) / count};
    if (!excesses_.empty())
      quality.excess = std::exp2(2 * std::accumulate(excesses_.begin(), excesses_.end(), 0.0) /
                                 static_cast<double>(excesses_.size()));
    return {{}, quality};
  }

 private:
  /// The binary logarithm of the next size that is asked for.
  [[nodiscard]] double rounded_up(double exponent) const {
    const auto next = std::find_if(sizes_.begin(), sizes_.end(), [exponent](std::size_t size) {
      return std::log2(static_cast<double>(size)) >= exponent - 1e-9;
    });
    return std::log2(static_cast<double>(next == sizes_.end() ? sizes_.back() : *next));
  }

  void add(const Case& item, double predicted) {
    octaves_.push_back(predicted - item.smallest);
    within_ += std::abs(octaves_.back()) <= 0.5 ? 1 : 0;
    if (const double excess = rounded_up(predicted) - item.smallest; excess >= 0) excesses_.push_back(excess);
    predictions_.push_back({item.transfer, Predicted{item.field, asked_, std::exp2(item.smallest), std::exp2(predicted),
                                                     octaves_.back()}});
  }

  const std::vector<std::size_t>& sizes_;
  Asked asked_;
  std::vector<Record> predictions_;
  std::vector<double> octaves_;   ///< of predicted over smallest
  std::vector<double> excesses_;  ///< octaves, of those that suffice once rounded up
  std::size_t within_ = 0;        ///< half an octave
};

// --- Columns ---

/// The record's part, if it is of this type.
template <class Part>
const Part* part_of(const Record& record) {
  return std::get_if<Part>(&record.part);
}

std::string_view part_name(const Record& record) {
  constexpr std::array<std::string_view, 5> names{"size", "case", "picture", "prediction", "model"};
  return names[record.part.index()];
}

std::optional<Value> table_size_of(const Record& record) {
  if (const auto* const image = part_of<ImageOfSize>(record)) return value_of(image->table_size);
  if (const auto* const picture = part_of<CasePicture>(record)) return value_of(picture->table_size);
  return std::nullopt;
}

const Asked* asked_of(const Record& record) {
  if (const auto* const predicted = part_of<Predicted>(record)) return &predicted->asked;
  if (const auto* const quality = part_of<Quality>(record)) return &quality->asked;
  return nullptr;
}

Columns<Asked> asked_columns() {
  std::string list;
  for (const Model& model : models)
    list += fmt::format("{}{}: {}", list.empty() ? "" : "; ", model.name, model.description);
  return {
      {.name = "model", .description = list, .is_key = true, .cell = &Asked::model},
      {.name = "held_out",
       .description = "a model predicts a case from those of other volumes, or of other volumes under other transfer "
                      "functions",
       .is_key = true,
       .cell = &Asked::held_out},
  };
}

Columns<ImageOfSize> image_columns(const Options& options) {
  return {
      {.name = "error",
       .unit = "%",
       .description = "100 sum |I - I_r| / sum I_r (Danskin and Hanrahan 1992) against the same steps without a table; "
                      "null over black",
       .cell = &ImageOfSize::error},
      {.name = "error_to_reference",
       .unit = "%",
       .description =
           fmt::format("the same against the image of a table of {} entries, as published", options.reference),
       .cell = &ImageOfSize::error_to_reference},
  };
}

Columns<CaseFacts> case_columns(const Options& options) {
  return {
      {.name = "voxels", .description = "of the volume: its bytes, were each a byte", .cell = &CaseFacts::voxels},
      {.name = "mean_opacity",
       .description = "of a step, over all scalars (eq. 5.6.2)",
       .cell = &CaseFacts::mean_opacity},
      {.name = "bend",
       .description =
           "sum |jump of q'| p / integral q p ds: q the emission density summed over channels, p the density "
           "of the volume's scalars, both at 256 scalars",
       .cell = &CaseFacts::bend},
      {.name = "slab_error",
       .unit = "%",
       .description = fmt::format("the same error of {} random slabs, a step long, read from a table of {} entries",
                                  options.slabs, options.slab_table),
       .cell = &CaseFacts::slab_error},
      {.name = "smallest",
       .description = fmt::format("the table size from which on the error stays below {} %; null: none asked for, or "
                                  "nothing is visible",
                                  options.threshold),
       .cell = &CaseFacts::smallest},
      {.name = "smallest_to_reference",
       .description = "the same of error_to_reference",
       .cell = &CaseFacts::smallest_to_reference},
      {.name = "error_without_table",
       .unit = "%",
       .description = "of the same steps without a table against the certified image: what no table can mend",
       .cell = &CaseFacts::error_without_table},
  };
}

Columns<Predicted> prediction_columns() {
  return {
      written_here<Predicted>("smallest", &Predicted::smallest),
      {.name = "predicted", .description = "table size", .cell = &Predicted::predicted},
      {.name = "octaves", .description = "log2 of predicted over smallest", .cell = &Predicted::octaves},
  };
}

Columns<Quality> quality_columns() {
  return {
      {.name = "cases", .description = "predicted", .cell = &Quality::cases},
      {.name = "rms_octaves", .description = "root mean square of octaves", .cell = &Quality::rms_octaves},
      {.name = "largest_octaves", .description = "largest magnitude of octaves", .cell = &Quality::largest_octaves},
      {.name = "skill",
       .description = "1 - the sum of their squares over that of the model mean: 1 predicts all, 0 no better than "
                      "the mean of the other cases",
       .cell = &Quality::skill},
      {.name = "within_half_octave",
       .unit = "%",
       .description = "predictions that are no farther than a factor of sqrt 2 from the smallest",
       .cell = &Quality::within_half_octave},
      {.name = "sufficient",
       .unit = "%",
       .description = "predictions that, rounded up to the next size asked for, suffice",
       .cell = &Quality::sufficient},
      {.name = "excess",
       .description = "how many times as many entries as needed these have, in the geometric mean",
       .cell = [](const Quality& quality) { return cell_if(quality.excess.has_value(), quality.excess); }},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& options) {
  Columns<Record> columns{
      {.name = "transfer",
       .description = "the transfer function",
       .is_key = true,
       .cell = [](const Record& record) { return cell_if(!record.transfer.empty(), record.transfer); }},
      {.name = "part",
       .description = "size: an image; case: a volume and a transfer function; prediction: of a case from others; "
                      "model: all of a model's predictions; picture: the image without a table, or the error with one",
       .is_key = true,
       .cell = part_name},
      {.name = "table_size",
       .description = "entries along each axis of the table",
       .is_key = true,
       .cell = table_size_of},
      {.name = "volume",
       .description = "of which a size is predicted",
       .is_key = true,
       .cell = [](const Record& record) -> std::optional<Value> {
         const auto* const predicted = part_of<Predicted>(record);
         return predicted != nullptr ? std::optional<Value>(predicted->volume) : std::nullopt;
       }},
  };
  append_part(columns, asked_of, asked_columns());
  append_part(columns, part_of<ImageOfSize>, image_columns(options));
  append_part(columns, part_of<CaseFacts>, case_columns(options));
  append_part(columns, part_of<Predicted>, prediction_columns());
  append_part(columns, part_of<Quality>, quality_columns());
  append_part(
      columns,
      [](const Record& record) {
        const auto* const picture = part_of<CasePicture>(record);
        return picture != nullptr ? &picture->line : nullptr;
      },
      picture_columns());
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const NamedTransfer& transfer : experiment.transfers) {
    std::vector<Record> of_case = CaseStudy(experiment, options, field, transfer).records;
    records.insert(records.end(), std::make_move_iterator(of_case.begin()), std::make_move_iterator(of_case.end()));
  }
  return records;
}

/// The predictions of all models, and then what each of them comes to.
std::vector<Record> conclusions(const Experiment& /*experiment*/, const Options& options,
                                const std::vector<Row>& rows_of_fields) {
  const std::vector<Case> cases = cases_of(rows_of_fields);
  std::vector<Record> records;
  std::vector<Record> of_models;
  for (const HeldOut& held_out : held_out_kinds) {
    double of_mean = 0;
    for (const Model& model : models) {
      const ModelStudy study(options, cases, model, held_out);
      if (study.predictions().empty()) continue;
      if (model.name == models.front().name) of_mean = study.sum_of_squares();
      records.insert(records.end(), study.predictions().begin(), study.predictions().end());
      of_models.push_back(study.quality(of_mean));
    }
  }
  records.insert(records.end(), std::make_move_iterator(of_models.begin()), std::make_move_iterator(of_models.end()));
  return records;
}

}  // namespace

extern const Measure optimal_table_measure;
const Measure optimal_table_measure{MeasureDefinition<Options, Record>{
    .name = "optimal_table",
    .summary = "the smallest table that an image needs, and how well it is predicted",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field,
    .conclusions = conclusions}};

}  // namespace raytruth
