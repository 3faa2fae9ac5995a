#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/schemes/radius_axis.hpp"
#include "raytruth/tables/second_order.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::int64_t most_look_ups = 1'000'000;
constexpr double low = 0.125;
constexpr double high = 8;
constexpr std::size_t powers_of_two_count = 7;

/// Which curvatures are looked up.
struct Curvatures {
  std::string_view name;
  double smallest = 0;  ///< |a|, in gray values per squared length, its logarithm equally likely
  double largest = 0;
};

constexpr std::array curvature_ranges{Curvatures{"flat", 0x1p-12, 0x1p-6}, Curvatures{"covered", 0x1p-6, 0x1p6},
                                      Curvatures{"steep", 0x1p6, 0x1p10}};

struct Options {
  TableStudy study;  ///< without sizes
  std::vector<RadiusAxis> axes;
  std::size_t look_ups = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "counts", "look_ups"});
  Options options{
      .study = {}, .axes = {}, .look_ups = static_cast<std::size_t>(json.at("look_ups").integer(1, most_look_ups))};
  for (const JsonReader& item : json.at("shapes").items()) options.study.shapes.push_back(read_shape(item));
  for (const JsonReader& item : json.at("optical_depths").items())
    options.study.optical_depths.push_back(read_optical_depth(item));
  for (const RadiusLookUp look_up :
       {RadiusLookUp::linear_in_radius, RadiusLookUp::linear_in_curvature, RadiusLookUp::nearest})
    options.axes.push_back({.steps = RadiusSteps::powers_of_two,
                            .low = low,
                            .high = high,
                            .count = powers_of_two_count,
                            .look_up = look_up});
  for (const JsonReader& item : json.at("counts").items()) {
    const auto count = static_cast<std::size_t>(item.integer(2, static_cast<std::int64_t>(most_radii)));
    options.axes.push_back({.steps = RadiusSteps::equal_steps,
                            .low = low,
                            .high = high,
                            .count = count,
                            .look_up = RadiusLookUp::linear_in_radius});
    options.axes.push_back({.low = low, .high = high, .count = count});
    // As many nodes, up to the largest curvature that 8-bit data have in a slab of length 1.
    options.axes.push_back({.low = 0x1p-5, .high = high, .count = count});
  }
  return options;
}

struct Record {
  std::string shape;
  double optical_depth = 0;
  RadiusAxis axis;
  std::string_view range;
  double max = 0;
  double mean = 0;
  double root_mean_square = 0;
  double radius = 0;
  double equal_steps_mean = 0;  ///< of the axis with the most equal steps
};

constexpr std::array<std::string_view, 3> look_up_names{"linear in a", "linear in R", "nearest"};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append(columns,
         Columns<Record>{{.name = "shape", .description = "transfer function", .is_key = true, .cell = &Record::shape},
                         {.name = "optical_depth",
                          .description = "of a slab that meets the largest extinction all along",
                          .is_key = true,
                          .cell = &Record::optical_depth}});
  append(
      columns,
      Columns<Record>{
          {.name = "axis",
           .description = "where radii stand: powers_of_two; equal_steps; signed: in equal ratios, through the linear "
                          "table",
           .is_key = true,
           .cell =
               [](const Record& record) { return radius_steps_names[static_cast<std::size_t>(record.axis.steps)]; }},
          {.name = "look_up",
           .description = "between two of them",
           .is_key = true,
           .cell = [](const Record& record) { return look_up_names[static_cast<std::size_t>(record.axis.look_up)]; }},
          {.name = "low",
           .description = "smallest radius",
           .is_key = true,
           .cell = [](const Record& record) { return record.axis.low; }},
          {.name = "radii",
           .description = "n_R, of either sign",
           .is_key = true,
           .cell = [](const Record& record) { return record.axis.count; }},
          {.name = "placing",
           .description = "axis and look-up together, and the smallest radius where that is not 2^-3",
           .cell =
               [](const Record& record) {
                 return fmt::format("{}, {}{}", radius_steps_names[static_cast<std::size_t>(record.axis.steps)],
                                    look_up_names[static_cast<std::size_t>(record.axis.look_up)],
                                    record.axis.low == low ? "" : ", from 2^-5");
               }},
          {.name = "curvatures",
           .description = "flat: |a| = 2^-12 to 2^-6, below the print's threshold; covered: to 2^6, R = 2^-3; steep: "
                          "to 2^10, beyond its radii; logarithms equally likely, both signs",
           .is_key = true,
           .cell = &Record::range},
          {.name = "error_max",
           .description = "largest error, colours and opacity, of the look-up along this axis alone, its entries "
                          "exact at the same ends, against certified slabs",
           .radius = "radius",
           .cell = &Record::max},
          {.name = "error_l1", .description = "mean magnitude of it", .radius = "radius", .cell = &Record::mean},
          {.name = "error_l2",
           .description = "root mean square of it",
           .radius = "radius",
           .cell = &Record::root_mean_square},
          {.name = "radius", .description = "bound on the error of the errors", .cell = &Record::radius},
          {.name = "error_over_equal_steps",
           .description = "error_l1 over that of the most equal steps",
           .cell = [](const Record& record) { return record.mean / record.equal_steps_mean; }},
          {.name = "nodes",
           .description = "of the axis: both signs and the linear table",
           .cell = [](const Record& record) { return record.axis.node_count(); }},
          {.name = "bytes_unorm8",
           .unit = "byte",
           .description = "of a table of 256 x 256 scalars in 8 bits, RGBA",
           .cell =
               [](const Record& record) {
                 return bytes_of(record.axis.node_count() * 256 * 256, table_formats.back());
               }},
          {.name = "build_over_powers_of_two",
           .description = "entries that are built over those of powers_of_two: the cost of a build, every radius "
                          "being built alike",
           .cell =
               [](const Record& record) {
                 return static_cast<double>(record.axis.count) / static_cast<double>(powers_of_two_count);
               }},
      });
  return columns;
}

