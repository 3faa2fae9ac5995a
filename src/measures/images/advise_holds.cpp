#include "experiments/measure.hpp"
#include "measures/images/drawing.hpp"
#include "measures/images/studied_view.hpp"
#include "raytruth/advice/advice.hpp"
#include "raytruth/images/image_file.hpp"
#include "raytruth/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr std::array<std::string_view, 2> halves{"tuning", "reported"};

struct View {
  StudiedView seen;
  std::string half;
  Scene drawing;  ///< its emission and light
};

/// An error that advice is asked to keep.
struct Target {
  ErrorKind kind;
  double error;
};

struct Options {
  std::vector<View> views;
  std::vector<Target> targets;
  std::int64_t rays = 0;
};

/// What advice came to, and what the whole image of it is really off by.
struct Case {
  std::string view = {};
  std::optional<std::string> scheme = {};
  std::optional<double> step = {};
  std::optional<std::size_t> table_size = {};
  std::optional<std::string> format = {};
  std::optional<double> reads = {};
  std::optional<double> promised = {};  ///< the upper bound of the advice
  std::optional<double> estimated = {};
  std::optional<double> true_error = {};
  bool is_settled = false;
  std::int64_t rays = 0;
};

/// How many promises of a half hold.
struct Count {
  std::int64_t cases = 0;
  std::int64_t promised = 0;  ///< something keeps the error, says the advice
  std::int64_t kept = 0;
};

struct Record {
  std::string_view part;
  std::string half;
  std::optional<std::string> of = {};
  std::optional<double> at_most = {};
  std::optional<Case> one = {};
  std::optional<Count> count = {};
  std::optional<bool> holds = {};
};

Options read_options(const Experiment& experiment, const JsonReader& json) {
  json.only({"kind", "size", "rays", "views", "errors"});
  Options options;
  const auto size = read_image_size(json.at("size"));
  options.rays = json.at("rays").integer(1, std::int64_t{1} << 24);
  for (const JsonReader& item : json.at("views").items()) {
    item.only({"name", "field", "transfer", "camera", "half", "shading"});
    nlohmann::ordered_json truth{{"scheme", "reference"}};
    if (const auto shading = item.find("shading")) truth["shading"] = shading->json();
    options.views.push_back({read_studied_view(experiment, item, size, names_of_views(options.views)),
                             item.at("half").word({halves.begin(), halves.end()}), read_drawing(truth, item)});
  }
  for (const JsonReader& item : json.at("errors").items()) {
    item.only({"of", "at_most"});
    const std::string kind = item.at("of").word({error_kind_names.begin(), error_kind_names.end()});
    options.targets.push_back(
        {static_cast<ErrorKind>(std::find(error_kind_names.begin(), error_kind_names.end(), kind) -
                                error_kind_names.begin()),
         item.at("at_most").positive_number()});
  }
  return options;
}

double largest_error(const Image& image, const Image& truth, ErrorKind kind) {
  double result = 0;
  const auto shown = [kind](double light) {
    return kind == ErrorKind::encoded ? srgb_of(std::clamp(light, 0.0, 1.0)) : light;
  };
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int channel = 0; channel < 3; ++channel)
      result = std::max(result, std::abs(shown(image.pixels[i][channel]) - shown(truth.pixels[i][channel])));
  return result;
}

double root_mean_square(const Image& image, const Image& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    sum += (image.pixels[i] - truth.pixels[i]).head<3>().square().sum();
  return std::sqrt(sum / (3 * static_cast<double>(image.pixels.size())));
}

Case case_of(const Scene& scene, const Image& truth, const Target& target, const Options& options, std::uint64_t seed) {
  AdviceRequest request{.scene = scene, .views = {scene.camera}, .kind = target.kind, .error = target.error};
  request.seed = seed;
  request.most_rays = options.rays;
  const Advice advice = advise(request);
  Case result{.is_settled = advice.is_settled, .rays = advice.rays};
  if (!advice.best) return result;
  const Way& way = advice.ways[*advice.best];
  result.scheme = way.scheme;
  result.step = way.step;
  if (way.table) {
    result.table_size = way.table->size;
    result.format = std::string(way.table->format.name);
  }
  result.reads = way.reads();
  result.promised = way.error.high;
  result.estimated = way.error.value;
  Scene advised = scene;
  advised.scheme = way.scheme;
  advised.step = way.step;
  advised.table = way.table;
  const Image image = Renderer(std::move(advised)).render().image;
  result.true_error =
      target.kind == ErrorKind::rmse ? root_mean_square(image, truth) : largest_error(image, truth, target.kind);
  return result;
}

