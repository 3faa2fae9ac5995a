#include "experiments/measure.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/gl/texture_look_ups.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/signals/ray_ensemble.hpp"
#include "raytruth/textures/texture_unit.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raytruth {

namespace {

constexpr int most_weight_bits = 16;
constexpr std::int64_t most_entries = 4096;
constexpr std::int64_t most_look_ups = 100'000'000;
constexpr double largest_depth = 1e6;

constexpr std::array scalar_formats{TexelFormat::r8, TexelFormat::r16, TexelFormat::r16f, TexelFormat::r32f};
constexpr std::array color_formats{TexelFormat::rgba8, TexelFormat::rgba16, TexelFormat::rgba16f, TexelFormat::rgba32f};

std::vector<int> read_weight_bits(const JsonReader& json) {
  std::vector<int> bits{0};  // exact weights first
  for (const JsonReader& item : json.at("weight_bits").items())
    bits.push_back(static_cast<int>(item.integer(1, most_weight_bits)));
  return bits;
}

/// A texture and where it is looked up.
struct LookUps {
  Texture texture;
  std::vector<float> coordinates;

  [[nodiscard]] std::size_t count() const { return coordinates.size() / texture.dimensions; }
};

/// What a texture unit finds, the texture's channels of a look-up side by side.
template <class Real>
std::vector<double> look_up(const LookUps& what, const Texture& texture, int weight_bits) {
  const TextureUnit<Real> unit(texture, weight_bits);
  std::vector<double> values(what.count() * texture.channels);
  tbb::parallel_for(std::size_t{0}, what.count(), [&](std::size_t i) {
    typename TextureUnit<Real>::Coordinate coordinate{};
    for (std::size_t axis = 0; axis < texture.dimensions; ++axis)
      coordinate[axis] = Real(static_cast<double>(what.coordinates[i * texture.dimensions + axis]));
    const auto value = unit.linear(coordinate);
    for (std::size_t channel = 0; channel < texture.channels; ++channel)
      values[i * texture.channels + channel] = to_double(value[static_cast<Eigen::Index>(channel)]);
  });
  return values;
}

/// These look-ups by a shader.
std::vector<double> look_up(GlDevice& device, const LookUps& what, TexelFormat format, const ShaderFilter& filter) {
  const std::vector<float> found = look_up_in_shader(device, what.texture, format, what.coordinates, filter);
  const std::size_t channels = what.texture.channels;
  std::vector<double> values(what.count() * channels);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(found[4 * (i / channels) + i % channels]);
  return values;
}

/// The largest difference of two neighbouring texels along an axis.
double largest_step(const Texture& texture, std::size_t axis) {
  std::size_t stride = texture.channels;
  for (std::size_t before = 0; before < axis; ++before) stride *= static_cast<std::size_t>(texture.size[before]);
  const auto side = static_cast<std::size_t>(texture.size[axis]);
  double largest = 0;
  for (std::size_t i = 0; i + stride < texture.texels.size(); ++i)
    if (i / stride % side + 1 < side)
      largest = std::max(
          largest, std::abs(static_cast<double>(texture.texels[i + stride]) - static_cast<double>(texture.texels[i])));
  return largest;
}

/// What no look-up may be off by, in binary32: on every axis half a level of the weight and the rounding of the
/// position of the difference of two texels; half a step of the format; and three roundings for each weighted sum of
/// numbers up to 1.
double error_bound(const Texture& stored, TexelFormat format, int weight_bits) {
  constexpr double rounding = 0x1p-24;
  double bound = largest_texel_error(facts(format).type);
  for (std::size_t axis = 0; axis < stored.dimensions; ++axis) {
    const double half_level = weight_bits > 0 ? std::ldexp(0.5, -weight_bits) : 0;
    const double position = static_cast<double>(stored.size[axis]) * rounding;
    bound += (half_level + 2 * position) * largest_step(stored, axis) + 3 * rounding;
  }
  return bound;
}

struct Deviation {
  double largest = 0;
  double rms = 0;
  double mean = 0;
};

Deviation deviation(const std::vector<double>& values, const std::vector<double>& from) {
  Deviation result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = values[i] - from[i];
    result.largest = std::max(result.largest, std::abs(difference));
    result.rms += difference * difference;
    result.mean += difference;
  }
  result.rms = std::sqrt(result.rms / static_cast<double>(values.size()));
  result.mean /= static_cast<double>(values.size());
  return result;
}