/// The errors of all axes at one place, magnitudes.
struct LookedUp {
  std::vector<Vec4> errors;
  double radius = 0;
};

LookedUp look_up(const Options& options, const std::vector<RadiusNodes>& nodes, SecondOrderSlabs& slabs,
                 const Curvatures& range, const std::array<double, 4>& random) {
  const std::array ends{random[0], random[1]};
  const double curvature =
      (random[3] < 0.5 ? -1 : 1) * range.smallest * std::pow(range.largest / range.smallest, random[2]);
  LookedUp result;
  const auto slab = [&](double a) {
    const double middle = Rules<double>{}.quadratic_gray_middle(ends[0], ends[1], a / largest_gray, 1);
    const Certified found = slabs.certified({ends[0], middle, ends[1]});
    result.radius = std::max(result.radius, found.radius);
    return Vec4(found.rgba());
  };
  const Vec4 truth = slab(curvature);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const RadiusNodes::Place place = nodes[i].place(curvature);
    Vec4 found = slab(options.axes[i].curvature(place.first));
    if (place.weight > 0) found += place.weight * (slab(options.axes[i].curvature(place.second)) - found);
    result.errors.emplace_back((found - truth).abs());
  }
  return result;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<RadiusNodes> nodes;
  for (const RadiusAxis& axis : options.axes) nodes.emplace_back(axis);
  std::vector<Record> records;
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths) {
      const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
      const TableAxes axes = TableStudy::axes(2);
      for (std::size_t range = 0; range < curvature_ranges.size(); ++range) {
        std::vector<LookedUp> all(options.look_ups);
        constexpr std::size_t in_one_go = 16;
        tbb::parallel_for(std::size_t{0}, (all.size() + in_one_go - 1) / in_one_go, [&](std::size_t chunk) {
          SecondOrderSlabs slabs(transfer, axes, Emission::associated);
          for (std::size_t i = chunk * in_one_go; i < std::min(all.size(), (chunk + 1) * in_one_go); ++i)
            all[i] =
                look_up(options, nodes, slabs, curvature_ranges[range],
                        random_numbers(experiment.seed, RandomStream::points, i, static_cast<std::uint32_t>(range)));
        });
        const auto count = static_cast<double>(all.size());
        const std::size_t first = records.size();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          Record record{
              .shape = shape, .optical_depth = depth, .axis = options.axes[i], .range = curvature_ranges[range].name};
          for (const LookedUp& one : all) {
            record.radius = std::max(record.radius, one.radius);
            record.max = std::max(record.max, one.errors[i].maxCoeff());
            record.mean += one.errors[i].mean() / count;
            record.root_mean_square += one.errors[i].square().mean() / count;
          }
          record.root_mean_square = std::sqrt(record.root_mean_square);
          records.push_back(record);
        }
        const Record* most = nullptr;
        for (std::size_t i = first; i < records.size(); ++i)
          if (records[i].axis.steps == RadiusSteps::equal_steps &&
              (most == nullptr || records[i].axis.count > most->axis.count))
            most = &records[i];
        const double of_most = most->mean;
        for (std::size_t i = first; i < records.size(); ++i) records[i].equal_steps_mean = of_most;
      }
    }
  return records;
}

}  // namespace

extern const Measure quadratic_r_axis_measure;
const Measure quadratic_r_axis_measure{MeasureDefinition<Options, Record>{
    .name = "quadratic_r_axis",
    .summary = "errors of quadratic tables by where their radii stand and how they are looked up",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
