#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/transfer/opacity_convention.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

// What a number x of a table can mean. Each meaning is an extinction, so that rays are integrated with a certificate
// and two results differ by nothing but the meaning.

double as_extinction(double x, double /*step*/) { return x; }

/// The extinction of an opacity below 1, which is finite.
double as_opacity_of(double x, double length) { return extinction_of(std::min(x, largest_opacity), length); }

double as_opacity(double x, double /*step*/) { return as_opacity_of(x, 1); }

/// min(1, x d) as the opacity of a step of d voxels: the first order of the two above.
double as_product(double x, double step) { return as_opacity_of(clamped_opacity(x, step), step); }

/// The opacity of a voxel taken for that of a step, whatever its length.
double as_uncorrected(double x, double step) { return as_opacity_of(x, step); }

struct Meaning {
  const char* name;
  double (*extinction)(double x, double step);
};

constexpr std::array meanings{Meaning{"extinction", as_extinction}, Meaning{"opacity", as_opacity},
                              Meaning{"product", as_product}, Meaning{"uncorrected", as_uncorrected}};

// As where a transfer function is stated in opacities: linear between two points of the table are its numbers, not the
// extinctions that they mean.
constexpr int intervals_per_interval = 1024;

/// The transfer function of a table whose numbers stand in place of the extinction.
PiecewiseLinear read_as(const PiecewiseLinear& table, const Meaning& meaning, double step) {
  const auto& points = table.points();
  std::vector<TransferPoint> read;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i - 1].s < points[i].s)
      for (int k = 1; k < intervals_per_interval; ++k) {
        const double weight = static_cast<double>(k) / intervals_per_interval;
        const double x = std::lerp(points[i - 1].optics.extinction, points[i].optics.extinction, weight);
        const double s = std::lerp(points[i - 1].s, points[i].s, weight);
        read.push_back({s, {meaning.extinction(x, step), table.at(s).color}});
      }
    read.push_back({points[i].s, {meaning.extinction(points[i].optics.extinction, step), points[i].optics.color}});
  }
  return PiecewiseLinear(std::move(read));
}

struct Options {
  std::vector<std::string> shapes;
  std::vector<double> peaks;
  std::vector<double> steps;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "peaks", "steps"});
  std::vector<std::string_view> shapes;
  for (const auto& transfer : catalogue::transfers)
    if (transfer.make != nullptr) shapes.push_back(transfer.name);
  Options options;
  for (const JsonReader& shape : json.at("shapes").items()) options.shapes.push_back(shape.word(shapes));
  for (const JsonReader& peak : json.at("peaks").items()) options.peaks.push_back(peak.number(0, largest_opacity));
  for (const JsonReader& step : json.at("steps").items()) options.steps.push_back(step.number(0x1p-10, 1024));
  return options;
}

/// The errors of all rays but the constant ones.
using Integrals = std::vector<std::optional<Certified>>;

Integrals integrate(const Experiment& experiment, const Field& field, const PiecewiseLinear& transfer) {
  Integrals rays(static_cast<std::size_t>(experiment.rays.count));
  study_rays(experiment, field, transfer, [&rays](const StudiedRay& ray) { rays[ray.index] = ray.truth; });
  return rays;
}

RayErrors differences(const Integrals& found, const Integrals& meant) {
  RayErrors errors;
  for (std::size_t ray = 0; ray < found.size(); ++ray)
    if (found[ray])
      errors.add({found[ray]->color - meant[ray]->color, found[ray]->opacity - meant[ray]->opacity},
                 found[ray]->radius + meant[ray]->radius);
  return errors;
}

/// None where every ray is constant.
std::optional<double> mean_opacity(const Integrals& rays) {
  double sum = 0;
  double count = 0;
  for (const auto& ray : rays) {
    sum += ray ? ray->opacity : 0;
    count += ray ? 1 : 0;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

/// A table whose numbers mean one thing and are taken for another.
struct Record {
  std::string shape;
  double peak = 0;
  Emission emission;
  const Meaning* meant;
  const Meaning* read_as;
  double step = 0;
  RayCounts rays;
  std::optional<double> opacity_meant;
  ErrorSummary errors;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "shape",
       .description = "transfer function whose extinctions are the table",
       .is_key = true,
       .cell = &Record::shape},
      {.name = "peak", .description = "the table's largest number", .is_key = true, .cell = &Record::peak},
      {.name = "emission",
       .description = "of both integrals",
       .is_key = true,
       .cell = [](const Record& record) { return emission_name(record.emission); }},
      {.name = "meant",
       .description = "what the numbers x are: extinction: per voxel; opacity: of a voxel, 1 - (1 - x)^d in a step of "
                      "d voxels; product: min(1, x d) is the opacity of a step",
       .is_key = true,
       .cell = [](const Record& record) { return record.meant->name; }},
      {.name = "read_as",
       .description = "what they are taken for; uncorrected: x is the opacity of a step, whatever its length",
       .is_key = true,
       .cell = [](const Record& record) { return record.read_as->name; }},
      {.name = "step", .unit = "voxel", .description = "d", .is_key = true, .cell = &Record::step},
  };
  append_part(columns, &Record::rays, ray_count_columns());
  columns.push_back(
      {.name = "opacity_meant", .description = "opacity of the rays as meant, mean", .cell = &Record::opacity_meant});
  append_part(columns, &Record::errors, error_summary_columns("1/255", "a ray as read minus as meant"));
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<Record> records;
  for (const std::string& shape : options.shapes)
    for (const double peak : options.peaks)
      for (const double step : options.steps) {
        const auto& entry = *std::find_if(catalogue::transfers.begin(), catalogue::transfers.end(),
                                          [&shape](const auto& transfer) { return transfer.name == shape; });
        const PiecewiseLinear table = entry.make(peak, experiment.seed);
        std::vector<Integrals> results;
        for (const Meaning& meaning : meanings)
          results.push_back(integrate(experiment, field, read_as(table, meaning, step)));
        for (std::size_t meant = 0; meant + 1 < meanings.size(); ++meant)
          for (std::size_t read = 0; read < meanings.size(); ++read) {
            if (read == meant) continue;
            const RayErrors errors = differences(results[read], results[meant]);
            records.push_back({.shape = shape,
                               .peak = peak,
                               .emission = experiment.emission,
                               .meant = &meanings[meant],
                               .read_as = &meanings[read],
                               .step = step,
                               .rays = ray_counts(experiment, errors.rays.size()),
                               .opacity_meant = mean_opacity(results[meant]),
                               .errors = summary_of(errors, 255)});
          }
      }
  return records;
}

}  // namespace

extern const Measure opacity_conventions_measure;
const Measure opacity_conventions_measure{MeasureDefinition<Options, Record>{
    .name = "opacity_conventions",
    .summary = "what it costs to take a table of one convention of opacity for another",
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
