#include "experiments/measure.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/deformation/displacement.hpp"
#include "raytruth/deformation/inverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raytruth {

namespace {

// Where the fixed point is taken to be reached, in voxels.
constexpr double reached = 1e-6;
constexpr int most_steps = 60;

struct Options {
  std::int64_t cells = 0;    ///< of the lattice, on each axis
  std::int64_t spacing = 0;  ///< voxels in one
  std::int64_t points = 0;
  int steps = 0;  ///< of the fixed point, each of them a method
  std::vector<double> amplitudes;
};

/// A kind of displacement, in proportion to an amplitude.
struct Kind {
  std::string_view name;
  Displacement (*of_amplitude)(double);
};

constexpr std::array kinds{
    Kind{"twist", [](double amplitude) -> Displacement { return Twist{.axis = 2, .degrees = 90 * amplitude}; }},
    Kind{"bend", [](double amplitude) -> Displacement { return Bend{.degrees = 90 * amplitude}; }},
    Kind{"taper",
         [](double amplitude) -> Displacement {
           return Taper{.axis = 2, .scale = {1, 1 - amplitude}};
         }},
    Kind{"bulge", [](double amplitude) -> Displacement { return Bulge{.axis = 2, .amount = amplitude}; }},
    Kind{"random",
         [](double amplitude) -> Displacement { return RandomDisplacement{.amplitude = amplitude, .seed = 1}; }}};

struct Record {
  std::string_view part;
  std::string_view kind = {};
  std::optional<double> amplitude = {};
  std::string method = {};
  double displacement = 0;  ///< the largest, in voxels
  double residual_max = 0;  ///< in voxels
  double residual_rms = 0;
  std::optional<double> order = {};  ///< in the amplitude, from the one before
  std::optional<double> evaluations = {};
  std::optional<double> radius = {};  ///< that the certified inverse states
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "cells", "spacing", "points", "steps", "amplitudes"});
  Options options;
  options.cells = json.at("cells").integer(1, 64);
  options.spacing = json.at("spacing").integer(1, 256);
  options.points = json.at("points").integer(1, std::int64_t{1} << 20);
  options.steps = static_cast<int>(json.at("steps").integer(1, most_steps));
  for (const JsonReader& amplitude : json.at("amplitudes").items())
    options.amplitudes.push_back(amplitude.positive_number());
  return options;
}

/// The lattice of a cube of voxels with its border.
LatticeBox box_of(const Options& options) {
  return {.origin = Eigen::Vector3d::Constant(-0.5),
          .edges = Eigen::Matrix3d::Identity() * static_cast<double>(options.cells * options.spacing)};
}

std::array<std::int64_t, 3> cells_of(const Options& options) { return {options.cells, options.cells, options.cells}; }

/// What an inverse is off by at points of the object, whose points in the world are known.
class Errors {
 public:
  void add(double error) {
    largest_ = std::max(largest_, error);
    squares_ += error * error;
    ++count_;
  }
  void write(Record& record) const {
    record.residual_max = largest_;
    record.residual_rms = std::sqrt(squares_ / static_cast<double>(count_));
  }

 private:
  double largest_ = 0;
  double squares_ = 0;
  std::int64_t count_ = 0;
};

/// Points of the object and what the lattice makes of them.
struct Points {
  std::vector<Eigen::Vector3d> object;
  std::vector<Eigen::Vector3d> world;
  double displacement = 0;

  Points(const Options& options, std::uint64_t seed, const Lattice& lattice) {
    const LatticeBox& box = lattice.box();
    for (std::int64_t i = 0; i < options.points; ++i) {
      const auto chance = random_numbers(seed, RandomStream::points, static_cast<std::uint64_t>(i));
      object.emplace_back(box.origin + box.edges * Eigen::Vector3d(chance[0], chance[1], chance[2]));
      world.push_back(lattice(object.back()));
      displacement = std::max(displacement, (world.back() - object.back()).norm());
    }
  }
};

/// How many steps of the fixed point the worst of the points takes; none: more than `most_steps`.
std::optional<double> steps_to_the_fixed_point(const Lattice& lattice, const Points& points) {
  int most = 0;
  for (std::size_t i = 0; i < points.object.size(); ++i) {
    Eigen::Vector3d object = points.world[i];
    int steps = 0;
    for (; (object - points.object[i]).norm() > reached; ++steps) {
      if (steps == most_steps) return std::nullopt;
      object = points.world[i] - (lattice(object) - object);
    }
    most = std::max(most, steps);
  }
  return most;
}

