#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/transfer/emission.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
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

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
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

/// A method's errors at the places that are looked up, and at the entries around them.
struct MethodErrors {
  double entry_max = 0;
  double entry_mean = 0;
  double within_one_share = 0;  ///< of the entries
  double same_8_bit_share = 0;  ///< of the entries
  double look_up_max = 0;
  double look_up_mean = 0;
  double look_up_root_mean_square = 0;
  double radius = 0;
  double evaluations_per_entry = 0;
};

MethodErrors errors_of(const std::vector<LookedUp>& all, std::size_t method) {
  MethodErrors errors;
  double entry_sum = 0;
  double sum = 0;
  double square_sum = 0;
  std::int64_t within_one = 0;
  std::int64_t same = 0;
  std::int64_t evaluations = 0;
  for (const LookedUp& one : all) {
    const Found& found = one.found[method];
    errors.radius = std::max(errors.radius, one.radius);
    evaluations += found.evaluations;
    const Vec4 error = (found.look_up - one.truth).abs();
    errors.look_up_max = std::max(errors.look_up_max, error.maxCoeff());
    sum += error.mean();
    square_sum += error.square().mean();
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Vec4 entry_error = (found.entries[corner] - one.true_entries[corner]).abs();
      errors.entry_max = std::max(errors.entry_max, entry_error.maxCoeff());
      entry_sum += entry_error.mean();
      within_one += entry_error.maxCoeff() * frame_steps <= 1 ? 1 : 0;
      same += (in_8_bits(found.entries[corner]) == in_8_bits(one.true_entries[corner])).all() ? 1 : 0;
    }
  }
  const auto count = static_cast<double>(all.size());
  errors.entry_mean = entry_sum / (8 * count);
  errors.within_one_share = static_cast<double>(within_one) / (8 * count);
  errors.same_8_bit_share = static_cast<double>(same) / (8 * count);
  errors.look_up_mean = sum / count;
  errors.look_up_root_mean_square = std::sqrt(square_sum / count);
  errors.evaluations_per_entry = static_cast<double>(evaluations) / (8 * count);
  return errors;
}

Columns<MethodErrors> error_columns() {
  const auto error = [](const char* name, const char* description, double MethodErrors::*value) {
    return RecordColumn<MethodErrors>{.name = name, .description = description, .radius = "radius", .cell = value};
  };
  return {
      error("entry_max", "largest error of an entry against the certified slab, colour channels and opacity",
            &MethodErrors::entry_max),
      error("entry_l1", "mean magnitude of the entries' errors over the four channels", &MethodErrors::entry_mean),
      written_here<MethodErrors>("within_one_share", &MethodErrors::within_one_share),
      written_here<MethodErrors>("same_8_bit_share", &MethodErrors::same_8_bit_share),
      error("error_max", "largest error of trilinear look-ups at random scalars", &MethodErrors::look_up_max),
      error("error_l1", "mean magnitude of it", &MethodErrors::look_up_mean),
      error("error_l2", "root mean square of it", &MethodErrors::look_up_root_mean_square),
      {.name = "within_one_share",
       .description = "share of the entries within one step of an 8-bit frame of the certified slab, all channels",
       .cell = {}},
      {.name = "same_8_bit_share",
       .description = "share of the entries that are the certified slab's when rounded to 8 bits",
       .cell = {}},
      {.name = "radius",
       .description = "bound on the error of the errors: the reference's",
       .cell = &MethodErrors::radius},
      {.name = "evaluations_per_entry",
       .description = "look-ups of the transfer function, or nodes of quadratures; mean of the entries met",
       .cell = &MethodErrors::evaluations_per_entry},
  };
}

/// A method under a transfer function, in a table of one size.
struct Record {
  TableKeys keys;
  std::string method;
  std::optional<int> iterations;  ///< where their number is fixed
  MethodErrors errors;

  [[nodiscard]] std::size_t entries() const { return keys.size * keys.size * keys.size; }
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::keys, table_key_columns());
  append(columns,
         {{.name = "method",
           .description = "mid, left: N iterations with the optics at (k + 1/2)/N or k/N; nyquist: as many as "
                          "the parabola asks for; exact: certified",
           .is_key = true,
           .cell = &Record::method},
          {.name = "iterations", .description = "N; null: not fixed", .is_key = true, .cell = &Record::iterations}});
  append_part(columns, &Record::errors, error_columns());
  append(columns, {{.name = "evaluations",
                    .description = "the same for the whole table",
                    .cell =
                        [](const Record& record) {
                          return record.errors.evaluations_per_entry * static_cast<double>(record.entries());
                        }},
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
        const auto all = look_up_all(options, TableStudy::axes(size),
                                     TableStudy::transfer(shape, depth, experiment.seed), experiment.seed);
        for (std::size_t method = 0; method < options.methods.size(); ++method) {
          const auto& [name, how] = options.methods[method];
          const auto* const iterations = std::get_if<Iterations>(&how);
          records.push_back({.keys = {shape, depth, size},
                             .method = name,
                             .iterations = iterations != nullptr ? std::optional(iterations->count) : std::nullopt,
                             .errors = errors_of(all, method)});
        }
      }
  return records;
}

}  // namespace

extern const Measure second_order_table_measure;
const Measure second_order_table_measure{MeasureDefinition<Options, Record>{
    .name = "second_order_table",
    .summary = "errors of tables of second order by iterations and size, and what they cost",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
