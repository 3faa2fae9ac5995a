#include "experiments/measure.hpp"
#include "measures/ray_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/schemes/quadratic_gray_printed.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/signals/trilinear.hpp"
#include "raytruth/tables/second_order.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

constexpr double most_length = 64;

struct Options {
  double length = 1;  ///< of slabs, in voxels
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "length"});
  const double length = json.at("length").positive_number();
  if (length > most_length) json.at("length").refuse(std::to_string(length), "at most 64 voxels");
  return {.length = length};
}

/// A slip of the print, and how it is taken or repaired.
struct Slip {
  std::string_view name;
  void (*copy)(const QuadraticGrayPrint& from, QuadraticGrayPrint& to);
};

constexpr std::array slips{
    Slip{"Simpson on the singular integrand",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) { to.simpson = from.simpson; }},
    Slip{"the first step at M",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) { to.minimum = from.minimum; }},
    Slip{"smoothed transfer function",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) { to.smoothed = from.smoothed; }},
    Slip{"s < 0 left out",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) { to.drops_negative = from.drops_negative; }},
    Slip{"a < eps is linear",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) { to.upward_only = from.upward_only; }},
    Slip{"transmittance of another entry",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) {
           to.entry_transmittance = from.entry_transmittance;
         }},
    Slip{"R between powers of two",
         [](const QuadraticGrayPrint& from, QuadraticGrayPrint& to) { to.radius_steps = from.radius_steps; }}};

/// A way to compute the slabs.
struct Variant {
  std::string_view slip;
  std::string_view role;
  QuadraticGrayPrint print;
};

std::vector<Variant> variants() {
  const QuadraticGrayPrint printed;
  const QuadraticGrayPrint repaired = QuadraticGrayPrint::repaired();
  std::vector<Variant> list{{"none", "alone", repaired}, {"all", "alone", printed}};
  for (const Slip& slip : slips) {
    QuadraticGrayPrint alone = repaired;
    slip.copy(printed, alone);
    list.push_back({slip.name, "alone", alone});
    QuadraticGrayPrint without = printed;
    slip.copy(repaired, without);
    list.push_back({slip.name, "repaired alone", without});
  }
  QuadraticGrayPrint reading = repaired;
  reading.minimum = AroundMinimum::dropped;
  list.push_back({"sums begin at ceil(M)", "alone", reading});
  const auto read = [&](std::string_view name, auto set) {
    reading = printed;
    set(reading);
    list.push_back({name, "reading of the print", reading});
  };
  read("loops inclusive", [](QuadraticGrayPrint& print) { print.inclusive_loops = true; });
  read("end if as it stands", [](QuadraticGrayPrint& print) { print.nested_end_if = true; });
  read("nearest R", [](QuadraticGrayPrint& print) { print.look_up = RadiusLookUp::nearest; });
  read("lookdis with ln 2", [](QuadraticGrayPrint& print) { print.look_up = RadiusLookUp::natural_logarithm; });
  return list;
}

struct Record {
  TransferKeys keys;
  std::string_view slip;
  std::string_view role;
  std::int64_t slabs = 0;
  double opacity_mean = 0;
  double opacity_max = 0;
  double color_mean = 0;
  double color_max = 0;
  double linear_mean = 0;
  double radius = 0;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns;
  append_part(columns, &Record::keys, transfer_key_columns());
  append(
      columns,
      Columns<Record>{
          {.name = "slip", .description = "of the print, or a reading of it", .is_key = true, .cell = &Record::slip},
          {.name = "role",
           .description = "alone: on the exact model, at whole gray values and bilinear between; repaired alone: on "
                          "the print; reading of the print: with all slips",
           .is_key = true,
           .cell = &Record::role},
          {.name = "slabs", .description = "one of every ray, random along it", .cell = &Record::slabs},
          {.name = "opacity_error_l1",
           .description = "mean error of opacity, against the certified slab of the parabola",
           .radius = "radius",
           .cell = &Record::opacity_mean},
          {.name = "opacity_error_max", .description = "largest one", .radius = "radius", .cell = &Record::opacity_max},
          {.name = "color_error_l1",
           .description = "mean error of colour, over three channels",
           .radius = "radius",
           .cell = &Record::color_mean},
          {.name = "color_error_max", .description = "largest one", .radius = "radius", .cell = &Record::color_max},
          {.name = "error_over_linear",
           .description = "mean error of colour and opacity over that of the exact slab of the line through front "
                          "and back",
           .cell =
               [](const Record& record) {
                 return (record.opacity_mean + 3 * record.color_mean) / (4 * record.linear_mean);
               }},
          {.name = "radius", .description = "bound on the error of the errors", .cell = &Record::radius}});
  return columns;
}

