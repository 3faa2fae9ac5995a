#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/integral_cases.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

struct Options {
  std::int64_t pieces = 0;
  std::int64_t rays = 0;
  std::int64_t blocks = 0;
  bool is_linear_in_opacity = false;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "pieces", "rays", "blocks", "linear_in"});
  constexpr std::int64_t most = 1'000'000'000;
  constexpr std::int64_t most_blocks = 10'000;
  const auto linear_in = json.find("linear_in");
  return {.pieces = json.at("pieces").integer(0, most),
          .rays = json.at("rays").integer(1, most),
          .blocks = json.at("blocks").integer(1, most_blocks),
          .is_linear_in_opacity = linear_in && linear_in->word({"extinction", "opacity"}) == "opacity"};
}

/// What comes of one case.
struct Comparison {
  Certified reference;
  double arb_radius = 0;
  double difference = 0;
};

Comparison compare(const IntegralCase& asked, Emission emission) {
  return std::visit(
      [&](const auto& signal) {
        const Certified reference = RayIntegral(asked.transfer, emission)(signal);
        const Certified arb = arb_integral(signal, asked.transfer, emission);
        return Comparison{reference, arb.radius, difference_in_radii(reference, arb)};
      },
      asked.signal);
}

/// What all cases of a block, a kind of signal and an emission come to.
struct Record {
  std::int64_t block = 0;
  std::string_view signal;
  std::string_view transfer = {};
  Emission emission = Emission::associated;
  std::int64_t cases = 0;
  std::int64_t violations = 0;
  double difference_max = 0;
  std::int64_t not_converged = 0;
  ShownQuantiles radius = {};
  double radius_max = 0;
  double arb_radius_max = 0;
};

Record summary_of(Record record, const std::vector<Comparison>& all) {
  record.cases = static_cast<std::int64_t>(all.size());
  std::vector<double> radii;
  for (const Comparison& one : all) {
    radii.push_back(one.reference.radius);
    record.violations += one.difference <= 1 ? 0 : 1;
    record.not_converged += one.reference.status == Status::not_converged ? 1 : 0;
    record.difference_max = std::max(record.difference_max, one.difference);
    record.arb_radius_max = std::max(record.arb_radius_max, one.arb_radius);
  }
  std::sort(radii.begin(), radii.end());
  record.radius = shown_quantiles(radii);
  record.radius_max = radii.back();
  return record;
}

/// One for each emission, of cases first ... last - 1; `which` says of what.
void add_records(std::vector<Record>& records, Record which, std::int64_t first, std::int64_t last,
                 const std::function<IntegralCase(std::uint64_t)>& make) {
  if (first == last) return;
  for (const Emission emission : {Emission::associated, Emission::plain}) {
    std::vector<Comparison> all(static_cast<std::size_t>(last - first));
    tbb::parallel_for(first, last, [&](std::int64_t index) {
      all[static_cast<std::size_t>(index - first)] = compare(make(static_cast<std::uint64_t>(index)), emission);
    });
    which.emission = emission;
    records.push_back(summary_of(which, all));
  }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& options) {
  Columns<Record> columns{
      {.name = "block", .description = "which part of the cases", .is_key = true, .cell = &Record::block},
      {.name = "signal",
       .description = "smooth_piece: one polynomial between two points of the transfer function, optical depth 1e-3 to "
                      "30; else rays of 1 to 10 pieces and what they do, optical depth to 1e5",
       .is_key = true,
       .cell = &Record::signal},
      {.name = "emission",
       .description = "associated or plain",
       .is_key = true,
       .cell = [](const Record& record) { return emission_name(record.emission); }},
      {.name = "cases", .description = "integrated by the reference and by Arb", .cell = &Record::cases},
      {.name = "violations",
       .description = "cases in which a channel or the opacity of both differ by more than the sum of their radii",
       .cell = &Record::violations},
      {.name = "difference_max",
       .unit = "sum of radii",
       .description = "largest difference of a channel or of the opacity",
       .cell = &Record::difference_max},
      {.name = "not_converged", .description = "answers of the reference that say so", .cell = &Record::not_converged},
  };
  if (options.is_linear_in_opacity)
    columns.insert(
        columns.begin() + 2,
        {.name = "shape",
         .description = "the transfer function, linear in opacity: up to 0.99 as a ramp, random points, jumps "
                        "or a table of 257; contacts: opacity 1 at single scalars; opaque: 1 on a stretch",
         .is_key = true,
         .cell = &Record::transfer});
  append_part(columns, &Record::radius, shown_quantile_columns("radius", "", "radius of the reference"));
  append(columns,
         {{.name = "radius_max", .description = "largest radius of the reference", .cell = &Record::radius_max},
          {.name = "arb_radius_max", .description = "largest radius of Arb", .cell = &Record::arb_radius_max}});
  return columns;
}

std::int64_t blocks(const Options& options) { return options.blocks; }

std::vector<Record> records_of_block(const Experiment& experiment, const Options& options, std::int64_t block) {
  std::vector<Record> records;
  const auto begin_of = [&](std::int64_t all, std::int64_t b) { return all * b / options.blocks; };
  const auto make_piece = options.is_linear_in_opacity ? smooth_opacity_piece : smooth_piece;
  add_records(records,
              {.block = block,
               .signal = "smooth_piece",
               .transfer = options.is_linear_in_opacity ? opacity_shapes.front() : std::string_view()},
              begin_of(options.pieces, block), begin_of(options.pieces, block + 1),
              [&](std::uint64_t index) { return make_piece(experiment.seed, index); });
  constexpr auto shapes = static_cast<std::int64_t>(signal_shapes.size());
  for (std::int64_t shape = 0; shape < shapes; ++shape) {
    const auto signal = static_cast<SignalShape>(shape);
    Record which{.block = block, .signal = signal_shapes[static_cast<std::size_t>(shape)]};
    const std::int64_t rays = options.rays / shapes + (shape < options.rays % shapes ? 1 : 0);
    if (!options.is_linear_in_opacity) {
      add_records(records, which, begin_of(rays, block), begin_of(rays, block + 1), [&](std::uint64_t index) {
        return random_case(signal, static_cast<TransferShape>(index % transfer_shapes.size()), experiment.seed, index);
      });
      continue;
    }
    for (std::size_t transfer = 0; transfer < opacity_shapes.size(); ++transfer) {
      which.transfer = opacity_shapes[transfer];
      const std::int64_t of_transfer = rays / static_cast<std::int64_t>(opacity_shapes.size());
      add_records(records, which, begin_of(of_transfer, block), begin_of(of_transfer, block + 1),
                  [&](std::uint64_t index) {
                    return random_opacity_case(signal, static_cast<OpacityShape>(transfer), experiment.seed, index);
                  });
    }
  }
  return records;
}

}  // namespace

extern const Measure reference_proof_measure;
const Measure reference_proof_measure{
    MeasureDefinition<Options, Record>{.name = "reference_proof",
                                       .summary = "the certified reference against Arb: not one violation of a radius",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_block = records_of_block,
                                       .blocks = blocks}};

}  // namespace raytruth
