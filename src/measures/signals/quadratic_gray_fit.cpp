#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "raytruth/schemes/quadratic_gray.hpp"
#include "raytruth/schemes/radius_axis.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {

namespace {

constexpr double least_curvature = 1.0 / 64;  // eps: R = 8
constexpr double largest_printed = 55.23;     // section 5.6.1.4
constexpr double largest_covered = 64;        // R = 1/8
constexpr double most_length = 64;
constexpr std::size_t places = 16;  // where a slab's signal is compared

struct Options {
  std::vector<double> lengths;  ///< of slabs, in voxels
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "lengths"});
  Options options;
  for (const JsonReader& item : json.at("lengths").items()) {
    const double length = item.positive_number();
    if (length > most_length) item.refuse(std::to_string(length), "at most 64 voxels");
    options.lengths.push_back(length);
  }
  return options;
}

/// The slabs of a ray.
struct Slabs {
  std::vector<double> sizes = {};  ///< |a|, gray values per squared length
  std::int64_t downward = 0;
  std::int64_t turning = 0;
  // Sums of squared deviations from the signal, in gray values:
  double parabola = 0;
  double line = 0;       ///< through the ends
  double two_lines = 0;  ///< through the ends and the middle, the parabola's samples
};

void examine(const Chain<3>& signal, double length, double scale, Slabs& slabs) {
  const double end = signal.length();
  for (double start = 0; start + length <= end; start += length) {
    const auto at = [&](double t) { return scale * signal.value(DoubleDouble(start + t)); };
    const double front = at(0);
    const double middle = at(0.5 * length);
    const double back = at(length);
    const QuadraticGray slab = QuadraticGray::of_samples(front, middle, back, length);
    const double curvature = slab.orientation / (slab.radius * slab.radius);
    slabs.sizes.push_back(std::abs(curvature));
    slabs.downward += curvature < 0 ? 1 : 0;
    slabs.turning += slab.turns() ? 1 : 0;
    for (std::size_t i = 0; i < places; ++i) {
      const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(places);
      const double truth = at(u * length);
      const double line = front + u * (back - front);
      const double two_lines = u < 0.5 ? front + 2 * u * (middle - front) : middle + (2 * u - 1) * (back - middle);
      const double parabola = slab.value(u * slab.scaled_length);
      slabs.line += (truth - line) * (truth - line);
      slabs.two_lines += (truth - two_lines) * (truth - two_lines);
      slabs.parabola += (truth - parabola) * (truth - parabola);
    }
  }
}

struct Record {
  double length = 0;
  std::int64_t slabs = 0;
  ShownQuantiles curvature = {};
  double curvature_max = 0;
  double flat_share = 0;
  double covered_share = 0;
  double steep_share = 0;
  double above_printed_share = 0;
  double downward_share = 0;
  double turning_share = 0;
  double parabola_error = 0;
  double line_error = 0;
  double two_lines_error = 0;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "length", .unit = "voxel", .description = "D, of slabs", .is_key = true, .cell = &Record::length},
      {.name = "slabs", .description = "of all rays", .cell = &Record::slabs}};
  append_part(
      columns, &Record::curvature,
      shown_quantile_columns("curvature", "gray value/voxel^2", "|a| of the parabola through a slab's samples"));
  append(columns,
         Columns<Record>{
             {.name = "curvature_max",
              .unit = "gray value/voxel^2",
              .description = "the largest |a|",
              .cell = &Record::curvature_max},
             {.name = "flat_share",
              .description = "slabs with |a| < 1/64, below the print's threshold",
              .cell = &Record::flat_share},
             {.name = "covered_share", .description = "slabs with R from 2^-3 to 2^3", .cell = &Record::covered_share},
             {.name = "steep_share", .description = "slabs with R < 2^-3", .cell = &Record::steep_share},
             {.name = "above_printed_share",
              .description = "slabs with |a| > 55.23",
              .cell = &Record::above_printed_share},
             {.name = "downward_share",
              .description = "slabs with a < 0, which as printed are linear",
              .cell = &Record::downward_share},
             {.name = "turning_share", .description = "slabs with an extremum inside", .cell = &Record::turning_share},
             {.name = "parabola_error",
              .unit = "gray value",
              .description = "root mean square deviation of the parabola through front, middle and back, at 16 places "
                             "of every slab",
              .cell = &Record::parabola_error},
             {.name = "line_error",
              .unit = "gray value",
              .description = "of the line through front and back",
              .cell = &Record::line_error},
             {.name = "two_lines_error",
              .unit = "gray value",
              .description = "of the two lines through the parabola's three samples",
              .cell = &Record::two_lines_error},
             {.name = "parabola_over_two_lines",
              .description = "quotient of these errors, at equal samples",
              .cell = [](const Record& record) { return record.parabola_error / record.two_lines_error; }},
             {.name = "parabola_over_line",
              .description = "quotient of these errors, at equal slabs",
              .cell = [](const Record& record) { return record.parabola_error / record.line_error; }},
         });
  return columns;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  const auto [low, high] = field.grid.range();
  const double scale = largest_gray / (high - low);
  std::vector<Record> records;
  for (const double length : options.lengths) {
    std::vector<Slabs> rays(static_cast<std::size_t>(experiment.rays.count));
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t ray) {
      const Chain<3> signal =
          trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray));
      if (!signal.is_constant()) examine(signal, length, scale, rays[ray]);
    });
    Record record{.length = length};
    std::vector<double> sizes;
    for (const Slabs& slabs : rays) {
      sizes.insert(sizes.end(), slabs.sizes.begin(), slabs.sizes.end());
      record.downward_share += static_cast<double>(slabs.downward);
      record.turning_share += static_cast<double>(slabs.turning);
      record.parabola_error += slabs.parabola;
      record.line_error += slabs.line;
      record.two_lines_error += slabs.two_lines;
    }
    std::sort(sizes.begin(), sizes.end());
    record.slabs = static_cast<std::int64_t>(sizes.size());
    if (sizes.empty()) continue;
    const auto count = static_cast<double>(sizes.size());
    const auto below = [&](double size) {
      return static_cast<double>(std::lower_bound(sizes.begin(), sizes.end(), size) - sizes.begin()) / count;
    };
    record.curvature = shown_quantiles(sizes);
    record.curvature_max = sizes.back();
    record.flat_share = below(least_curvature);
    record.steep_share = 1 - below(largest_covered);
    record.covered_share = 1 - record.flat_share - record.steep_share;
    record.above_printed_share = 1 - below(largest_printed);
    record.downward_share /= count;
    record.turning_share /= count;
    for (double* const error : {&record.parabola_error, &record.line_error, &record.two_lines_error})
      *error = std::sqrt(*error / (count * static_cast<double>(places)));
    records.push_back(record);
  }
  return records;
}

}  // namespace

extern const Measure quadratic_gray_fit_measure;
const Measure quadratic_gray_fit_measure{MeasureDefinition<Options, Record>{
    .name = "quadratic_gray_fit",
    .summary = "curvatures of slabs of volumes in gray values, and how well a parabola fits them",
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
