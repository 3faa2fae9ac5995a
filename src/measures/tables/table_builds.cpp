#include "experiments/measure.hpp"
#include "measures/tables/table_difference.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/statistics/order.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/subrange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth {

namespace {

constexpr std::size_t largest_compared = 1024;  // brute force takes minutes beyond

/// Builders of the plain table, colour and opacity of a slab.
constexpr std::array compared{"brute_force",
                              "subrange",
                              "subrange_inclusive",
                              "subrange_means",
                              "exact",
                              "no_attenuation",
                              "dissertation_text",
                              "dissertation_pseudo_code",
                              "dissertation_linear",
                              "dissertation_logarithmic"};

struct Options {
  TableStudy study;                        ///< its sizes are those of tables that are built
  std::vector<std::size_t> counted_sizes;  ///< those whose cost is stated
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "counted_sizes", "sizes", "shapes", "optical_depths"});
  Options options{.study = read_table_study(json, largest_compared), .counted_sizes = {}};
  for (const JsonReader& size : json.at("counted_sizes").items(2))
    options.counted_sizes.push_back(
        static_cast<std::size_t>(size.integer(2, static_cast<std::int64_t>(largest_table_size))));
  return options;
}

const TableBuilder& builder(std::string_view name) {
  const auto& list = catalogue::table_builders();
  return *std::find_if(list.begin(), list.end(), [name](const TableBuilder& entry) { return entry.name == name; });
}

/// What a build of one size takes.
struct BuildCost {
  std::size_t size = 0;
  TableCost cost;
};

/// How that grows with the size.
struct CostOrders {
  std::optional<double> composites;  ///< none where at most one size takes any
  double exponentials = 0;
};

/// How far a table is from two others.
struct BuildDifference {
  TableKeys keys;
  TableDifference to_brute_force;
  TableDifference to_exact;
};

struct Record {
  const char* builder;
  std::variant<BuildCost, CostOrders, BuildDifference> found;
};

/// Gives the part of a record that is of this type, if it is.
template <class Part>
const Part* part_of(const Record& record) {
  return std::get_if<Part>(&record.found);
}

void add_costs(const Options& options, std::vector<Record>& records) {
  for (const char* const name : compared) {
    const auto cost = builder(name).cost;
    if (cost == nullptr) continue;
    std::vector<StepError> composites;
    std::vector<StepError> exponentials;
    for (const std::size_t size : options.counted_sizes) {
      const TableCost here = cost(static_cast<std::int64_t>(size));
      const auto n = static_cast<double>(size);
      if (here.composites > 0) composites.push_back({n, static_cast<double>(here.composites)});
      exponentials.push_back({n, static_cast<double>(here.exponentials)});
      records.push_back({name, BuildCost{size, here}});
    }
    CostOrders orders{.composites = std::nullopt, .exponentials = fit_order(exponentials).order};
    if (composites.size() >= 2) orders.composites = fit_order(composites).order;
    records.push_back({name, orders});
  }
}

void add_differences(const Experiment& experiment, const Options& options, std::vector<Record>& records) {
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      for (const std::size_t size : options.study.sizes) {
        const TableAxes axes = TableStudy::axes(size);
        const auto brute = builder("brute_force").make(transfer, axes, experiment.emission);
        const auto exact = exact_table(transfer, axes, experiment.emission);
        for (const char* const name : compared) {
          const auto table = builder(name).make(transfer, axes, experiment.emission);
          records.push_back({name, BuildDifference{.keys = {shape, depth, size},
                                                   .to_brute_force = largest_difference(table, brute),
                                                   .to_exact = largest_difference(table, exact)}});
        }
      }
    }
}

/// The composites of a build over those of another builder.
double composites_over(const BuildCost& build, TableCost (*other)(std::int64_t size)) {
  return static_cast<double>(build.cost.composites) /
         static_cast<double>(other(static_cast<std::int64_t>(build.size)).composites);
}

Columns<BuildCost> cost_columns() {
  return {
      written_here<BuildCost>("size", &BuildCost::size),
      {.name = "composites",
       .description = "products of two slabs, in closed form",
       .cell = [](const BuildCost& build) { return build.cost.composites; }},
      {.name = "exponentials",
       .description = "opacity corrections, in closed form",
       .cell = [](const BuildCost& build) { return build.cost.exponentials; }},
      {.name = "composites_over_brute_force",
       .description = "as a share of those of brute_force",
       .cell = [](const BuildCost& build) { return composites_over(build, brute_force_cost); }},
      {.name = "composites_over_subrange",
       .description = "as a multiple of those of subrange",
       .cell = [](const BuildCost& build) { return composites_over(build, subrange_cost); }},
  };
}

Columns<CostOrders> order_columns() {
  return {
      {.name = "order_composites",
       .description = "slope of log composites over log n, least squares",
       .cell = &CostOrders::composites},
      {.name = "order_exponentials",
       .description = "slope of log exponentials over log n",
       .cell = &CostOrders::exponentials},
  };
}

Columns<BuildDifference> difference_columns() {
  Columns<BuildDifference> columns;
  const auto add = [&columns](const std::string& to, TableDifference BuildDifference::*difference) {
    const auto column = [&](const char* what, const char* over, double (*cell)(const TableDifference&)) {
      return RecordColumn<BuildDifference>{
          .name = fmt::format("{}_to_{}", what, to),
          .description = fmt::format("largest difference to {} over all entries, {}", to, over),
          .cell = [difference, cell](const BuildDifference& build) { return cell(build.*difference); }};
    };
    append(columns, {column("color", "color", [](const TableDifference& found) { return found.color; }),
                     column("opacity", "opacity", [](const TableDifference& found) { return found.opacity; }),
                     column("largest", "colour and opacity",
                            [](const TableDifference& found) { return std::max(found.color, found.opacity); })});
  };
  add("brute_force", &BuildDifference::to_brute_force);
  add("exact", &BuildDifference::to_exact);
  return columns;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "part",
       .description = "cost: what a build takes; fit: exponents over all sizes; difference: to other tables",
       .is_key = true,
       .cell =
           [](const Record& record) {
             constexpr std::array parts{"cost", "fit", "difference"};
             return parts[record.found.index()];
           }},
      {.name = "builder", .description = "as in `raytruth list tables`", .is_key = true, .cell = &Record::builder}};
  append_part(
      columns,
      [](const Record& record) {
        const auto* const difference = part_of<BuildDifference>(record);
        return difference != nullptr ? &difference->keys : nullptr;
      },
      table_key_columns());
  append_part(columns, part_of<BuildCost>, cost_columns());
  append_part(columns, part_of<CostOrders>, order_columns());
  append_part(columns, part_of<BuildDifference>, difference_columns());
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  add_costs(options, records);
  add_differences(experiment, options, records);
  return records;
}

}  // namespace

extern const Measure table_builds_measure;
const Measure table_builds_measure{MeasureDefinition<Options, Record>{
    .name = "table_builds",
    .summary = "composites and exponentials of table builders, and their differences to exact tables",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
