#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/statistics/pareto.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace raytruth {

namespace {

struct Options {
  TableStudy study;
  std::size_t cells = 0;
  std::vector<TableFormat> formats;
  std::vector<const TableBuilder*> builders;
  std::vector<double> targets;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "sizes", "cells", "formats", "builders", "targets"});
  Options options{.study = read_table_study(json, largest_table_size),
                  .cells = read_cells(json),
                  .formats = read_formats(json),
                  .builders = {},
                  .targets = {}};
  const auto& builders = catalogue::table_builders();
  std::vector<std::string_view> names;
  for (const TableBuilder& builder : builders) names.push_back(builder.name);
  for (const JsonReader& item : json.at("builders").items()) {
    const std::string name = item.word(names);
    options.builders.push_back(&*std::find_if(builders.begin(), builders.end(),
                                              [&name](const TableBuilder& builder) { return builder.name == name; }));
  }
  for (const JsonReader& target : json.at("targets").items()) options.targets.push_back(target.positive_number());
  return options;
}

/// A table that a renderer could use.
struct Candidate {
  const TableBuilder* builder;
  std::size_t size;
  TableFormat format;
  TableError error;
  double radius;

  [[nodiscard]] std::int64_t bytes() const { return bytes_of(size * size, format); }
};

std::vector<Candidate> candidates_of(const Options& options, const PiecewiseLinear& transfer, std::uint64_t seed) {
  std::vector<Candidate> candidates;
  for (const std::size_t size : options.study.sizes) {
    const TableAxes axes = TableStudy::axes(size);
    const CertifiedCells truth = certified_cells(transfer, axes, Emission::associated, options.cells, seed);
    for (const TableBuilder* const builder : options.builders) {
      const Table<double> table = builder->make(transfer, axes, Emission::associated);
      const auto entry = [&table](const CertifiedCell& /*cell*/, std::size_t front, std::size_t back) {
        return table.at(front, back);
      };
      for (const TableFormat& format : options.formats)
        candidates.push_back({builder, size, format, bilinear_error(truth, entry, format), truth.radius});
    }
  }
  return candidates;
}

/// A table, or the smallest one that reaches a target.
struct Record {
  std::string shape;
  double optical_depth;
  std::optional<double> target;  ///< none: of a point
  std::optional<Candidate> table;
  bool is_front = false;  ///< of a point

  [[nodiscard]] bool is_point() const { return !target.has_value(); }
};

/// The candidate of the fewest bytes among those that reach the target; of several the one of the least error.
const Candidate* smallest(const std::vector<Candidate>& candidates, double target) {
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates)
    if (candidate.error.max + candidate.radius <= target &&
        (best == nullptr || candidate.bytes() < best->bytes() ||
         (candidate.bytes() == best->bytes() && candidate.error.max < best->error.max)))
      best = &candidate;
  return best;
}

/// What building the table takes; none where that depends on the transfer function.
std::optional<TableCost> cost_of(const Candidate& candidate) {
  if (candidate.builder->cost == nullptr) return std::nullopt;
  return candidate.builder->cost(static_cast<std::int64_t>(candidate.size));
}

Columns<Candidate> candidate_columns() {
  return {
      {.name = "builder",
       .description = "of the table",
       .is_key = true,
       .cell = [](const Candidate& table) { return table.builder->name; }},
      {.name = "size", .description = "n, entries along each axis", .is_key = true, .cell = &Candidate::size},
      {.name = "format",
       .description = "of the table's numbers",
       .is_key = true,
       .cell = [](const Candidate& table) { return table.format.name; }},
      {.name = "bytes", .unit = "byte", .description = "of the table, RGBA", .cell = &Candidate::bytes},
      {.name = "composites",
       .description = "products of two slabs that building it takes",
       .cell =
           [](const Candidate& table) {
             const auto cost = cost_of(table);
             return cost ? std::optional(cost->composites) : std::nullopt;
           }},
      {.name = "exponentials",
       .description = "that building it takes; null where it depends on the transfer function",
       .cell =
           [](const Candidate& table) {
             const auto cost = cost_of(table);
             return cost ? std::optional(cost->exponentials) : std::nullopt;
           }},
      {.name = "error_max",
       .description = "largest error of bilinear look-ups against certified slabs, all channels",
       .radius = "radius",
       .cell = [](const Candidate& table) { return table.error.max; }},
      {.name = "error_l1",
       .description = "mean magnitude of it",
       .radius = "radius",
       .cell = [](const Candidate& table) { return table.error.mean; }},
      {.name = "radius",
       .description = "bound on the error of the errors: the reference's",
       .cell = &Candidate::radius},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "shape", .description = "transfer function", .is_key = true, .cell = &Record::shape},
      {.name = "optical_depth",
       .description = "of a slab that meets the largest extinction all along",
       .is_key = true,
       .cell = &Record::optical_depth},
      {.name = "part",
       .description = "point: a table; smallest: the one of the fewest bytes that reaches the target",
       .is_key = true,
       .cell = [](const Record& record) { return record.is_point() ? "point" : "smallest"; }},
      {.name = "target",
       .description = "largest error allowed; null: of a point",
       .is_key = true,
       .cell = [](const Record& record) { return cell_if(!record.is_point(), record.target); }},
  };
  append_part(columns, &Record::table, candidate_columns());
  columns.push_back({.name = "is_front",
                     .description = "whether no other table is both smaller and closer",
                     .cell = [](const Record& record) { return cell_if(record.is_point(), record.is_front); }});
  columns.push_back({.name = "is_reached",
                     .description = "1: a table reaches the target; 0: none does",
                     .cell = [](const Record& record) {
                       return cell_if(!record.is_point(), std::int64_t{record.table.has_value()});
                     }});
  columns.push_back(written_here<Record>("why", [](const Record& record) {
    return cell_if(!record.is_point() && !record.table, "no table of these sizes and formats reaches it");
  }));
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths) {
      const auto candidates =
          candidates_of(options, TableStudy::transfer(shape, depth, experiment.seed), experiment.seed);
      std::vector<CostError> points;
      for (const Candidate& candidate : candidates)
        points.push_back({static_cast<double>(candidate.bytes()), candidate.error.max});
      const std::vector<bool> is_front = pareto_front(points);
      for (std::size_t i = 0; i < candidates.size(); ++i)
        records.push_back({shape, depth, std::nullopt, candidates[i], is_front[i]});
      for (const double target : options.targets) {
        const Candidate* const best = smallest(candidates, target);
        records.push_back({shape, depth, target, best != nullptr ? std::optional(*best) : std::nullopt});
      }
    }
  return records;
}

}  // namespace

extern const Measure table_pareto_measure;
const Measure table_pareto_measure{MeasureDefinition<Options, Record>{
    .name = "table_pareto",
    .summary = "the smallest table that reaches an accuracy, of all builders, sizes and formats",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
