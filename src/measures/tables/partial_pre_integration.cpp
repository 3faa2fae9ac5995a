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

namespace raytruth {

namespace {

constexpr std::int64_t most_slabs = 10'000'000;
constexpr double deepest = 64;  ///< optical depth drawn

constexpr std::array look_ups{std::pair{PsiLookUp::nearest, "nearest"}, std::pair{PsiLookUp::bilinear, "bilinear"}};

struct Options {
  std::vector<std::size_t> sizes;
  std::size_t slabs = 0;
};

Options read_options(const JsonReader& json) {
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

}  // namespace

std::vector<Column> partial_pre_integration_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "size", .unit = "", .description = "n, entries along each axis of the table", .is_key = true},
      {.name = "look_up", .unit = "", .description = "of psi: nearest or bilinear", .is_key = true},
      {.name = "slabs",
       .unit = "",
       .description = "with optics linear from front to back, depths D evenly distributed in D / (D + 1), up to 64"},
      {.name = "bytes", .unit = "byte", .description = "of the table in binary32, one channel"},
      {.name = "error_max",
       .unit = "",
       .description = "largest error of the colour, all channels, against certified slabs",
       .is_key = false,
       .radius = "radius"},
      {.name = "error_l1", .unit = "", .description = "mean magnitude of it", .is_key = false, .radius = "radius"},
      {.name = "opacity_max",
       .unit = "",
       .description = "largest error of the opacity, which has a closed form",
       .is_key = false,
       .radius = "radius"},
      {.name = "radius", .unit = "", .description = "bound on the error of the errors: the reference's"},
  };
}

std::vector<Row> partial_pre_integration_rows(const Experiment& experiment, const JsonReader& options,
                                              const Field& /*field*/) {
  const Options asked = read_options(options);
  const std::vector<LinearOptics> slabs = draw_slabs(asked.slabs, experiment.seed);
  std::vector<Row> rows;
  for (const std::size_t size : asked.sizes) {
    const PsiTable table(size);
    for (const auto& [look_up, name] : look_ups) {
      double color_max = 0;
      double color_l1 = 0;
      double opacity_max = 0;
      double radius = 0;
      for (const auto& [front, back, truth] : slabs) {
        const auto slab =
            partially_pre_integrated_slab(front, back, 1, table(front.extinction, back.extinction, look_up));
        const Vector3<double> error = (slab.head<3>() - truth.color).abs();
        color_max = std::max(color_max, error.maxCoeff());
        color_l1 += error.mean();
        opacity_max = std::max(opacity_max, std::abs(slab[3] - truth.opacity));
        radius = std::max(radius, truth.radius);
      }
      rows.push_back({{"size", static_cast<std::int64_t>(size)},
                      {"look_up", name},
                      {"slabs", static_cast<std::int64_t>(slabs.size())},
                      {"bytes", static_cast<std::int64_t>(sizeof(float) * size * size)},
                      {"error_max", color_max},
                      {"error_l1", color_l1 / static_cast<double>(slabs.size())},
                      {"opacity_max", opacity_max},
                      {"radius", radius}});
    }
  }
  return rows;
}

}  // namespace raytruth
