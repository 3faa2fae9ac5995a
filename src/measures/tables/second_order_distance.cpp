#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
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
constexpr double longest = std::numbers::sqrt3;  // chord of a dual voxel

/// How a table goes from its distances to any other.
struct DistanceAxis {
  std::string_view name;
  std::vector<double> distances;  ///< ascending; one: opacity is corrected from it
};

/// From 0 in equal steps, or, behind 0, each twice the one before.
DistanceAxis uniform(std::int64_t count) {
  DistanceAxis axis{"uniform", {}};
  for (std::int64_t i = 0; i < count; ++i)
    axis.distances.push_back(longest * static_cast<double>(i) / static_cast<double>(count - 1));
  return axis;
}

DistanceAxis powers_of_two(std::int64_t count) {
  DistanceAxis axis{"powers_of_two", {0}};
  for (std::int64_t i = 1; i < count; ++i)
    axis.distances.push_back(std::ldexp(longest, static_cast<int>(i - count + 1)));
  return axis;
}

struct Options {
  TableStudy study;
  std::vector<DistanceAxis> axes;
  std::size_t look_ups = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "sizes", "distances", "look_ups"});
  Options options{.study = read_table_study(json, largest_table3_size),
                  .axes = {{"one_corrected", {1}}},
                  .look_ups = static_cast<std::size_t>(json.at("look_ups").integer(1, most_look_ups))};
  for (const JsonReader& item : json.at("distances").items()) {
    const std::int64_t count = item.integer(2, most_distances);
    options.axes.push_back(uniform(count));
    // Below 2^-60 of the longest nothing is seen.
    if (count <= 60) options.axes.push_back(powers_of_two(count));
  }
  return options;
}

/// Slabs of any length; what those of a table's distances need is kept. One object per thread.
class Slabs {
 public:
  Slabs(const PiecewiseLinear& transfer, const TableAxes& axes) : transfer_(transfer), axes_(axes) {}

  [[nodiscard]] Certified certified(const std::array<double, 3>& scalars, double length) const {
    return of_length(length).certified(scalars);
  }

  /// As the distance axis looks it up, its entries exact.
  Vec4 at(const DistanceAxis& axis, const std::array<double, 3>& scalars, double length) {
    const auto entry = [&](double distance) -> Vec4 {
      if (distance == 0) return Vec4::Zero();
      auto kept = kept_.find(distance);
      if (kept == kept_.end()) kept = kept_.emplace(distance, of_length(distance)).first;
      const Certified slab = kept->second.certified(scalars);
      return {slab.color[0], slab.color[1], slab.color[2], slab.opacity};
    };
    if (axis.distances.size() == 1) {
      const double share = length / axis.distances.front();
      const Vec4 slab = entry(axis.distances.front());
      return rules_.opacity_corrected_slab(slab, rules_.opacity_correction(slab[3], share), share);
    }
    const auto above = std::clamp<std::ptrdiff_t>(
        std::upper_bound(axis.distances.begin(), axis.distances.end(), length) - axis.distances.begin(), 1,
        static_cast<std::ptrdiff_t>(axis.distances.size()) - 1);
    const double low = axis.distances[static_cast<std::size_t>(above - 1)];
    const double high = axis.distances[static_cast<std::size_t>(above)];
    const Vec4 front = entry(low);
    return front + (length - low) / (high - low) * (entry(high) - front);
  }

 private:
  [[nodiscard]] SecondOrderSlabs of_length(double length) const {
    TableAxes axes = axes_;
    axes.length = length;
    return {transfer_, axes, Emission::associated};
  }

  const PiecewiseLinear& transfer_;
  TableAxes axes_;
  Rules<double> rules_;
  std::map<double, SecondOrderSlabs> kept_;
};

/// The errors of a place: of its distance alone, the scalars being exact, and of the whole look-up.
struct LookedUp {
  double radius = 0;
  std::vector<Vec4> of_distance;  ///< by axis, magnitudes
  std::vector<Vec4> of_all;
};

LookedUp look_up(const Options& options, const TableAxes& axes, Slabs& slabs, const std::array<double, 4>& random) {
  const std::array<double, 3> scalars{random[0], random[1], random[2]};
  const double length = longest * std::max(random[3], 0x1p-20);
  const Certified certified = slabs.certified(scalars, length);
  const Vec4 truth(certified.color[0], certified.color[1], certified.color[2], certified.opacity);
  LookedUp result;
  result.radius = certified.radius;
  for (const DistanceAxis& axis : options.axes) {
    result.of_distance.emplace_back((slabs.at(axis, scalars, length) - truth).abs());
    // Trilinear in the scalars of what the distances give: the same as quadrilinear, which is linear in each.
    const Vec4 found = trilinear<double>(
        axes,
        [&](std::size_t front, std::size_t middle, std::size_t back) {
          return slabs.at(axis, {axes.scalar(front), axes.scalar(middle), axes.scalar(back)}, length);
        },
        scalars);
    result.of_all.emplace_back((found - truth).abs());
  }
  return result;
}

