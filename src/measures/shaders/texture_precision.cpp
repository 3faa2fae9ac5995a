#include "experiments/measure.hpp"
#include "raytruth/catalogue.hpp"
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

/// The same by a shader.
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

/// Rows of one texture: by the CPU and by a shader, in all formats, by all weights.
template <std::size_t FormatCount>
void add_rows(std::vector<Row>& rows, const Row& keys, const LookUps& what,
              const std::array<TexelFormat, FormatCount>& formats, const std::vector<int>& weight_bits,
              GlDevice& device) {
  const std::vector<double> exact = look_up<double>(what, what.texture, 0);
  for (const TexelFormat format : formats) {
    const Texture stored = what.texture.stored(format);
    for (const int bits : weight_bits) {
      const double bound = error_bound(stored, format, bits);
      const std::vector<double> by_cpu = look_up<Binary32>(what, stored, bits);
      const auto add = [&](const char* unit, bool has_these_weights, const std::vector<double>& values) {
        const bool is_cpu = &values == &by_cpu;
        const Deviation error = deviation(values, exact);
        const Deviation difference = deviation(values, by_cpu);
        Row& row = rows.emplace_back(keys);
        row.insert(row.end(), {{"format", std::string(facts(format).name)},
                               {"unit", unit},
                               {"weight_bits", bits > 0 ? Value(std::int64_t{bits}) : Value()},
                               {"look_ups", static_cast<std::int64_t>(what.count())},
                               {"error_max", error.largest},
                               {"error_rms", error.rms},
                               {"error_mean", error.mean},
                               {"bound", has_these_weights ? Value(bound) : Value()},
                               {"share_of_bound", has_these_weights ? Value(error.largest / bound) : Value()},
                               {"difference_max", is_cpu ? Value() : Value(difference.largest)},
                               {"difference_rms", is_cpu ? Value() : Value(difference.rms)}});
      };
      add("cpu", true, by_cpu);
      add("glsl_emulation", true, look_up(device, what, format, {.is_emulated = true, .weight_bits = bits}));
      if (bits == 0) add("glsl_sampler", false, look_up(device, what, format, {}));
    }
  }
}

std::vector<Column> look_up_columns() {
  return {
      {.name = "texture",
       .unit = "",
       .description = "transfer_1d: colour and extinction, over its largest, by the scalar; table_2d: colour and "
                      "opacity of a slab of length 1 by its front and back scalar; volume_3d: a field",
       .is_key = true},
      {.name = "shape", .unit = "", .description = "of the transfer function in the texture", .is_key = true},
      {.name = "format", .unit = "", .description = "OpenGL's name of the texels' format", .is_key = true},
      {.name = "unit",
       .unit = "",
       .description = "cpu: TextureUnit in binary32; glsl_emulation: the same in a shader; glsl_sampler: the device's "
                      "own filter, whose weights it does not tell",
       .is_key = true},
      {.name = "weight_bits",
       .unit = "bit",
       .description = "k, weights being multiples of 2^-k; null: as exact as a float, or unknown",
       .is_key = true},
      {.name = "look_ups", .unit = "", .description = "number of places"},
      {.name = "error_max",
       .unit = "of 1, the largest texel",
       .description = "largest error over places and channels, against exact filtering of binary32 texels at the same "
                      "coordinates, which are binary32 too"},
      {.name = "error_rms", .unit = "of 1, the largest texel", .description = "root mean square of the error"},
      {.name = "error_mean", .unit = "of 1, the largest texel", .description = "mean error, signed"},
      {.name = "bound",
       .unit = "of 1, the largest texel",
       .description = "what no error may exceed: half a step of the format, and on every axis half a level of the "
                      "weights times the largest difference of neighbours, and rounding"},
      {.name = "share_of_bound", .unit = "", .description = "error_max over bound"},
      {.name = "difference_max",
       .unit = "of 1, the largest texel",
       .description = "largest difference from the CPU in binary32, same format and bits"},
      {.name = "difference_rms", .unit = "of 1, the largest texel", .description = "root mean square of it"},
  };
}

struct TableOptions {
  std::vector<std::string> shapes;
  double optical_depth = 0;  ///< of a slab of length 1, at most
  std::int64_t transfer_entries = 0;
  std::int64_t table_entries = 0;
  std::int64_t look_ups = 0;
  std::vector<int> weight_bits;
};

TableOptions read_table_options(const JsonReader& json) {
  json.only({"kind", "shapes", "optical_depth", "transfer_entries", "table_entries", "look_ups", "weight_bits"});
  std::vector<std::string_view> shapes;
  for (const auto& transfer : catalogue::transfers)
    if (transfer.make != nullptr) shapes.push_back(transfer.name);
  TableOptions options{.shapes = {},
                       .optical_depth = json.at("optical_depth").number(0, largest_depth),
                       .transfer_entries = json.at("transfer_entries").integer(2, most_entries),
                       .table_entries = json.at("table_entries").integer(2, most_entries),
                       .look_ups = json.at("look_ups").integer(1, most_look_ups),
                       .weight_bits = read_weight_bits(json)};
  for (const JsonReader& shape : json.at("shapes").items()) options.shapes.push_back(shape.word(shapes));
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

std::vector<int> read_volume_options(const JsonReader& json) {
  json.only({"kind", "weight_bits"});
  return read_weight_bits(json);
}

}  // namespace

std::vector<Column> table_texture_precision_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_table_options(options);
  return look_up_columns();
}

std::vector<Row> table_texture_precision_rows(const Experiment& experiment, const JsonReader& options,
                                              const Field& /*field*/) {
  const TableOptions asked = read_table_options(options);
  const auto device = open_gl(experiment.gl);
  std::vector<Row> rows;
  for (const std::string& shape : asked.shapes) {
    const auto& entry = *std::find_if(catalogue::transfers.begin(), catalogue::transfers.end(),
                                      [&shape](const auto& transfer) { return transfer.name == shape; });
    const PiecewiseLinear transfer = entry.make(asked.optical_depth, experiment.seed);
    const auto add = [&](const char* name, Texture texture) {
      LookUps what{.texture = std::move(texture), .coordinates = {}};
      what.coordinates = random_coordinates(what.texture, asked.look_ups, experiment.seed);
      add_rows(rows, {{"texture", name}, {"shape", shape}}, what, color_formats, asked.weight_bits, *device);
    };
    add("transfer_1d", transfer_texture(transfer, asked.optical_depth, asked.transfer_entries));
    add("table_2d", slab_texture(transfer, asked.table_entries));
  }
  return rows;
}

std::vector<Column> volume_texture_precision_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_volume_options(options);
  return look_up_columns();
}

std::vector<Row> volume_texture_precision_rows(const Experiment& experiment, const JsonReader& options,
                                               const Field& field) {
  const std::vector<int> weight_bits = read_volume_options(options);
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
  std::vector<Row> rows;
  add_rows(rows, {{"texture", "volume_3d"}}, what, scalar_formats, weight_bits, *device);
  return rows;
}

}  // namespace raytruth
