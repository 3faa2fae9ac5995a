#include "experiments/measure.hpp"
#include "raytruth/skipping/overshoot.hpp"

#include <fmt/format.h>

namespace raytruth {

namespace {

struct Options {
  std::int64_t rays = 0;
  std::vector<double> steps;
  std::vector<std::int64_t> block_sizes;
  std::vector<double> block_ranges;
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "rays", "steps", "block_sizes", "block_ranges"});
  constexpr std::int64_t most_rays = 10'000'000;
  constexpr std::int64_t largest_block = 256;
  constexpr double smallest_step = 1.0 / 16;
  constexpr double largest_step = 3;  // for which a growth of `growths` - 1 is enough
  Options options{.rays = json.at("rays").integer(1, most_rays), .steps = {}, .block_sizes = {}, .block_ranges = {}};
  for (const JsonReader& step : json.at("steps").items())
    options.steps.push_back(step.number(smallest_step, largest_step));
  for (const JsonReader& size : json.at("block_sizes").items())
    options.block_sizes.push_back(size.integer(2, largest_block));
  for (const JsonReader& range : json.at("block_ranges").items()) options.block_ranges.push_back(range.number(0, 1));
  return options;
}

/// Samples alone, whatever they are made from. In units of the data's range the block holds [1 - block_range, 1].
void add_sample_rows(std::vector<Row>& rows, const Options& options) {
  const std::pair<double, double> unit{0, 1};
  const auto add = [&rows](const char* part, const std::string& data, double block_range, double overshoot) {
    rows.push_back(
        {{"part", part},
         {"data", data},
         {"curve", "any step"},
         {"block_range", block_range},
         {"overshoot", block_range > 0 ? Value(overshoot / block_range) : Value()},
         {"overshoot_why", block_range > 0 ? Value() : Value("the block is constant, so that its bound is 0")},
         {"overshoot_in_data_ranges", overshoot},
         {"printed_overshoot", 0.125}});
  };
  add("samples", "four samples in the block", 1, largest_virtual_sample(unit, unit) - 1);
  add("samples", "first interval, with ghost", 1, largest_first_virtual_sample(unit) - 1);
  for (const double range : options.block_ranges)
    add("neighbours", fmt::format("outer samples beyond, range {:.4g}", range), range,
        largest_virtual_sample({1 - range, 1}, unit) - 1);
}

/// Samples of a tricubic reconstruction, all their data in the block.
void add_reconstruction_rows(std::vector<Row>& rows, const Options& options, std::uint64_t seed) {
  for (const auto& [weights, data] : {std::pair{SampleWeights::bspline, "B-spline over its data"},
                                      {SampleWeights::cardinal, "prefiltered over voxels"},
                                      {SampleWeights::catmull_rom, "Catmull-Rom over voxels"}})
    for (const double step : options.steps) {
      const Overshoot found = search_overshoot(weights, step, options.rays, seed);
      rows.push_back({{"part", "reconstruction"},
                      {"data", data},
                      {"curve", fmt::format("step {}", step)},
                      {"step", step},
                      {"block_range", 1.0},
                      {"rays", options.rays},
                      {"overshoot", found.of_virtual_samples},
                      {"overshoot_of_true_samples", found.of_true_samples},
                      {"overshoot_in_data_ranges", found.of_virtual_samples}});
    }
}

