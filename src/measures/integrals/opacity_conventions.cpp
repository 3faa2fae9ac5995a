#include "experiments/measure.hpp"
#include "measures/error_summary.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/transfer/opacity_convention.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace raytruth {

namespace {

// What a number x of a table can mean. Each meaning is an extinction, so that rays are integrated with a certificate
// and two results differ by nothing but the meaning.

double as_extinction(double x, double /*step*/) { return x; }

/// Of an opacity below 1, whose extinction is finite.
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

Options read_options(const JsonReader& json) {
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

/// Of all rays but the constant ones.
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

Value mean_opacity(const Integrals& rays) {
  double sum = 0;
  double count = 0;
  for (const auto& ray : rays) {
    sum += ray ? ray->opacity : 0;
    count += ray ? 1 : 0;
  }
  return count > 0 ? Value(sum / count) : Value();
}

}  // namespace

std::vector<Column> opacity_conventions_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns{
      {.name = "shape", .unit = "", .description = "transfer function whose extinctions are the table", .is_key = true},
      {.name = "peak", .unit = "", .description = "the table's largest number", .is_key = true},
      {.name = "emission", .unit = "", .description = "of both integrals", .is_key = true},
      {.name = "meant",
       .unit = "",
       .description = "what the numbers x are: extinction: per voxel; opacity: of a voxel, 1 - (1 - x)^d in a step of "
                      "d voxels; product: min(1, x d) is the opacity of a step",
       .is_key = true},
      {.name = "read_as",
       .unit = "",
       .description = "what they are taken for; uncorrected: x is the opacity of a step, whatever its length",
       .is_key = true},
      {.name = "step", .unit = "voxel", .description = "d", .is_key = true},
  };
  append(columns, count_columns());
  columns.push_back({.name = "opacity_meant", .unit = "", .description = "opacity of the rays as meant, mean"});
  append(columns, error_columns("1/255", "a ray as read minus as meant"));
  return columns;
}

std::vector<Row> opacity_conventions_rows(const Experiment& experiment, const JsonReader& options, const Field& field) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  for (const std::string& shape : asked.shapes)
    for (const double peak : asked.peaks)
      for (const double step : asked.steps) {
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
            Row& row = rows.emplace_back();
            row.insert(row.end(), {{"shape", shape},
                                   {"peak", peak},
                                   {"emission", emission_name(experiment.emission)},
                                   {"meant", meanings[meant].name},
                                   {"read_as", meanings[read].name},
                                   {"step", step}});
            add_counts(row, experiment, errors.rays.size());
            row.emplace_back("opacity_meant", mean_opacity(results[meant]));
            add_errors(row, errors, 255);
          }
      }
  return rows;
}

}  // namespace raytruth