std::vector<LookedUp> look_up_all(const Options& options, const TableAxes& axes, const PiecewiseLinear& transfer,
                                  std::uint64_t seed) {
  std::vector<LookedUp> all(options.look_ups);
  tbb::enumerable_thread_specific<Slabs> slabs([&] { return Slabs(transfer, axes); });
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    all[i] = look_up(options, axes, slabs.local(), random_numbers(seed, RandomStream::points, i));
  });
  return all;
}

/// A table's look-ups.
struct Record {
  TableKeys keys;
  std::string_view axis;
  std::size_t distances = 0;
  double distance_max = 0;
  double distance_mean = 0;
  double max = 0;
  double mean = 0;
  double root_mean_square = 0;
  double radius = 0;

  [[nodiscard]] std::size_t entries() const { return keys.size * keys.size * keys.size * distances; }
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  const auto error = [](const char* name, const char* description, double Record::*value) {
    return RecordColumn<Record>{.name = name, .description = description, .radius = "radius", .cell = value};
  };
  Columns<Record> columns;
  append_part(columns, &Record::keys, table_key_columns());
  append(columns,
         Columns<Record>{
             {.name = "distance_axis",
              .description = "uniform: distances 0 to sqrt(3) in equal steps; powers_of_two: 0, then each twice "
                             "the one before, up to sqrt(3); interpolated linearly. one_corrected: 1 alone, its "
                             "opacity corrected as a homogeneous slab's",
              .is_key = true,
              .cell = &Record::axis},
             {.name = "distances", .description = "entries along it", .is_key = true, .cell = &Record::distances},
             error("distance_error_max",
                   "largest error of looking the distance up alone, between exact slabs of the same scalars, at "
                   "random scalars and lengths; colour channels and opacity, against certified slabs",
                   &Record::distance_max),
             error("distance_error_l1", "mean magnitude of it over the four channels", &Record::distance_mean),
             error("error_max", "largest error of quadrilinear look-ups in exact entries", &Record::max),
             error("error_l1", "mean magnitude of it", &Record::mean),
             error("error_l2", "root mean square of it", &Record::root_mean_square),
             {.name = "radius",
              .description = "bound on the error of the errors: the reference's",
              .cell = &Record::radius},
             {.name = "bytes_float32",
              .unit = "byte",
              .description = "of the table in binary32, RGBA",
              .cell = [](const Record& record) { return bytes_of(record.entries(), table_formats[1]); }},
             {.name = "bytes_unorm8",
              .unit = "byte",
              .description = "of the table in 8 bits, RGBA",
              .cell = [](const Record& record) { return bytes_of(record.entries(), table_formats.back()); }}});
  return columns;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> records;
  for (const std::string& shape : options.study.shapes)
    for (const double depth : options.study.optical_depths)
      for (const std::size_t size : options.study.sizes) {
        const PiecewiseLinear transfer = TableStudy::transfer(shape, depth, experiment.seed);
        const auto all = look_up_all(options, TableStudy::axes(size), transfer, experiment.seed);
        const auto count = static_cast<double>(all.size());
        for (std::size_t i = 0; i < options.axes.size(); ++i) {
          Record record{.keys = {shape, depth, size},
                        .axis = options.axes[i].name,
                        .distances = options.axes[i].distances.size()};
          for (const LookedUp& one : all) {
            record.radius = std::max(record.radius, one.radius);
            record.distance_max = std::max(record.distance_max, one.of_distance[i].maxCoeff());
            record.distance_mean += one.of_distance[i].mean() / count;
            record.max = std::max(record.max, one.of_all[i].maxCoeff());
            record.mean += one.of_all[i].mean() / count;
            record.root_mean_square += one.of_all[i].square().mean() / count;
          }
          record.root_mean_square = std::sqrt(record.root_mean_square);
          records.push_back(record);
        }
      }
  return records;
}

}  // namespace

extern const Measure second_order_distance_measure;
const Measure second_order_distance_measure{MeasureDefinition<Options, Record>{
    .name = "second_order_distance",
    .summary = "errors of four-dimensional tables of second order by their distances, and their sizes",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