std::vector<Record> records_of_view(const Experiment& experiment, const Options& options, const View& view,
                                    const Grid& grid) {
  const Scene scene = scene_of(view.seen, view.drawing, experiment, grid);
  Scene of_truth = scene;
  if (of_truth.shading) of_truth.shading->method = nullptr;
  const Image truth = Renderer(std::move(of_truth)).render().image;
  std::vector<Record> records;
  for (const Target& target : options.targets) {
    Record record{.part = "case", .half = view.half};
    record.of = std::string(error_kind_names[static_cast<std::size_t>(target.kind)]);
    record.at_most = target.error;
    record.one = case_of(scene, truth, target, options, experiment.seed);
    record.one->view = view.seen.name;
    if (record.one->true_error) record.holds = *record.one->true_error <= target.error;
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  return records_of_views(options.views, field,
                          [&](const View& view) { return records_of_view(experiment, options, view, field.grid); });
}

std::vector<Record> conclusions(const Experiment& /*experiment*/, const Options& /*options*/,
                                const std::vector<Row>& rows) {
  std::vector<Record> records;
  for (const std::string_view half : halves) {
    Count count;
    for (const Row& row : rows) {
      if (cell(row, "half") != Value(std::string(half)) || cell(row, "part") != Value("case")) continue;
      ++count.cases;
      if (cell(row, "holds") == Value()) continue;
      ++count.promised;
      if (cell(row, "holds") == Value(true)) ++count.kept;
    }
    if (count.cases > 0) records.push_back({.part = "half", .half = std::string(half), .count = count});
  }
  return records;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  const auto of_case = [](auto Case::*member) {
    return [member](const Record& record) -> std::optional<Value> {
      return record.one ? std::optional(value_of((*record.one).*member)) : std::nullopt;
    };
  };
  const auto of_count = [](auto get) {
    return [get](const Record& record) -> std::optional<Value> {
      return record.count ? std::optional(value_of(get(*record.count))) : std::nullopt;
    };
  };
  return {
      {.name = "part",
       .description = "case: advice for a view and an error; half: how many promises of those cases hold",
       .is_key = true,
       .cell = &Record::part},
      {.name = "half",
       .description = "tuning: advice may have been made to fit it; reported: it took no part in that",
       .is_key = true,
       .cell = &Record::half},
      {.name = "view", .description = "what is looked at", .is_key = true, .cell = of_case(&Case::view)},
      {.name = "of",
       .description = "what is asked for: rmse or largest error of colours in linear light, or encoded: the largest of "
                      "sRGB values",
       .is_key = true,
       .cell = [](const Record& record) { return cell_if(record.of.has_value(), record.of); }},
      {.name = "at_most",
       .description = "the error that is asked for",
       .is_key = true,
       .cell = [](const Record& record) { return cell_if(record.at_most.has_value(), record.at_most); }},
      {.name = "scheme",
       .description = "advised; null: nothing is said to keep the error",
       .cell = of_case(&Case::scheme)},
      {.name = "step", .unit = "smallest spacing", .description = "advised", .cell = of_case(&Case::step)},
      {.name = "table_size", .description = "advised: entries along each side", .cell = of_case(&Case::table_size)},
      {.name = "format", .description = "advised, of the table", .cell = of_case(&Case::format)},
      {.name = "reads", .description = "samples and look-ups for a pixel", .cell = of_case(&Case::reads)},
      {.name = "estimated", .description = "error that the advice estimates", .cell = of_case(&Case::estimated)},
      {.name = "promised", .description = "its upper bound", .cell = of_case(&Case::promised)},
      {.name = "true_error",
       .description = "of the whole image as advised against the whole true image",
       .cell = of_case(&Case::true_error)},
      {.name = "holds",
       .description = "whether that is at most what was asked for",
       .cell = [](const Record& record) { return cell_if(record.one.has_value(), record.holds); }},
      {.name = "settled",
       .description = "whether everything cheaper is known to exceed the error",
       .cell = of_case(&Case::is_settled)},
      {.name = "rays", .description = "pixels that the advice looked at", .cell = of_case(&Case::rays)},
      {.name = "cases", .description = "views and errors", .cell = of_count([](const Count& count) {
                                                             return count.cases;
                                                           })},
      {.name = "promises",
       .description = "cases for which something is advised",
       .cell = of_count([](const Count& count) { return count.promised; })},
      {.name = "kept", .description = "promises that hold", .cell = of_count([](const Count& count) {
                                                              return count.kept;
                                                            })},
      {.name = "share_kept",
       .description = "of the promises",
       .cell = of_count([](const Count& count) {
         return count.promised > 0
                    ? std::optional(static_cast<double>(count.kept) / static_cast<double>(count.promised))
                    : std::nullopt;
       })},
  };
}

}  // namespace

extern const Measure advise_holds_measure;
const Measure advise_holds_measure{MeasureDefinition<Options, Record>{
    .name = "advise_holds",
    .summary = "whether what `raytruth advise` promises of a view's error holds for the whole image",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field,
    .conclusions = conclusions}};

}  // namespace raytruth
