#include "experiments/measure.hpp"
#include "measures/quantile_columns.hpp"
#include "raytruth/reference/arb_integral.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/reference/integral_cases.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>

namespace raytruth {

namespace {

struct Options {
  std::int64_t pieces = 0;
  std::int64_t rays = 0;
  std::int64_t blocks = 0;
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "pieces", "rays", "blocks"});
  constexpr std::int64_t most = 1'000'000'000;
  constexpr std::int64_t most_blocks = 10'000;
  return {.pieces = json.at("pieces").integer(1, most),
          .rays = json.at("rays").integer(1, most),
          .blocks = json.at("blocks").integer(1, most_blocks)};
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

Row summary(std::int64_t block, std::string_view kind, Emission emission, const std::vector<Comparison>& all) {
  std::vector<double> radii;
  std::int64_t violations = 0;
  std::int64_t not_converged = 0;
  double difference = 0;
  double arb_radius = 0;
  for (const Comparison& one : all) {
    radii.push_back(one.reference.radius);
    violations += one.difference <= 1 ? 0 : 1;
    not_converged += one.reference.status == Status::not_converged ? 1 : 0;
    difference = std::max(difference, one.difference);
    arb_radius = std::max(arb_radius, one.arb_radius);
  }
  std::sort(radii.begin(), radii.end());
  Row row{{"block", block},
          {"signal", std::string(kind)},
          {"emission", emission == Emission::associated ? "associated" : "plain"},
          {"cases", static_cast<std::int64_t>(all.size())},
          {"violations", violations},
          {"difference_max", difference},
          {"not_converged", not_converged}};
  add_quantiles(row, "radius", radii);
  row.emplace_back("radius_max", radii.back());
  row.emplace_back("arb_radius_max", arb_radius);
  return row;
}

/// One row for each emission, of cases first ... last - 1.
void add_rows(std::vector<Row>& rows, std::int64_t block, std::string_view kind, std::int64_t first, std::int64_t last,
              const std::function<IntegralCase(std::uint64_t)>& make) {
  if (first == last) return;
  for (const Emission emission : {Emission::associated, Emission::plain}) {
    std::vector<Comparison> all(static_cast<std::size_t>(last - first));
    tbb::parallel_for(first, last, [&](std::int64_t index) {
      all[static_cast<std::size_t>(index - first)] = compare(make(static_cast<std::uint64_t>(index)), emission);
    });
    rows.push_back(summary(block, kind, emission, all));
  }
}

}  // namespace

std::vector<Column> reference_proof_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns{
      {.name = "block", .unit = "", .description = "which part of the cases", .is_key = true},
      {.name = "signal",
       .unit = "",
       .description = "smooth_piece: one polynomial between two points of the transfer function, optical depth 1e-3 to "
                      "30; else rays of 1 to 10 pieces and what they do, optical depth to 1e5",
       .is_key = true},
      {.name = "emission", .unit = "", .description = "associated or plain", .is_key = true},
      {.name = "cases", .unit = "", .description = "integrated by the reference and by Arb"},
      {.name = "violations",
       .unit = "",
       .description = "cases in which a channel or the opacity of both differ by more than the sum of their radii"},
      {.name = "difference_max",
       .unit = "sum of radii",
       .description = "largest difference of a channel or of the opacity"},
      {.name = "not_converged", .unit = "", .description = "answers of the reference that say so"},
  };
  append(columns, quantile_columns("radius", "", "radius of the reference"));
  columns.push_back({.name = "radius_max", .unit = "", .description = "largest radius of the reference"});
  columns.push_back({.name = "arb_radius_max", .unit = "", .description = "largest radius of Arb"});
  return columns;
}

std::int64_t reference_proof_blocks(const JsonReader& options) { return read_options(options).blocks; }

std::vector<Row> reference_proof_rows(const Experiment& experiment, const JsonReader& options, std::int64_t block) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  const auto begin_of = [&](std::int64_t all, std::int64_t b) { return all * b / asked.blocks; };
  add_rows(rows, block, "smooth_piece", begin_of(asked.pieces, block), begin_of(asked.pieces, block + 1),
           [&](std::uint64_t index) { return smooth_piece(experiment.seed, index); });
  constexpr auto shapes = static_cast<std::int64_t>(signal_shapes.size());
  for (std::int64_t shape = 0; shape < shapes; ++shape) {
    const std::int64_t rays = asked.rays / shapes + (shape < asked.rays % shapes ? 1 : 0);
    add_rows(rows, block, signal_shapes[static_cast<std::size_t>(shape)], begin_of(rays, block),
             begin_of(rays, block + 1), [&](std::uint64_t index) {
               return random_case(static_cast<SignalShape>(shape),
                                  static_cast<TransferShape>(index % transfer_shapes.size()), experiment.seed, index);
             });
  }
  return rows;
}

}  // namespace raytruth