/// B-spline samples of rays through a block, voxels beyond it being free.
void add_growth_rows(std::vector<Row>& rows, const Options& options, std::uint64_t seed) {
  for (const auto& [region, name] : {std::pair{BlockRegion::cells, "cells"}, {BlockRegion::voxels, "voxels"}})
    for (const double step : options.steps)
      for (const std::int64_t size : options.block_sizes) {
        const BlockLeak found = search_block(region, size, step, options.rays, seed);
        const auto keys = [&, name = name](const char* part) {
          return Row{{"part", part},
                     {"data", "B-spline of rays through a block"},
                     {"curve", fmt::format("step {}, block of {}", step, name)},
                     {"step", step},
                     {"region", name},
                     {"block_size", size},
                     {"rays", options.rays},
                     {"virtual_samples", found.samples}};
        };
        std::size_t safe = 0;
        while (safe < growths && found.leaking[safe] > 0) ++safe;
        const std::int64_t proven = proven_growth(region, step);
        Row summary = keys("safe growth");
        summary.emplace_back("growth_found", safe < growths ? Value(static_cast<std::int64_t>(safe)) : Value());
        summary.emplace_back("growth_proven", proven);
        summary.emplace_back("leak_at_proven", found.leak[static_cast<std::size_t>(proven)]);
        summary.emplace_back("leak_one_below_proven", found.leak[static_cast<std::size_t>(proven - 1)]);
        rows.push_back(std::move(summary));
        for (std::size_t growth = 0; growth < growths; ++growth) {
          Row row = keys("growth");
          row.emplace_back("growth", static_cast<std::int64_t>(growth));
          row.emplace_back("violations", found.leaking[growth]);
          row.emplace_back("leak", found.leaking[growth] > 0 ? found.leak[growth] : 0.0);
          rows.push_back(std::move(row));
        }
      }
}

}  // namespace

std::vector<Column> minmax_bounds_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "part",
       .unit = "",
       .description =
           "samples: all in the block; neighbours: not all; reconstruction: of data all in the block; growth: "
           "what reaches a block, grown, from beyond it; safe growth: what that comes to",
       .is_key = true},
      {.name = "data",
       .unit = "",
       .description =
           "what the block's range [m, M] is over: samples, or what the true samples are made from, voxels or "
           "the coefficients of the prefiltered spline",
       .is_key = true},
      {.name = "curve", .unit = "", .description = "step and region in words"},
      {.name = "step", .unit = "voxel", .description = "distance of true samples", .is_key = true},
      {.name = "region",
       .unit = "",
       .description = "of a block: cells, from its first voxel to its last; voxels, half a voxel more on every side",
       .is_key = true},
      {.name = "block_size", .unit = "voxel", .description = "voxels of a block on each axis", .is_key = true},
      {.name = "growth",
       .unit = "voxel",
       .description = "by which the block is grown on every side before its range is taken",
       .is_key = true},
      {.name = "block_range", .unit = "data range", .description = "M - m, with M the largest of all data"},
      {.name = "rays", .unit = "", .description = "searched"},
      {.name = "virtual_samples",
       .unit = "",
       .description = "of these rays in the block, 16 from one true sample to the next"},
      {.name = "overshoot", .unit = "M - m", .description = "largest sample found, true or virtual, over M"},
      {.name = "overshoot_why", .unit = "", .description = "why there is none"},
      {.name = "overshoot_of_true_samples", .unit = "M - m", .description = "largest true sample found, over M"},
      {.name = "overshoot_in_data_ranges",
       .unit = "data range",
       .description = "the overshoot before division by M - m"},
      {.name = "printed_overshoot", .unit = "M - m", .description = "the published bound"},
      {.name = "violations",
       .unit = "",
       .description = "virtual samples on which voxels beyond the grown block have weights of more than 1e-12"},
      {.name = "leak",
       .unit = "",
       .description = "largest sum of such weights: the overshoot of a block of one value, whose bound is 0, where the "
                      "voxels beyond it are 1 away"},
      {.name = "growth_found", .unit = "voxel", .description = "smallest growth without violations"},
      {.name = "growth_proven",
       .unit = "voxel",
       .description = "ceil(2h) + 1 for cells, ceil(2h + 1/2) + 1 for voxels, at step h"},
      {.name = "leak_at_proven", .unit = "", .description = "largest leak found at the proven growth"},
      {.name = "leak_one_below_proven", .unit = "", .description = "and at one voxel less"},
  };
}

std::vector<Row> minmax_bounds_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  add_sample_rows(rows, asked);
  add_reconstruction_rows(rows, asked, experiment.seed);
  add_growth_rows(rows, asked, experiment.seed);
  return rows;
}

}  // namespace raytruth
