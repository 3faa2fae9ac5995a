#include "raytruth/tables/partial_pre_integration.hpp"
#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_slabs = 10'000'000;
constexpr double deepest = 64;  ///< optical depth drawn

constexpr std::array look_ups{std::pair{PsiLookUp::nearest, "nearest"}, std::pair{PsiLookUp::bilinear, "bilinear"}};

struct Options {
  std::vector<std::size_t> sizes;
  std::size_t slabs = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "sizes", "slabs"});
  Options options{.sizes = {}, .slabs = static_cast<std::size_t>(json.at("slabs").integer(1, most_slabs))};
  for (const JsonReader& size : json.at("sizes").items())
    options.sizes.push_back(static_cast<std::size_t>(size.integer(2, largest_table_size)));
  return options;
}

/// A slab with optics that are linear from front to back.
struct LinearOptics {
  Optics front;
  Optics back;
  Certified truth;
};

std::vector<LinearOptics> draw_slabs(std::size_t count, std::uint64_t seed) {
  std::vector<LinearOptics> slabs;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto depths = random_numbers(seed, RandomStream::points, i);
    const auto front = random_numbers(seed, RandomStream::points, i, 1);
    const auto back = random_numbers(seed, RandomStream::points, i, 2);
    // Even in gamma = D / (D + 1), as the table is.
    const auto depth = [](double uniform) { return std::min(uniform / (1 - uniform), deepest); };
    LinearOptics slab{
        {depth(depths[0]), {front[0], front[1], front[2]}}, {depth(depths[1]), {back[0], back[1], back[2]}}, {}};
    RayIntegral integrate(PiecewiseLinear({{0, slab.front}, {1, slab.back}}), Emission::associated);
    slab.truth = integrate(Chain<3>{
        .pieces = {{.start = 0.0, .length = 1, .polynomial = Bernstein<1>{{0.0, 1.0}}.elevated<3>()}}, .end = 1.0});
    slabs.push_back(slab);
  }
  return slabs;
}

/// The errors of look-ups in a table of psi, over all slabs.
struct Record {
  std::size_t size = 0;
  const char* look_up = nullptr;
  std::size_t slabs = 0;
  double color_max = 0;
  double color_mean = 0;
  double opacity_max = 0;
  double radius = 0;

  [[nodiscard]] std::size_t bytes() const { return sizeof(float) * size * size; }
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "size", .description = "n, entries along each axis of the table", .is_key = true, .cell = &Record::size},
      {.name = "look_up", .description = "of psi: nearest or bilinear", .is_key = true, .cell = &Record::look_up},
      {.name = "slabs",
       .description = "with optics linear from front to back, depths D evenly distributed in D / (D + 1), up to 64",
       .cell = &Record::slabs},
      {.name = "bytes", .unit = "byte", .description = "of the table in binary32, one channel", .cell = &Record::bytes},
      {.name = "error_max",
       .description = "largest error of the colour, all channels, against certified slabs",
       .radius = "radius",
       .cell = &Record::color_max},
      {.name = "error_l1", .description = "mean magnitude of it", .radius = "radius", .cell = &Record::color_mean},
      {.name = "opacity_max",
       .description = "largest error of the opacity, which has a closed form",
       .radius = "radius",
       .cell = &Record::opacity_max},
      {.name = "radius", .description = "bound on the error of the errors: the reference's", .cell = &Record::radius},
  };
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  const std::vector<LinearOptics> slabs = draw_slabs(options.slabs, experiment.seed);
  std::vector<Record> records;
  for (const std::size_t size : options.sizes) {
    const PsiTable table(size);
    for (const auto& [look_up, name] : look_ups) {
      Record record{.size = size, .look_up = name, .slabs = slabs.size()};
      double color_sum = 0;
      for (const auto& [front, back, truth] : slabs) {
        const auto slab =
            partially_pre_integrated_slab(front, back, 1, table(front.extinction, back.extinction, look_up));
        const Vector3<double> error = (slab.head<3>() - truth.color).abs();
        record.color_max = std::max(record.color_max, error.maxCoeff());
        color_sum += error.mean();
        record.opacity_max = std::max(record.opacity_max, std::abs(slab[3] - truth.opacity));
        record.radius = std::max(record.radius, truth.radius);
      }
      record.color_mean = color_sum / static_cast<double>(slabs.size());
      records.push_back(record);
    }
  }
  return records;
}

}  // namespace

extern const Measure partial_pre_integration_measure;
const Measure partial_pre_integration_measure{MeasureDefinition<Options, Record>{
    .name = "partial_pre_integration",
    .summary = "errors of Moreland's partial pre-integration by the size of its table",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
