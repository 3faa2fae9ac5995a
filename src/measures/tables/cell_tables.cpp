#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/cells/cell_table.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/ray_integral.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::int64_t most_look_ups = 1'000'000;
constexpr std::int64_t most_distances = 4096;
constexpr std::int64_t most_nodes = 60;  // of powers of two: below 2^-60 of the longest nothing is seen
constexpr double longest = std::numbers::sqrt3;
constexpr double frame_steps = 255;

struct Options {
  TableStudy study;
  std::vector<std::int64_t> distances;
  std::vector<std::int64_t> counted_sizes;
  std::size_t look_ups = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "sizes", "distances", "counted_sizes", "look_ups"});
  Options options{.study = read_table_study(json, 1024), .distances = {}, .counted_sizes = {}};
  for (const JsonReader& item : json.at("distances").items())
    options.distances.push_back(item.integer(2, most_distances));
  for (const JsonReader& item : json.at("counted_sizes").items())
    options.counted_sizes.push_back(item.integer(4, 4096));
  options.look_ups = static_cast<std::size_t>(json.at("look_ups").integer(1, most_look_ups));
  return options;
}

/// Look-ups in a table, or what a table takes to be built.
struct Record {
  std::string_view part;
  TableKeys keys;
  std::string_view axis = {};
  std::string_view entries = {};
  std::int64_t distances = 0;
  double opacity_max = 0;
  double color_max = 0;
  double mean = 0;
  double distance_max = 0;
  double radius = 0;
  std::size_t numbers = 0;
  std::string_view builder = {};
  TableCost cost = {};
  double order = 0;
};

/// A slab that is looked up, and its certified light.
struct Place {
  double front = 0;
  double back = 0;
  double length = 0;
  Vec4 truth;
};

Vec4 certified(RayIntegral& integrate, double front, double back, double length, double& radius) {
  Chain<3> chain;
  const double step = (back - front) / 3;
  chain.pieces = {{0.0, length, {{front, front + step, back - step, back}}}};
  chain.end = length;
  const Certified slab = integrate(chain);
  radius = std::max(radius, slab.radius);
  return {slab.color[0], slab.color[1], slab.color[2], slab.opacity};
}

std::vector<Place> places_of(const Experiment& experiment, const Options& options, const PiecewiseLinear& transfer,
                             double& radius) {
  RayIntegral integrate(transfer, Emission::associated);
  std::vector<Place> places(options.look_ups);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto random = random_numbers(experiment.seed, RandomStream::points, i);
    Place& place = places[i];
    place.front = random[0];
    place.back = random[1];
    place.length = longest * std::max(random[2], 0x1p-20);
    place.truth = certified(integrate, place.front, place.back, place.length, radius);
  }
  return places;
}

/// The largest error of looking D up alone: front and back stand at entries.
double distance_error(const CellTable& table, const PiecewiseLinear& transfer, const std::vector<Place>& places,
                      double& radius) {
  RayIntegral integrate(transfer, Emission::associated);
  const TableAxes& axes = table.slices.front().axes;
  const auto entry = [&axes](double scalar) {
    return axes.scalar(static_cast<std::size_t>(std::lround(scalar * static_cast<double>(axes.size - 1))));
  };
  double largest = 0;
  for (const Place& place : places) {
    const double front = entry(place.front);
    const double back = entry(place.back);
    const Vec4 truth = certified(integrate, front, back, place.length, radius);
    largest = std::max(largest, (look_up(table, front, back, place.length) - truth).abs().maxCoeff());
  }
  return largest;
}

void add_look_ups(const Experiment& experiment, const Options& options, std::vector<Record>& records) {
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      double radius = 0;
      const auto places = places_of(experiment, options, transfer, radius);
      for (const std::size_t size : options.study.sizes)
        for (std::size_t a = 0; a < cell_table_axis_names.size(); ++a)
          for (const std::int64_t count : options.distances)
            for (std::size_t e = 0; e < cell_table_entries_names.size(); ++e) {
              const auto axis = static_cast<CellTableAxis>(a);
              const auto entries = static_cast<CellTableEntries>(e);
              if (axis != CellTableAxis::uniform && (count > most_nodes || entries != CellTableEntries::exact))
                continue;
              if (axis == CellTableAxis::printed && count != options.distances.front()) continue;
              if (axis == CellTableAxis::slope && count < 3) continue;
              const auto distances = cell_table_distances(axis, static_cast<std::size_t>(count), longest);
              const CellTable table =
                  cell_table(transfer, TableStudy::axes(size), Emission::associated, axis, distances, entries);
              Record record{.part = "look_up", .keys = {shape, depth, size}, .axis = cell_table_axis_names[a]};
              record.entries = cell_table_entries_names[e];
              record.distances = std::ssize(distances);
              record.numbers = table.numbers();
              record.radius = radius;
              record.distance_max = distance_error(table, transfer, places, record.radius);
              for (const Place& place : places) {
                const Vec4 error = (look_up(table, place.front, place.back, place.length) - place.truth).abs();
                record.opacity_max = std::max(record.opacity_max, error[3]);
                record.color_max = std::max(record.color_max, error.head<3>().maxCoeff());
                record.mean += error.mean() / static_cast<double>(places.size());
              }
              records.push_back(record);
            }
    }
}