/// Look-ups of a texture in a format, by weights of so many bits.
struct Record {
  std::string texture;
  std::optional<std::string> shape;  ///< of the transfer function in it, if any
  TexelFormat format;
  std::string unit;
  int weight_bits;  ///< 0: exact
  std::size_t look_ups;
  Deviation error;                      ///< from exact filtering
  std::optional<double> bound;          ///< none where the weights are not known
  std::optional<Deviation> difference;  ///< from the CPU; none of itself
};

/// Adds the look-ups of one texture: by the CPU and by a shader, in all formats, by all weights.
template <std::size_t FormatCount>
void add_records(std::vector<Record>& records, const std::string& name, const std::optional<std::string>& shape,
                 const LookUps& what, const std::array<TexelFormat, FormatCount>& formats,
                 const std::vector<int>& weight_bits, GlDevice& device) {
  const std::vector<double> exact = look_up<double>(what, what.texture, 0);
  for (const TexelFormat format : formats) {
    const Texture stored = what.texture.stored(format);
    for (const int bits : weight_bits) {
      const std::vector<double> by_cpu = look_up<Binary32>(what, stored, bits);
      const auto add = [&](const char* unit, std::optional<double> bound, const std::vector<double>& values) {
        records.push_back({.texture = name,
                           .shape = shape,
                           .format = format,
                           .unit = unit,
                           .weight_bits = bits,
                           .look_ups = what.count(),
                           .error = deviation(values, exact),
                           .bound = bound,
                           .difference = &values == &by_cpu ? std::nullopt : std::optional(deviation(values, by_cpu))});
      };
      const double bound = error_bound(stored, format, bits);
      add("cpu", bound, by_cpu);
      add("glsl_emulation", bound, look_up(device, what, format, {.is_emulated = true, .weight_bits = bits}));
      if (bits == 0) add("glsl_sampler", {}, look_up(device, what, format, {}));
    }
  }
}

std::optional<double> share_of_bound(const Record& record) {
  if (!record.bound) return std::nullopt;
  return record.error.largest / *record.bound;
}

/// The cell of the difference from the CPU.
CellOf<Record> of_difference(double Deviation::*number) {
  return [number](const Record& record) {
    return record.difference ? std::optional(*record.difference.*number) : std::nullopt;
  };
}

Columns<Record> look_up_columns() {
  return {
      {.name = "texture",
       .description = "transfer_1d: colour and extinction, over its largest, by the scalar; table_2d: colour and "
                      "opacity of a slab of length 1 by its front and back scalar; volume_3d: a field",
       .is_key = true,
       .cell = &Record::texture},
      {.name = "shape",
       .description = "of the transfer function in the texture",
       .is_key = true,
       .cell = [](const Record& record) { return cell_if(record.shape.has_value(), record.shape); }},
      {.name = "format",
       .description = "OpenGL's name of the texels' format",
       .is_key = true,
       .cell = [](const Record& record) { return facts(record.format).name; }},
      {.name = "unit",
       .description = "cpu: TextureUnit in binary32; glsl_emulation: the same in a shader; glsl_sampler: the device's "
                      "own filter, whose weights it does not tell",
       .is_key = true,
       .cell = &Record::unit},
      {.name = "weight_bits",
       .unit = "bit",
       .description = "k, weights being multiples of 2^-k; null: as exact as a float, or unknown",
       .is_key = true,
       .cell =
           [](const Record& record) {
             return record.weight_bits > 0 ? std::optional(record.weight_bits) : std::nullopt;
           }},
      {.name = "look_ups", .description = "number of places", .cell = &Record::look_ups},
      {.name = "error_max",
       .unit = "of 1, the largest texel",
       .description = "largest error over places and channels, against exact filtering of binary32 texels at the same "
                      "coordinates, which are binary32 too",
       .cell = [](const Record& record) { return record.error.largest; }},
      {.name = "error_rms",
       .unit = "of 1, the largest texel",
       .description = "root mean square of the error",
       .cell = [](const Record& record) { return record.error.rms; }},
      {.name = "error_mean",
       .unit = "of 1, the largest texel",
       .description = "mean error, signed",
       .cell = [](const Record& record) { return record.error.mean; }},
      {.name = "bound",
       .unit = "of 1, the largest texel",
       .description = "what no error may exceed: half a step of the format, and on every axis half a level of the "
                      "weights times the largest difference of neighbours, and rounding",
       .cell = &Record::bound},
      {.name = "share_of_bound", .description = "error_max over bound", .cell = share_of_bound},
      {.name = "difference_max",
       .unit = "of 1, the largest texel",
       .description = "largest difference from the CPU in binary32, same format and bits",
       .cell = of_difference(&Deviation::largest)},
      {.name = "difference_rms",
       .unit = "of 1, the largest texel",
       .description = "root mean square of it",
       .cell = of_difference(&Deviation::rms)},
  };
}

