#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

constexpr std::int64_t most_iterations = 65536;
constexpr std::int64_t most_look_ups = 10'000'000;
constexpr double frame_steps = 255;

struct NamedMethod {
  std::string name;
  SecondOrderMethod method;
};

struct Options {
  TableStudy study;
  std::vector<NamedMethod> methods;
  std::size_t look_ups = 0;
};

Options read_options(const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depths", "sizes", "counts", "look_ups"});
  Options options{.study = read_table_study(json, largest_table3_size),
                  .methods = {},
                  .look_ups = static_cast<std::size_t>(json.at("look_ups").integer(1, most_look_ups))};
  for (const bool is_left : {false, true})
    for (const JsonReader& item : json.at("counts").items())
      options.methods.push_back(
          {is_left ? "left" : "mid",
           Iterations{.count = static_cast<int>(item.integer(1, most_iterations)), .is_left = is_left}});
  options.methods.push_back({"nyquist", NyquistIterations{}});
  options.methods.push_back({"exact", Ideal{}});
  return options;
}

Vec4 slab_of(const Certified& certified) {
  return {certified.color[0], certified.color[1], certified.color[2], certified.opacity};
}

/// What a method makes of the eight entries around a place, and of the place itself by trilinear interpolation.
struct Found {
  std::array<Vec4, 8> entries;
  Vec4 look_up;
  std::int64_t evaluations = 0;  ///< of the eight
};

struct LookedUp {
  Vec4 truth;
  std::array<Vec4, 8> true_entries;
  double radius = 0;
  std::vector<Found> found;  ///< of each method
};

LookedUp look_up(const Options& options, const TableAxes& axes, SecondOrderSlabs& slabs,
                 const std::array<double, 3>& scalars) {
  LookedUp result;
  const Certified truth = slabs.certified(scalars);
  result.truth = slab_of(truth);
  result.radius = truth.radius;
  std::array<std::size_t, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    first[axis] = std::min(TablePlace<double>::of(axes, scalars[axis], 0).first, axes.size - 2);
  const auto entry_scalars = [&](std::size_t corner) -> std::array<double, 3> {
    return {axes.scalar(first[0] + corner % 2), axes.scalar(first[1] + corner / 2 % 2),
            axes.scalar(first[2] + corner / 4)};
  };
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Certified entry = slabs.certified(entry_scalars(corner));
    result.true_entries[corner] = slab_of(entry);
    result.radius = std::max(result.radius, entry.radius);
  }
  for (const NamedMethod& named : options.methods) {
    Found& found = result.found.emplace_back();
    const std::int64_t before = slabs.evaluations();
    for (std::size_t corner = 0; corner < 8; ++corner)
      found.entries[corner] = slabs(entry_scalars(corner), named.method);
    found.evaluations = slabs.evaluations() - before;
    found.look_up = trilinear<double>(
        axes,
        [&](std::size_t front, std::size_t middle, std::size_t back) -> Vec4 {
          return found.entries[(front - first[0]) + 2 * (middle - first[1]) + 4 * (back - first[2])];
        },
        scalars);
  }
  return result;
}

std::vector<LookedUp> look_up_all(const Options& options, const TableAxes& axes, const PiecewiseLinear& transfer,
                                  std::uint64_t seed) {
  constexpr std::size_t in_one_go = 16;
  std::vector<LookedUp> all(options.look_ups);
  tbb::parallel_for(std::size_t{0}, (options.look_ups + in_one_go - 1) / in_one_go, [&](std::size_t chunk) {
    SecondOrderSlabs slabs(transfer, axes, Emission::associated);
    for (std::size_t i = chunk * in_one_go; i < std::min(all.size(), (chunk + 1) * in_one_go); ++i) {
      const auto random = random_numbers(seed, RandomStream::points, i);
      all[i] = look_up(options, axes, slabs, {random[0], random[1], random[2]});
    }
  });
  return all;
}

/// A value of an 8-bit frame.
Vec4 in_8_bits(const Vec4& slab) { return (frame_steps * slab).min(frame_steps).max(0).round(); }

