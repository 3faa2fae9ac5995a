#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/statistics/order.hpp"
#include "raytruth/tables/brute_force.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/subrange.hpp"
#include "raytruth/tables/table_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

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

Options read_options(const JsonReader& json) {
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

void add_costs(const Options& asked, std::vector<Row>& rows) {
  for (const char* const name : compared) {
    const auto cost = builder(name).cost;
    if (cost == nullptr) continue;
    std::vector<StepError> composites;
    std::vector<StepError> exponentials;
    for (const std::size_t size : asked.counted_sizes) {
      const auto count = static_cast<std::int64_t>(size);
      const TableCost here = cost(count);
      const auto n = static_cast<double>(size);
      const auto as_double = [](std::int64_t x) { return static_cast<double>(x); };
      if (here.composites > 0) composites.push_back({n, as_double(here.composites)});
      exponentials.push_back({n, as_double(here.exponentials)});
      rows.push_back(
          {{"part", "cost"},
           {"builder", name},
           {"size", count},
           {"composites", here.composites},
           {"exponentials", here.exponentials},
           {"composites_over_brute_force", as_double(here.composites) / as_double(brute_force_cost(count).composites)},
           {"composites_over_subrange", as_double(here.composites) / as_double(subrange_cost(count).composites)}});
    }
    const bool has_composites = composites.size() >= 2;
    rows.push_back({{"part", "fit"},
                    {"builder", name},
                    {"order_composites", has_composites ? Value(fit_order(composites).order) : Value()},
                    {"order_exponentials", fit_order(exponentials).order}});
  }
}

void add_differences(const Experiment& experiment, const Options& asked, std::vector<Row>& rows) {
  for (const std::string& shape : asked.study.shapes)
    for (const double depth : asked.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      for (const std::size_t size : asked.study.sizes) {
        const TableAxes axes = TableStudy::axes(size);
        const auto brute = builder("brute_force").make(transfer, axes, experiment.emission);
        const auto exact = exact_table(transfer, axes, experiment.emission);
        for (const char* const name : compared) {
          const auto table = builder(name).make(transfer, axes, experiment.emission);
          const TableDifference to_brute = largest_difference(table, brute);
          const TableDifference to_exact = largest_difference(table, exact);
          Row& row = rows.emplace_back(Row{{"part", "difference"}, {"builder", name}});
          const Row keys = table_keys(shape, depth, size);
          row.insert(row.end(), keys.begin(), keys.end());
          row.insert(row.end(), {{"color_to_brute_force", to_brute.color},
                                 {"opacity_to_brute_force", to_brute.opacity},
                                 {"largest_to_brute_force", std::max(to_brute.color, to_brute.opacity)},
                                 {"color_to_exact", to_exact.color},
                                 {"opacity_to_exact", to_exact.opacity},
                                 {"largest_to_exact", std::max(to_exact.color, to_exact.opacity)}});
        }
      }
    }
}

}  // namespace

std::vector<Column> table_builds_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns{
      {.name = "part",
       .unit = "",
       .description = "cost: what a build takes; fit: exponents over all sizes; difference: to other tables",
       .is_key = true},
      {.name = "builder", .unit = "", .description = "as in `raytruth list tables`", .is_key = true}};
  append(columns, table_key_columns());
  columns.insert(
      columns.end(),
      {{.name = "composites", .unit = "", .description = "products of two slabs, in closed form"},
       {.name = "exponentials", .unit = "", .description = "opacity corrections, in closed form"},
       {.name = "composites_over_brute_force", .unit = "", .description = "as a share of those of brute_force"},
       {.name = "composites_over_subrange", .unit = "", .description = "as a multiple of those of subrange"},
       {.name = "order_composites", .unit = "", .description = "slope of log composites over log n, least squares"},
       {.name = "order_exponentials", .unit = "", .description = "slope of log exponentials over log n"}});
  for (const std::string to : {"brute_force", "exact"})
    for (const std::string what : {"color", "opacity", "largest"})
      columns.push_back({.name = what + "_to_" + to,
                         .unit = "",
                         .description = fmt::format("largest difference to {} over all entries, {}", to,
                                                    what == "largest" ? "colour and opacity" : what)});
  return columns;
}

std::vector<Row> table_builds_rows(const Experiment& experiment, const JsonReader& options, const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  add_costs(asked, rows);
  add_differences(experiment, asked, rows);
  return rows;
}

}  // namespace raytruth