// --- Transfer functions and tables ---

struct TableOptions {
  std::vector<std::string> shapes;
  double optical_depth = 0;  ///< of a slab of length 1, at most
  std::int64_t transfer_entries = 0;
  std::int64_t table_entries = 0;
  std::int64_t look_ups = 0;
  std::vector<int> weight_bits;
};

TableOptions read_table_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depth", "transfer_entries", "table_entries", "look_ups", "weight_bits"});
  TableOptions options{.shapes = {},
                       .optical_depth = json.at("optical_depth").number(0, largest_depth),
                       .transfer_entries = json.at("transfer_entries").integer(2, most_entries),
                       .table_entries = json.at("table_entries").integer(2, most_entries),
                       .look_ups = json.at("look_ups").integer(1, most_look_ups),
                       .weight_bits = read_weight_bits(json)};
  for (const JsonReader& shape : json.at("shapes").items()) options.shapes.push_back(read_shape(shape));
  return options;
}

/// The scalar of a table's entry.
double scalar_of(std::int64_t entry, std::int64_t entries) {
  return static_cast<double>(entry) / static_cast<double>(entries - 1);
}

/// Random scalars, as many for each look-up as the texture has dimensions, looked up so that entry i stands for
/// `scalar_of(i)`.
std::vector<float> random_coordinates(const Texture& texture, std::int64_t look_ups, std::uint64_t seed) {
  std::vector<float> coordinates;
  const auto entries = static_cast<double>(texture.size[0]);
  for (std::int64_t i = 0; i < look_ups; ++i) {
    const auto scalars = random_numbers(seed, RandomStream::points, static_cast<std::uint64_t>(i));
    for (std::size_t axis = 0; axis < texture.dimensions; ++axis)
      coordinates.push_back(static_cast<float>((scalars[axis] * (entries - 1) + 0.5) / entries));
  }
  return coordinates;
}

void add_texel(Texture& texture, const Vector3<double>& color, double last) {
  for (const double channel : color) texture.texels.push_back(static_cast<float>(channel));
  texture.texels.push_back(static_cast<float>(last));
}

Texture transfer_texture(const PiecewiseLinear& transfer, double largest_extinction, std::int64_t entries) {
  Texture texture{.size = {entries, 1, 1}, .dimensions = 1, .channels = 4};
  for (std::int64_t entry = 0; entry < entries; ++entry) {
    const Optics optics = transfer.at(scalar_of(entry, entries));
    add_texel(texture, optics.color, largest_extinction > 0 ? optics.extinction / largest_extinction : 0);
  }
  return texture;
}

