#include "experiments/measure.hpp"
#include "raytruth/skipping/overshoot.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

// Lee 2010, eq. 8: an eighth of the range.
constexpr double printed_overshoot = 0.125;

struct Options {
  std::int64_t rays = 0;
  std::vector<double> steps;
  std::vector<std::int64_t> block_sizes;
  std::vector<double> block_ranges;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
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

/// A block of voxels that rays pass through, and how many virtual samples they have in it.
struct Block {
  std::string_view region;
  std::int64_t size = 0;
  std::int64_t virtual_samples = 0;
};

/// What reaches the samples in a block from beyond it, grown by so many voxels.
struct Growth {
  std::int64_t growth = 0;
  std::int64_t violations = 0;
  double leak = 0;
};

struct SafeGrowth {
  std::optional<std::int64_t> found;  ///< none: each of those searched has violations
  std::int64_t proven = 0;
  double leak_at_proven = 0;
  double leak_one_below_proven = 0;
};

/// The range of a block over that of all data, and how far samples leave it: in data ranges.
struct Excess {
  double block_range = 0;
  double overshoot = 0;
  std::optional<double> of_true_samples;  ///< none: samples alone, whatever they are made from
};

struct Record {
  std::string part;
  std::string data;
  std::string curve;
  std::optional<double> step = {};        ///< none: any
  std::optional<std::int64_t> rays = {};  ///< none: proved, not searched
  std::optional<Excess> excess = {};
  std::optional<Block> block = {};
  std::optional<Growth> growth = {};
  std::optional<SafeGrowth> safe_growth = {};
};

/// Samples alone, whatever they are made from. In units of the data's range the block holds [1 - block_range, 1].
void add_samples(std::vector<Record>& records, const Options& options) {
  const std::pair<double, double> unit{0, 1};
  const auto add = [&records](const char* part, const std::string& data, double block_range, double overshoot) {
    records.push_back({.part = part, .data = data, .curve = "any step", .excess = Excess{block_range, overshoot, {}}});
  };
  add("samples", "four samples in the block", 1, largest_virtual_sample(unit, unit) - 1);
  add("samples", "first interval, with ghost", 1, largest_first_virtual_sample(unit) - 1);
  for (const double range : options.block_ranges)
    add("neighbours", fmt::format("outer samples beyond, range {:.4g}", range), range,
        largest_virtual_sample({1 - range, 1}, unit) - 1);
}

/// Samples of a tricubic reconstruction, all their data in the block.
void add_reconstructions(std::vector<Record>& records, const Options& options, std::uint64_t seed) {
  for (const auto& [weights, data] : {std::pair{SampleWeights::bspline, "B-spline over its data"},
                                      {SampleWeights::cardinal, "prefiltered over voxels"},
                                      {SampleWeights::catmull_rom, "Catmull-Rom over voxels"}})
    for (const double step : options.steps) {
      const Overshoot found = search_overshoot(weights, step, options.rays, seed);
      records.push_back({.part = "reconstruction",
                         .data = data,
                         .curve = fmt::format("step {}", step),
                         .step = step,
                         .rays = options.rays,
                         .excess = Excess{1, found.of_virtual_samples, found.of_true_samples}});
    }
}

SafeGrowth safe_growth_of(const BlockLeak& found, std::int64_t proven) {
  std::size_t safe = 0;
  while (safe < growths && found.leaking[safe] > 0) ++safe;
  return {.found = safe < growths ? std::optional(static_cast<std::int64_t>(safe)) : std::nullopt,
          .proven = proven,
          .leak_at_proven = found.leak[static_cast<std::size_t>(proven)],
          .leak_one_below_proven = found.leak[static_cast<std::size_t>(proven - 1)]};
}

/// B-spline samples of rays through a block, voxels beyond it being free.
void add_growths(std::vector<Record>& records, const Options& options, std::uint64_t seed) {
  for (const auto& [region, name] : {std::pair{BlockRegion::cells, "cells"}, {BlockRegion::voxels, "voxels"}})
    for (const double step : options.steps)
      for (const std::int64_t size : options.block_sizes) {
        const BlockLeak found = search_block(region, size, step, options.rays, seed);
        const auto add = [&, name = name](const char* part) -> Record& {
          return records.emplace_back(Record{.part = part,
                                             .data = "B-spline of rays through a block",
                                             .curve = fmt::format("step {}, block of {}", step, name),
                                             .step = step,
                                             .rays = options.rays,
                                             .block = Block{name, size, found.samples}});
        };
        add("safe growth").safe_growth = safe_growth_of(found, proven_growth(region, step));
        for (std::size_t growth = 0; growth < growths; ++growth)
          add("growth").growth = {static_cast<std::int64_t>(growth), found.leaking[growth],
                                  found.leaking[growth] > 0 ? found.leak[growth] : 0.0};
      }
}

Columns<Block> block_key_columns() {
  return {
      {.name = "region",
       .description = "of a block: cells, from its first voxel to its last; voxels, half a voxel more on every side",
       .is_key = true,
       .cell = &Block::region},
      {.name = "block_size",
       .unit = "voxel",
       .description = "voxels of a block on each axis",
       .is_key = true,
       .cell = &Block::size}};
}

Columns<Excess> excess_columns() {
  return {
      {.name = "overshoot",
       .unit = "M - m",
       .description = "largest sample found, true or virtual, over M",
       .cell =
           [](const Excess& excess) {
             return excess.block_range > 0 ? std::optional(excess.overshoot / excess.block_range) : std::nullopt;
           }},
      {.name = "overshoot_why",
       .description = "why there is none",
       .cell =
           [](const Excess& excess) {
             return cell_if(!excess.of_true_samples,
                            excess.block_range > 0 ? Value() : Value("the block is constant, so that its bound is 0"));
           }},
      {.name = "overshoot_of_true_samples",
       .unit = "M - m",
       .description = "largest true sample found, over M",
       .cell =
           [](const Excess& excess) { return cell_if(excess.of_true_samples.has_value(), excess.of_true_samples); }},
      {.name = "overshoot_in_data_ranges",
       .unit = "data range",
       .description = "the overshoot before division by M - m",
       .cell = &Excess::overshoot},
      {.name = "printed_overshoot",
       .unit = "M - m",
       .description = "the published bound",
       .cell = [](const Excess& excess) { return cell_if(!excess.of_true_samples, printed_overshoot); }},
  };
}

Columns<SafeGrowth> safe_growth_columns() {
  return {
      {.name = "growth_found",
       .unit = "voxel",
       .description = "smallest growth without violations",
       .cell = &SafeGrowth::found},
      {.name = "growth_proven",
       .unit = "voxel",
       .description = "ceil(2h) + 1 for cells, ceil(2h + 1/2) + 1 for voxels, at step h",
       .cell = &SafeGrowth::proven},
      {.name = "leak_at_proven",
       .description = "largest leak found at the proven growth",
       .cell = &SafeGrowth::leak_at_proven},
      {.name = "leak_one_below_proven",
       .description = "and at one voxel less",
       .cell = &SafeGrowth::leak_one_below_proven},
  };
}

Columns<Growth> growth_columns() {
  return {
      written_here<Growth>("growth", &Growth::growth),
      {.name = "violations",
       .description = "virtual samples on which voxels beyond the grown block have weights of more than 1e-12",
       .cell = &Growth::violations},
      {.name = "leak",
       .description = "largest sum of such weights: the overshoot of a block of one value, whose bound is 0, where the "
                      "voxels beyond it are 1 away",
       .cell = &Growth::leak},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "part",
       .description =
           "samples: all in the block; neighbours: not all; reconstruction: of data all in the block; growth: "
           "what reaches a block, grown, from beyond it; safe growth: what that comes to",
       .is_key = true,
       .cell = &Record::part},
      {.name = "data",
       .description =
           "what the block's range [m, M] is over: samples, or what the true samples are made from, voxels or "
           "the coefficients of the prefiltered spline",
       .is_key = true,
       .cell = &Record::data},
      {.name = "curve", .description = "step and region in words", .cell = &Record::curve},
      {.name = "step",
       .unit = "voxel",
       .description = "distance of true samples",
       .is_key = true,
       .cell = [](const Record& record) { return cell_if(record.step.has_value(), record.step); }},
  };
  append_part(columns, &Record::block, block_key_columns());
  columns.push_back({.name = "growth",
                     .unit = "voxel",
                     .description = "by which the block is grown on every side before its range is taken",
                     .is_key = true});
  append_part(columns, &Record::excess,
              Columns<Excess>{{.name = "block_range",
                               .unit = "data range",
                               .description = "M - m, with M the largest of all data",
                               .cell = &Excess::block_range}});
  columns.push_back({.name = "rays", .description = "searched", .cell = [](const Record& record) {
                       return cell_if(record.rays.has_value(), record.rays);
                     }});
  append_part(columns, &Record::block,
              Columns<Block>{{.name = "virtual_samples",
                              .description = "of these rays in the block, 16 from one true sample to the next",
                              .cell = &Block::virtual_samples}});
  append_part(columns, &Record::excess, excess_columns());
  append_part(columns, &Record::growth, growth_columns());
  append_part(columns, &Record::safe_growth, safe_growth_columns());
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  add_samples(records, options);
  add_reconstructions(records, options, experiment.seed);
  add_growths(records, options, experiment.seed);
  return records;
}

}  // namespace

extern const Measure minmax_bounds_measure;
const Measure minmax_bounds_measure{MeasureDefinition<Options, Record>{
    .name = "minmax_bounds",
    .summary = "how far virtual samples leave the range of their data and of the block they lie in",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