void add_errors(Row& row, const std::vector<LookedUp>& all, std::size_t method, std::size_t size) {
  double entry_max = 0;
  double entry_l1 = 0;
  double error_max = 0;
  double error_l1 = 0;
  double error_l2 = 0;
  double radius = 0;
  std::int64_t within_one = 0;
  std::int64_t same = 0;
  std::int64_t evaluations = 0;
  for (const LookedUp& one : all) {
    const Found& found = one.found[method];
    radius = std::max(radius, one.radius);
    evaluations += found.evaluations;
    const Vec4 error = (found.look_up - one.truth).abs();
    error_max = std::max(error_max, error.maxCoeff());
    error_l1 += error.mean();
    error_l2 += error.square().mean();
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Vec4 entry_error = (found.entries[corner] - one.true_entries[corner]).abs();
      entry_max = std::max(entry_max, entry_error.maxCoeff());
      entry_l1 += entry_error.mean();
      within_one += entry_error.maxCoeff() * frame_steps <= 1 ? 1 : 0;
      same += (in_8_bits(found.entries[corner]) == in_8_bits(one.true_entries[corner])).all() ? 1 : 0;
    }
  }
  const auto count = static_cast<double>(all.size());
  const std::size_t entries = size * size * size;
  const double per_entry = static_cast<double>(evaluations) / (8 * count);
  row.insert(row.end(), {{"entry_max", entry_max},
                         {"entry_l1", entry_l1 / (8 * count)},
                         {"within_one_share", static_cast<double>(within_one) / (8 * count)},
                         {"same_8_bit_share", static_cast<double>(same) / (8 * count)},
                         {"error_max", error_max},
                         {"error_l1", error_l1 / count},
                         {"error_l2", std::sqrt(error_l2 / count)},
                         {"radius", radius},
                         {"evaluations_per_entry", per_entry},
                         {"evaluations", per_entry * static_cast<double>(entries)},
                         {"bytes_float32", bytes_of(entries, table_formats[1])},
                         {"bytes_unorm8", bytes_of(entries, table_formats.back())}});
}

}  // namespace

std::vector<Column> second_order_table_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  std::vector<Column> columns = table_key_columns();
  append(columns, {{.name = "method",
                    .unit = "",
                    .description = "mid, left: N iterations with the optics at (k + 1/2)/N or k/N; nyquist: as many as "
                                   "the parabola asks for; exact: certified",
                    .is_key = true},
                   {.name = "iterations", .unit = "", .description = "N; null: not fixed", .is_key = true}});
  const auto add = [&columns](const char* name, const char* description) {
    columns.push_back({.name = name, .unit = "", .description = description, .is_key = false, .radius = "radius"});
  };
  add("entry_max", "largest error of an entry against the certified slab, colour channels and opacity");
  add("entry_l1", "mean magnitude of the entries' errors over the four channels");
  add("error_max", "largest error of trilinear look-ups at random scalars");
  add("error_l1", "mean magnitude of it");
  add("error_l2", "root mean square of it");
  append(columns,
         {{.name = "within_one_share",
           .unit = "",
           .description = "share of the entries within one step of an 8-bit frame of the certified slab, all channels"},
          {.name = "same_8_bit_share",
           .unit = "",
           .description = "share of the entries that are the certified slab's when rounded to 8 bits"},
          {.name = "radius", .unit = "", .description = "bound on the error of the errors: the reference's"},
          {.name = "evaluations_per_entry",
           .unit = "",
           .description = "look-ups of the transfer function, or nodes of quadratures; mean of the entries met"},
          {.name = "evaluations", .unit = "", .description = "the same for the whole table"},
          {.name = "bytes_float32", .unit = "byte", .description = "of the table in binary32, RGBA"},
          {.name = "bytes_unorm8", .unit = "byte", .description = "of the table in 8 bits, RGBA"}});
  return columns;
}

std::vector<Row> second_order_table_rows(const Experiment& experiment, const JsonReader& options,
                                         const Field& /*field*/) {
  const Options asked = read_options(options);
  std::vector<Row> rows;
  for (const std::string& shape : asked.study.shapes)
    for (const double depth : asked.study.optical_depths)
      for (const std::size_t size : asked.study.sizes) {
        const auto all = look_up_all(asked, TableStudy::axes(size), TableStudy::transfer(shape, depth, experiment.seed),
                                     experiment.seed);
        for (std::size_t method = 0; method < asked.methods.size(); ++method) {
          const auto& [name, how] = asked.methods[method];
          const auto* const iterations = std::get_if<Iterations>(&how);
          Row& row = rows.emplace_back(table_keys(shape, depth, size));
          row.emplace_back("method", name);
          row.emplace_back("iterations", iterations ? Value(std::int64_t{iterations->count}) : Value());
          add_errors(row, all, method, size);
        }
      }
  return rows;
}

}  // namespace raytruth
