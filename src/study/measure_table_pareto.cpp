#include "catalogue.hpp"
#include "measures/pareto.hpp"
#include "study/measure.hpp"
#include "study/table_study.hpp"

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

Options read_options(const JsonReader& json) {
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

void add_candidate(Row& row, const Candidate& candidate) {
  const TableCost cost =
      candidate.builder->cost ? candidate.builder->cost(static_cast<std::int64_t>(candidate.size)) : TableCost{};
  const auto counted = [&candidate](std::int64_t count) { return candidate.builder->cost ? Value(count) : Value(); };
  row.insert(row.end(), {{"builder", candidate.builder->name},
                         {"size", static_cast<std::int64_t>(candidate.size)},
                         {"format", std::string(candidate.format.name)},
                         {"bytes", candidate.bytes()},
                         {"composites", counted(cost.composites)},
                         {"exponentials", counted(cost.exponentials)},
                         {"error_max", candidate.error.max},
                         {"error_l1", candidate.error.mean},
                         {"radius", candidate.radius}});
}

/// Of the candidates that reach the target the one of the fewest bytes; of several the one of the least error.
const Candidate* smallest(const std::vector<Candidate>& candidates, double target) {
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates)
    if (candidate.error.max + candidate.radius <= target &&
        (best == nullptr || candidate.bytes() < best->bytes() ||
         (candidate.bytes() == best->bytes() && candidate.error.max < best->error.max)))
      best = &candidate;
  return best;
}

}  // namespace

std::vector<Column> table_pareto_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "shape", .unit = "", .description = "transfer function", .is_key = true},
      {.name = "optical_depth",
       .unit = "",
       .description = "of a slab that meets the largest extinction all along",
       .is_key = true},
      {.name = "part",
       .unit = "",
       .description = "point: a table; smallest: the one of the fewest bytes that reaches the target",
       .is_key = true},
      {.name = "target", .unit = "", .description = "largest error allowed; null: of a point", .is_key = true},
      {.name = "builder", .unit = "", .description = "of the table", .is_key = true},
      {.name = "size", .unit = "", .description = "n, entries along each axis", .is_key = true},
      {.name = "format", .unit = "", .description = "of the table's numbers", .is_key = true},
      {.name = "bytes", .unit = "byte", .description = "of the table, RGBA"},
      {.name = "composites", .unit = "", .description = "products of two slabs that building it takes"},
      {.name = "exponentials",
       .unit = "",
       .description = "that building it takes; null where it depends on the transfer function"},
      {.name = "error_max",
       .unit = "",
       .description = "largest error of bilinear look-ups against certified slabs, all channels",
       .is_key = false,
       .radius = "radius"},
      {.name = "error_l1", .unit = "", .description = "mean magnitude of it", .is_key = false, .radius = "radius"},
      {.name = "radius", .unit = "", .description = "bound on the error of the errors: the reference's"},
      {.name = "is_front", .unit = "", .description = "whether no other table is both smaller and closer"},
      {.name = "is_reached", .unit = "", .description = "1: a table reaches the target; 0: none does"},
  };
}

std::vector<Row> table_pareto_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  for (const std::string& shape : asked.study.shapes)
    for (const double depth : asked.study.optical_depths) {
      const auto candidates =
          candidates_of(asked, TableStudy::transfer(shape, depth, experiment.seed), experiment.seed);
      std::vector<CostError> points;
      for (const Candidate& candidate : candidates)
        points.push_back({static_cast<double>(candidate.bytes()), candidate.error.max});
      const std::vector<bool> is_front = pareto_front(points);
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        Row& row = rows.emplace_back(Row{{"shape", shape}, {"optical_depth", depth}, {"part", "point"}});
        add_candidate(row, candidates[i]);
        row.emplace_back("is_front", bool(is_front[i]));
      }
      for (const double target : asked.targets) {
        const Candidate* const best = smallest(candidates, target);
        Row& row = rows.emplace_back(
            Row{{"shape", shape}, {"optical_depth", depth}, {"part", "smallest"}, {"target", target}});
        if (best != nullptr) add_candidate(row, *best);
        row.emplace_back("is_reached", std::int64_t{best != nullptr});
        if (best == nullptr) row.emplace_back("why", "no table of these sizes and formats reaches it");
      }
    }
  return rows;
}

}  // namespace raytruth