std::vector<Record> records(const Experiment& experiment, const Options& options) {
  std::vector<Record> result;
  const LatticeBox box = box_of(options);
  for (std::size_t placement = 0; placement < placement_names.size(); ++placement) {
    const Lattice lattice(box, cells_of(options),
                          undisplaced_points(box, cells_of(options), static_cast<Placement>(placement)));
    const Points points(options, experiment.seed, lattice);
    Record record{.part = "undisplaced", .kind = placement_names[placement]};
    Errors errors;
    for (std::size_t i = 0; i < points.object.size(); ++i) errors.add((points.world[i] - points.object[i]).norm());
    errors.write(record);
    record.displacement = record.residual_max;
    result.push_back(record);
  }
  for (const Kind& kind : kinds) {
    std::vector<double> before;  // the largest residuals at the amplitude before, by method
    double amplitude_before = 0;
    for (const double amplitude : options.amplitudes) {
      auto moved = undisplaced_points(box, cells_of(options), Placement::greville);
      displace(box, cells_of(options), {kind.of_amplitude(amplitude)}, moved);
      const Lattice lattice(box, cells_of(options), std::move(moved));
      const Points points(options, experiment.seed, lattice);
      std::vector<double> now;
      const auto add = [&](std::string method, const auto& inverse, std::optional<double> evaluations) {
        Record record{.part = "inverse", .kind = kind.name, .amplitude = amplitude, .method = std::move(method)};
        record.displacement = points.displacement;
        record.evaluations = evaluations;
        Errors errors;
        for (std::size_t i = 0; i < points.object.size(); ++i)
          errors.add((inverse(points.world[i], record) - points.object[i]).norm());
        errors.write(record);
        if (before.size() > now.size() && record.residual_max > 0)
          record.order = std::log(before[now.size()] / record.residual_max) / std::log(amplitude_before / amplitude);
        now.push_back(record.residual_max);
        result.push_back(record);
      };
      add(
          "printed", [&](const Eigen::Vector3d& world, Record& /*record*/) { return printed_inverse(lattice, world); },
          1);
      for (int steps = 2; steps <= options.steps; ++steps)
        add(
            fmt::format("fixed_point_{}", steps),
            [&](const Eigen::Vector3d& world, Record& /*record*/) {
              return fixed_point_inverse(lattice, world, steps);
            },
            steps);
      add(
          "newton",
          [&](const Eigen::Vector3d& world, Record& record) {
            const CertifiedInverse found = newton_inverse(lattice, world, printed_inverse(lattice, world));
            record.radius = std::max(record.radius.value_or(0), found.radius);
            record.evaluations = std::max(record.evaluations.value_or(0), static_cast<double>(found.evaluations));
            return found.object;
          },
          std::nullopt);
      result.back().order.reset();  // it is rounding
      Record steps{.part = "steps", .kind = kind.name, .amplitude = amplitude, .method = "fixed_point"};
      steps.displacement = points.displacement;
      steps.evaluations = steps_to_the_fixed_point(lattice, points);
      result.push_back(steps);
      before = std::move(now);
      amplitude_before = amplitude;
    }
  }
  return result;
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  const auto of_inverse = [](double Record::*member) {
    return [member](const Record& record) {
      return record.part == "steps" ? std::nullopt : std::optional(record.*member);
    };
  };
  return {
      {.name = "part",
       .description =
           "inverse: residuals of a method; steps: how many the fixed point takes at the worst point to come "
           "within 10^-6 of a voxel (evaluations; null: more than 60); undisplaced: by how much a lattice moves "
           "the object whose points have not been moved",
       .is_key = true,
       .cell = &Record::part},
      {.name = "displacement",
       .description = "kind; of undisplaced lattices where their points lie",
       .is_key = true,
       .cell = &Record::kind},
      {.name = "amplitude",
       .description = "twist and bend: of 90 degrees; taper: 1 to 1 minus it; bulge: its amount; random: of a cell",
       .is_key = true,
       .cell = &Record::amplitude},
      {.name = "method",
       .description =
           "printed: 2 P - F(P); fixed_point_k: Q <- P - u(Q), k times; newton: to rounding, from the printed "
           "one, with a certificate",
       .is_key = true,
       .cell = [](const Record& record) -> Value { return record.method.empty() ? Value() : Value(record.method); }},
      {.name = "displacement_max", .unit = "voxel", .description = "largest", .cell = &Record::displacement},
      {.name = "residual_max",
       .unit = "voxel",
       .description = "largest distance from the point of the object that was mapped",
       .cell = of_inverse(&Record::residual_max)},
      {.name = "residual_rms",
       .unit = "voxel",
       .description = "root mean square",
       .cell = of_inverse(&Record::residual_rms)},
      {.name = "order",
       .description = "in the amplitude: of the largest residual, from the amplitude before",
       .cell = &Record::order},
      {.name = "evaluations", .description = "of F, at most", .cell = &Record::evaluations},
      {.name = "radius",
       .unit = "voxel",
       .description = "largest certified bound of the residual",
       .cell = &Record::radius},
  };
}

}  // namespace

extern const Measure inverse_deformation_measure;
const Measure inverse_deformation_measure{
    MeasureDefinition<Options, Record>{.name = "inverse_deformation",
                                       .summary = "what inverses of a free-form deformation are off by",
                                       .read = read_options,
                                       .columns = columns,
                                       .of_experiment = records}};

}  // namespace raytruth
