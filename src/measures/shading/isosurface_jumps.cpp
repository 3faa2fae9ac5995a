#include "experiments/measure.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/schemes/surface_march.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/tables/lit/isoslab_table.hpp"

#include <boost/math/constants/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

/// How far to either side of a place the light is taken, in steps.
constexpr double aside = 1e-9;

/// The scalar has no more slabs to cross where the state of a method that lags behind moves on.
constexpr double plateau = 3;

struct Options {
  std::vector<std::int64_t> counts;
  double opacity = 0;
  double degrees = 0;
  double tolerance = 0;
  std::int64_t phases = 0;
  std::size_t table_size = 0;
  double table_width = 0;
  std::vector<std::string> shadings;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "counts", "opacity", "degrees", "tolerance", "phases", "isoslab", "shadings"});
  Options options;
  for (const JsonReader& count : json.at("counts").items()) options.counts.push_back(count.integer(1, 64));
  options.opacity = json.at("opacity").number(0x1p-20, 1 - 0x1p-20);
  options.degrees = json.at("degrees").number(1, 90);
  options.tolerance = json.at("tolerance").number(0, 1);
  options.phases = json.at("phases").integer(1, 65536);
  const JsonReader isoslab = json.at("isoslab");
  isoslab.only({"size", "width"});
  options.table_size =
      static_cast<std::size_t>(isoslab.at("size").integer(2, static_cast<std::int64_t>(MomentTable::largest_size)));
  options.table_width = isoslab.at("width").positive_number();
  for (const JsonReader& shading : json.at("shadings").items()) {
    options.shadings.push_back(shading.word(names_of(catalogue::shadings())));
    if (!MomentTable::takes(*find_named(catalogue::shadings(), options.shadings.back())))
      shading.refuse_value("a method whose light depends on the normals at both ends of a slab only");
  }
  return options;
}

/// White isosurfaces at the scalars (i + 1/2) / n, their normals turning in a plane with the light, at the first one
/// towards it, by so many degrees a unit of the scalar, and no farther than 90. A ray along which the scalar rises by 1
/// in each step of 1, from -1 and the phase, until all is passed: as the phase moves, crossings pass samples.
class Staircase {
 public:
  Staircase(std::int64_t count, const Options& options) : count_(count), degrees_(options.degrees) {
    for (std::int64_t i = 0; i < count; ++i)
      surfaces_.push_back(
          {.s = (static_cast<double>(i) + 0.5) / static_cast<double>(count), .opacity = options.opacity});
  }

  [[nodiscard]] const std::vector<Isosurface>& surfaces() const { return surfaces_; }

  /// Long enough for a method that moves by one surface in a step.
  [[nodiscard]] Chain<3> signal(double phase) const {
    Chain<3> chain;
    const auto add = [&chain](double from, double to, double length) {
      chain.pieces.push_back({chain.end, length, {{from, from + (to - from) / 3, from + 2 * (to - from) / 3, to}}});
      chain.end += DoubleDouble(length);
    };
    add(phase - 1, phase - 1 + plateau, plateau);
    add(phase - 1 + plateau, phase - 1 + plateau, static_cast<double>(count_));
    return chain;
  }

  /// The normal where the scalar is s; the light comes from z.
  [[nodiscard]] Vector3<double> normal_at(double s) const {
    const double degrees = std::clamp(degrees_ * (s - surfaces_.front().s), -90.0, 90.0);
    const double angle = degrees * boost::math::constants::pi<double>() / 180;
    return {std::sin(angle), 0, std::cos(angle)};
  }

 private:
  std::int64_t count_;
  double degrees_;
  std::vector<Isosurface> surfaces_;
};

/// A way to light the surfaces of a ray.
class Method {
 public:
  /// `shading`: of isoslabs; null else.
  Method(const SurfaceScheme& scheme, const Shading* shading, const Staircase& stairs, const Options& options,
         std::shared_ptr<const IsoslabTable> table)
      : scheme_(&scheme),
        shading_(shading),
        stairs_(&stairs),
        tolerance_(options.tolerance),
        table_(std::move(table)),
        march_(PiecewiseLinear(std::vector<TransferPoint>(1)), Emission::associated, stairs.surfaces()) {}

  /// The light at a phase, of a channel.
  double operator()(double phase) {
    const Chain<3> signal = stairs_->signal(phase);
    sample_constant(signal, 1.0, samples_);
    const auto normal_at = [&](double t) { return stairs_->normal_at(signal.value(DoubleDouble(t))); };
    if (table_ == nullptr) {
      const auto color_of = [&](const SampledHit& hit) -> Vector3<double> {
        const Vector3<double> normal = normal_of(*scheme_, hit, samples_, normal_at);
        return Vector3<double>::Constant(Illumination(lighting_).diffuse(normal[2]));
      };
      return march_(*scheme_, signal, samples_, tolerance_, color_of).color[0];
    }
    const auto light_of = [&](double begin, double end) {
      const ShadedSlab slab{.front_normal = normal_at(begin), .back_normal = normal_at(end)};
      SlabShader shader = shading_->shader(cosines_of(slab, lighting_), lighting_);
      const LightModel model(lighting_, std::nullopt, shader.specular_density);
      return SlabLight{std::move(shader), model};
    };
    return isoslab_light(*table_, samples_, light_of).color[0];
  }