struct StudiedSlab {
  std::array<double, 3> scalars{};
  bool is_studied = false;
};

/// Front, middle and back of a slab of every ray.
std::vector<StudiedSlab> slabs_of(const Experiment& experiment, const Options& options, const Field& field) {
  std::vector<StudiedSlab> slabs(static_cast<std::size_t>(experiment.rays.count));
  tbb::parallel_for(std::size_t{0}, slabs.size(), [&](std::size_t ray) {
    const Chain<3> signal =
        trace_trilinear(field.grid, random_ray(field.grid, experiment.rays.length, experiment.seed, ray));
    if (signal.is_constant() || signal.length() < options.length) return;
    const double start =
        random_numbers(experiment.seed, RandomStream::points, ray)[0] * (signal.length() - options.length);
    for (std::size_t i = 0; i < 3; ++i)
      slabs[ray].scalars[i] = signal.value(DoubleDouble(start + 0.5 * static_cast<double>(i) * options.length));
    slabs[ray].is_studied = true;
  });
  return slabs;
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  const auto [low, high] = field.grid.range();
  const TableAxes axes{.size = 2, .low = low, .high = high, .length = options.length};
  const std::vector<StudiedSlab> slabs = slabs_of(experiment, options, field);
  std::vector<Record> records;
  for (const auto& [name, transfer] : experiment.transfers) {
    std::vector<Certified> truths(slabs.size());
    std::vector<Vec4> lines(slabs.size(), Vec4::Zero());
    SecondOrderSlabs certified(transfer, axes, experiment.emission);
    for (std::size_t i = 0; i < slabs.size(); ++i) {
      if (!slabs[i].is_studied) continue;
      const auto& [front, middle, back] = slabs[i].scalars;
      truths[i] = certified.certified(slabs[i].scalars);
      lines[i] = certified.certified({front, 0.5 * (front + back), back}).rgba();
    }
    for (const auto& [slip, role, print] : variants()) {
      std::vector<Vec4> errors(slabs.size(), Vec4::Zero());
      tbb::enumerable_thread_specific<QuadraticGrayPrinted> printed([&, &print = print] {
        return QuadraticGrayPrinted(transfer, low, high, options.length, experiment.emission, print);
      });
      tbb::parallel_for(std::size_t{0}, slabs.size(), [&](std::size_t i) {
        if (!slabs[i].is_studied) return;
        const auto& [front, middle, back] = slabs[i].scalars;
        const double curvature = Rules<double>{}.quadratic_gray_curvature(front, middle, back, options.length);
        errors[i] = (printed.local()(front, back, curvature) - truths[i].rgba()).abs();
      });
      Record record{.keys = {name, experiment.emission}, .slip = slip, .role = role};
      for (std::size_t i = 0; i < slabs.size(); ++i) {
        if (!slabs[i].is_studied) continue;
        ++record.slabs;
        record.opacity_mean += errors[i][3];
        record.opacity_max = std::max(record.opacity_max, errors[i][3]);
        record.color_mean += errors[i].head<3>().mean();
        record.color_max = std::max(record.color_max, errors[i].head<3>().maxCoeff());
        record.linear_mean += (lines[i] - truths[i].rgba()).abs().mean();
        record.radius = std::max(record.radius, truths[i].radius);
      }
      const double count = static_cast<double>(std::max<std::int64_t>(record.slabs, 1));
      for (double* const mean : {&record.opacity_mean, &record.color_mean, &record.linear_mean}) *mean /= count;
      records.push_back(record);
    }
  }
  return records;
}

}  // namespace

extern const Measure quadratic_slips_measure;
const Measure quadratic_slips_measure{MeasureDefinition<Options, Record>{
    .name = "quadratic_slips",
    .summary = "what each slip of the quadratic gray-value model's print costs, alone and repaired alone",
    .needs = {.transfers = true},
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