/// Tables of n scalars at either side and n distances.
void add_costs(const Options& options, std::vector<Record>& records) {
  struct Row {
    std::string_view name;
    TableCost (*cost)(std::int64_t, std::int64_t);
  };
  for (const Row& row : {Row{"brute_force", brute_force_cell_table_cost}, Row{"subrange", subrange_cell_table_cost}})
    for (const std::int64_t size : options.counted_sizes)
      for (const bool is_half : {false, true}) {
        // Half the scalars and half the distances, or the same scalars and half the distances.
        const std::int64_t distances = size;
        Record record{.part = is_half ? "cost_of_distances" : "cost", .keys = {"", 0, static_cast<std::size_t>(size)}};
        record.distances = distances;
        record.builder = row.name;
        record.cost = row.cost(size, distances);
        const TableCost smaller = row.cost(is_half ? size : size / 2, distances / 2);
        record.order = std::log2(static_cast<double>(record.cost.composites) / static_cast<double>(smaller.composites));
        records.push_back(record);
      }
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  const auto of_look_up = [](auto value) {
    return [value](const Record& record) { return cell_if(record.part == "look_up", value(record)); };
  };
  const auto of_cost = [](auto value) {
    return [value](const Record& record) { return cell_if(record.part != "look_up", value(record)); };
  };
  return {
      {.name = "part",
       .description = "look_up: in a table; cost: what a table takes, counted, with as many distances as "
                      "scalars; cost_of_distances: the same beside half the distances",
       .is_key = true,
       .cell = &Record::part},
      {.name = "shape",
       .description = "transfer function",
       .is_key = true,
       .cell = of_look_up([](const Record& record) { return record.keys.shape; })},
      {.name = "optical_depth",
       .description = "of a slab of length 1 at the largest extinction",
       .is_key = true,
       .cell = of_look_up([](const Record& record) { return record.keys.optical_depth; })},
      {.name = "builder",
       .description = "of a cost: brute_force, entry by entry, or subrange, Lum's, each distance by itself",
       .is_key = true,
       .cell = of_cost([](const Record& record) { return record.builder; })},
      {.name = "size",
       .description = "scalars at either side",
       .is_key = true,
       .cell = [](const Record& record) { return static_cast<std::int64_t>(record.keys.size); }},
      {.name = "distance_axis",
       .description =
           "uniform: 0 to sqrt(3) in equal steps; powers_of_two: 0, then each twice the one before up to "
           "sqrt(3); both linear in D. powers_of_two_log: linear in log D behind the first. printed: 0, then "
           "2^-7 to 2, linear. mean_depth: as uniform, but "
           "opacity without distances, and colour over opacity linear in D. slope: the same opacity; colour over "
           "opacity by D / |back - front|, linear in its logarithm",
       .is_key = true,
       .cell = of_look_up([](const Record& record) { return record.axis; })},
      {.name = "entries",
       .description =
           "exact; brute_force and subrange: of mean intervals; incremental: step by step from nearest entries, as "
           "VTK makes them by default",
       .is_key = true,
       .cell = of_look_up([](const Record& record) { return record.entries; })},
      {.name = "distances",
       .description = "entries along that axis, 0 among them",
       .is_key = true,
       .cell = &Record::distances},
      {.name = "opacity_error",
       .description = "largest, of look-ups at random scalars and lengths up to sqrt(3), against certified slabs",
       .radius = "radius",
       .cell = of_look_up([](const Record& record) { return record.opacity_max; })},
      {.name = "color_error",
       .description = "largest of any channel, the same look-ups",
       .radius = "radius",
       .cell = of_look_up([](const Record& record) { return record.color_max; })},
      {.name = "error_l1",
       .description = "mean magnitude over the four channels",
       .radius = "radius",
       .cell = of_look_up([](const Record& record) { return record.mean; })},
      {.name = "distance_error",
       .description = "largest of any channel where both scalars are entries: what looking D up costs alone",
       .radius = "radius",
       .cell = of_look_up([](const Record& record) { return record.distance_max; })},
      {.name = "opacity_steps",
       .unit = "1/255",
       .description = "opacity_error in steps of an 8-bit frame",
       .cell = of_look_up([](const Record& record) { return frame_steps * record.opacity_max; })},
      {.name = "distance_steps",
       .unit = "1/255",
       .description = "distance_error in steps of an 8-bit frame",
       .cell = of_look_up([](const Record& record) { return frame_steps * record.distance_max; })},
      {.name = "radius",
       .description = "bound on the error of the errors: the reference's",
       .cell = of_look_up([](const Record& record) { return record.radius; })},
      {.name = "bytes_float32",
       .unit = "byte",
       .description = "of the table in binary32; the slab of no length is not kept",
       .cell = of_look_up([](const Record& record) { return static_cast<std::int64_t>(4 * record.numbers); })},
      {.name = "composites", .description = "products of two slabs", .cell = of_cost([](const Record& record) {
                                                                       return record.cost.composites;
                                                                     })},
      {.name = "exponentials", .description = "opacity corrections", .cell = of_cost([](const Record& record) {
                                                                       return record.cost.exponentials;
                                                                     })},
      {.name = "order_composites",
       .description =
           "log2 of composites over those of half the scalars and half the distances, or of half the distances alone",
       .cell = of_cost([](const Record& record) { return record.order; })},
  };
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  add_costs(options, records);
  add_look_ups(experiment, options, records);
  return records;
}

}  // namespace

extern const Measure cell_tables_measure;
const Measure cell_tables_measure{MeasureDefinition<Options, Record>{
    .name = "cell_tables",
    .summary = "tables for slabs of any length: what they take, and errors by their distances",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