 private:
  const SurfaceScheme* scheme_;
  const Shading* shading_;
  const Staircase* stairs_;
  double tolerance_;
  Lighting lighting_;
  std::shared_ptr<const IsoslabTable> table_;
  SurfaceMarch march_;
  Samples<double> samples_;
};

struct Record {
  std::string method;
  std::optional<std::string> shading;
  std::int64_t surfaces = 0;
  double jump_last = 0;
  double jump_max = 0;
  double change_max = 0;
  double light_min = 0;
  double light_max = 0;
};

Columns<Record> columns(const Experiment& /*experiment*/, const Options& options) {
  return {{.name = "method", .description = "of `raytruth list surfaces`", .is_key = true, .cell = &Record::method},
          {.name = "shading",
           .description = "of isoslabs, of `raytruth list shadings`; null of others",
           .is_key = true,
           .cell = &Record::shading},
          {.name = "surfaces",
           .description = "white isosurfaces, equally far apart, as many as a step of 1 can pass",
           .is_key = true,
           .cell = &Record::surfaces},
          {.name = "jump_last",
           .unit = "of white",
           .description = "difference of the one-sided limits of the light as the last crossing passes a sample; of "
                          "two surfaces the case of Lum's figure 2",
           .cell = &Record::jump_last},
          {.name = "jump_max",
           .unit = "of white",
           .description = "the largest of these differences, over all phases of the samples at which something passes "
                          "one of them: a surface, an end of its slab, or of the threshold",
           .cell = &Record::jump_max},
          {.name = "change_max",
           .unit = "of white",
           .description =
               "largest change of the light as the phase moves by 1/" + std::to_string(options.phases) + " of a step",
           .cell = &Record::change_max},
          {.name = "light_min",
           .unit = "of white",
           .description = "the least light, over as many phases",
           .cell = &Record::light_min},
          {.name = "light_max", .unit = "of white", .description = "the most", .cell = &Record::light_max}};
}

/// Phases in (0, 1) at which a scalar passes a sample.
void add_phase(double scalar, std::vector<double>& phases) {
  const double phase = scalar - std::floor(scalar);
  if (phase > aside && phase < 1 - aside) phases.push_back(phase);
}

Record record_of(Method& method, const Staircase& stairs, double slab_width, const Options& options) {
  Record record;
  record.surfaces = std::ssize(stairs.surfaces());
  const auto jump_at = [&](double phase) { return std::abs(method(phase + aside) - method(phase - aside)); };
  std::vector<double> phases;
  for (const Isosurface& surface : stairs.surfaces())
    for (const double beside : {0.0, slab_width / 2, -slab_width / 2, options.tolerance, -options.tolerance})
      add_phase(surface.s + beside, phases);
  for (const double phase : phases) record.jump_max = std::max(record.jump_max, jump_at(phase));
  record.jump_last = jump_at(stairs.surfaces().back().s);
  double before = record.light_min = record.light_max = method(0);
  for (std::int64_t i = 1; i < options.phases; ++i) {
    const double here = method(static_cast<double>(i) / static_cast<double>(options.phases));
    record.change_max = std::max(record.change_max, std::abs(here - before));
    record.light_min = std::min(record.light_min, here);
    record.light_max = std::max(record.light_max, here);
    before = here;
  }
  return record;
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const std::int64_t count : options.counts) {
    const Staircase stairs(count, options);
    const TableAxes axes{.size = options.table_size, .low = -1, .high = plateau, .length = 1};
    const double slab_width = options.table_width * (axes.high - axes.low) / static_cast<double>(axes.size - 1);
    for (const SurfaceScheme& scheme : catalogue::surface_schemes()) {
      const auto add = [&](const Shading* shading, const std::shared_ptr<const IsoslabTable>& table) {
        Method method(scheme, shading, stairs, options, table);
        records.push_back(record_of(method, stairs, slab_width, options));
        records.back().method = scheme.name;
        if (shading != nullptr) records.back().shading = shading->name;
      };
      if (!scheme.isoslab) {
        add(nullptr, nullptr);
        continue;
      }
      const auto table = std::make_shared<const IsoslabTable>(
          stairs.surfaces(), *scheme.isoslab, Isoslab{.size = axes.size, .width = options.table_width, .slope = 1},
          axes);
      for (const std::string& shading : options.shadings) add(find_named(catalogue::shadings(), shading), table);
    }
  }
  return records;
}

}  // namespace

extern const Measure isosurface_jumps_measure;
const Measure isosurface_jumps_measure{MeasureDefinition<Options, Record>{
    .name = "isosurface_jumps",
    .summary = "jumps of the light of several isosurfaces as they pass from one slab to the next",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