/// The pre-integration table itself: linear slabs of length 1, certified; the front scalar along x, the back one along
/// y.
Texture slab_texture(const PiecewiseLinear& transfer, std::int64_t entries) {
  Texture texture{.size = {entries, entries, 1}, .dimensions = 2, .channels = 4};
  RayIntegral integrate(transfer, Emission::associated);
  Chain<3> slab{.pieces = {{.start = {}, .length = 1, .polynomial = {}}}, .end = 1.0};
  for (std::int64_t back = 0; back < entries; ++back)
    for (std::int64_t front = 0; front < entries; ++front) {
      Rules<double> rules;
      slab.pieces[0].polynomial =
          Rules<double>::cubic(rules.order1(scalar_of(front, entries), scalar_of(back, entries)));
      const Certified truth = integrate(slab);
      add_texel(texture, truth.color, truth.opacity);
    }
  return texture;
}

Columns<Record> table_columns(const Experiment& /*experiment*/, const TableOptions& /*options*/) {
  return look_up_columns();
}

std::vector<Record> table_records(const Experiment& experiment, const TableOptions& options) {
  const auto device = open_gl(experiment.gl);
  std::vector<Record> records;
  for (const std::string& shape : options.shapes) {
    const PiecewiseLinear transfer = TableStudy::transfer(shape, options.optical_depth, experiment.seed);
    const auto add = [&](const char* name, Texture texture) {
      LookUps what{.texture = std::move(texture), .coordinates = {}};
      what.coordinates = random_coordinates(what.texture, options.look_ups, experiment.seed);
      add_records(records, name, shape, what, color_formats, options.weight_bits, *device);
    };
    add("transfer_1d", transfer_texture(transfer, options.optical_depth, options.transfer_entries));
    add("table_2d", slab_texture(transfer, options.table_entries));
  }
  return records;
}

// --- Volumes ---

struct VolumeOptions {
  std::vector<int> weight_bits;
};

VolumeOptions read_volume_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "weight_bits"});
  return {.weight_bits = read_weight_bits(json)};
}

Columns<Record> volume_columns(const Experiment& /*experiment*/, const VolumeOptions& /*options*/) {
  return look_up_columns();
}

std::vector<Record> volume_records(const Experiment& experiment, const VolumeOptions& options, const Field& field) {
  const auto device = open_gl(experiment.gl);
  LookUps what{.texture = {.size = field.grid.size, .dimensions = 3, .channels = 1}, .coordinates = {}};
  for (const double value : field.grid.values) what.texture.texels.push_back(static_cast<float>(value));
  // At every unit of length along the rays.
  const auto steps = static_cast<std::int64_t>(experiment.rays.length);
  for (std::int64_t ray = 0; ray < experiment.rays.count; ++ray) {
    const auto [origin, direction, length] =
        random_ray(field.grid, experiment.rays.length, experiment.seed, static_cast<std::uint64_t>(ray));
    for (std::int64_t t = 0; t <= steps; ++t)
      for (std::size_t axis = 0; axis < 3; ++axis)
        what.coordinates.push_back(static_cast<float>((origin[axis] + static_cast<double>(t) * direction[axis] + 0.5) /
                                                      static_cast<double>(field.grid.size[axis])));
  }
  std::vector<Record> records;
  add_records(records, "volume_3d", {}, what, scalar_formats, options.weight_bits, *device);
  return records;
}

}  // namespace

extern const Measure table_texture_precision_measure;
const Measure table_texture_precision_measure{MeasureDefinition<TableOptions, Record>{
    .name = "table_texture_precision",
    .summary = "look-ups of transfer functions and tables, by weights and formats of texels",
    .uses_gl = true,
    .read = read_table_options,
    .columns = table_columns,
    .of_experiment = table_records}};

extern const Measure volume_texture_precision_measure;
const Measure volume_texture_precision_measure{
    MeasureDefinition<VolumeOptions, Record>{.name = "volume_texture_precision",
                                             .summary = "look-ups of volumes, by weights and formats of texels",
                                             .uses_gl = true,
                                             .read = read_volume_options,
                                             .columns = volume_columns,
                                             .of_field = volume_records}};

}  // namespace raytruth
