#include "experiments/measure.hpp"
#include "measures/images/grid_view.hpp"
#include "measures/tables/table_study.hpp"
#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/gl/hand_written_renderer.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/render/pixels.hpp"
#include "raytruth/render/techniques/textured_march.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

constexpr std::int64_t most_entries = 4096;
constexpr std::int64_t most_weight_bits = 16;
constexpr double largest_extinction = 1e6;

struct Options {
  std::vector<std::string> shapes;
  double extinction = 0;
  std::int64_t entries = 0;
  double step = 0;
  int weight_bits = 0;
  std::vector<GridView> views;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "shapes", "extinction", "entries", "step", "weight_bits", "size", "views"});
  Options options{.shapes = {},
                  .extinction = json.at("extinction").number(0, largest_extinction),
                  .entries = json.at("entries").integer(2, most_entries),
                  .step = json.at("step").number(0x1p-10, 1024),
                  .weight_bits = static_cast<int>(json.at("weight_bits").integer(1, most_weight_bits)),
                  .views = {}};
  for (const JsonReader& shape : json.at("shapes").items()) options.shapes.push_back(read_shape(shape));
  const auto size = read_image_size(json.at("size"));
  for (const JsonReader& view : json.at("views").items()) options.views.push_back(read_grid_view(view, size));
  return options;
}

// What the scene's textures hold, numbers rounded to binary32, so that everybody draws the same.

PiecewiseLinear drawn_transfer(const TexturedScene& scene) {
  std::vector<TransferPoint> points;
  const auto entries = static_cast<std::size_t>(scene.transfer.size[0]);
  const auto& texels = scene.transfer.texels;
  for (std::size_t i = 0; i < entries; ++i)
    points.push_back({static_cast<double>(i) / static_cast<double>(entries - 1),
                      {static_cast<double>(texels[4 * i + 3]),
                       {static_cast<double>(texels[4 * i]), static_cast<double>(texels[4 * i + 1]),
                        static_cast<double>(texels[4 * i + 2])}}});
  return PiecewiseLinear(std::move(points));
}

Grid drawn_grid(const Grid& grid, const TexturedScene& scene) {
  Grid drawn = grid;
  drawn.values.assign(scene.volume.texels.begin(), scene.volume.texels.end());
  return drawn;
}

/// One scene, drawn in every way.
struct Images {
  explicit Images(const std::array<std::int64_t, 2>& size)
      : certified(size), binary64(size), binary32(size), textures(size), rounded_weights(size), glsl(size) {}

  Image certified;
  Image binary64;         ///< the samples' midpoint rule on the exact chain
  Image binary32;         ///< the same, compositing and transfer function in binary32
  Image textures;         ///< volume too is read by a texture unit, in binary32
  Image rounded_weights;  ///< of few bits, as in hardware
  Image glsl;
  double radius = 0;  ///< largest one of the certified pixels
};

template <class Real>
Eigen::Array4d to_pixel(const Eigen::Array<Real, 4, 1>& slab) {
  return {to_double(slab[0]), to_double(slab[1]), to_double(slab[2]), to_double(slab[3])};
}

Eigen::Array4d to_pixel(const Vector3<double>& color, double opacity) {
  return {color[0], color[1], color[2], opacity};
}

Images draw(const TexturedScene& scene, const Grid& grid, int weight_bits, GlDevice& device) {
  struct Worker {
    RayIntegral truth;
    SchemeIntegral integrate;
    Samples<double> samples = {};
    double radius = 0;
  };
  const PiecewiseLinear transfer = drawn_transfer(scene);
  const IntegralScheme& midpoints = *find_named(catalogue::integral_schemes(), "riemann_mid");
  const TextureUnit<Binary32> volume(scene.volume);
  const TextureUnit<Binary32> table(scene.transfer);
  const TextureUnit<Binary32> rough_volume(scene.volume, weight_bits);
  const TextureUnit<Binary32> rough_table(scene.transfer, weight_bits);
  Images images(scene.camera.size);
  tbb::enumerable_thread_specific<Worker> workers([&transfer] {
    return Worker{RayIntegral(transfer, Emission::associated), SchemeIntegral(transfer, Emission::associated)};
  });
  for_each_pixel(grid, scene.camera, [&](const Pixel& pixel) {
    auto& [integrate_truth, integrate, samples, radius] = workers.local();
    const auto [column, row, ray, signal] = pixel;
    const Certified truth = integrate_truth(signal);
    radius = std::max(radius, truth.radius);
    images.certified.at(column, row) = to_pixel(truth.color, truth.opacity);
    sample_constant(signal, scene.step, samples);
    const Outcome<> in_binary64 = integrate(midpoints, signal, samples);
    images.binary64.at(column, row) = to_pixel(in_binary64.color, in_binary64.opacity);
    const Outcome<> in_binary32 = *integrate.in_binary32(midpoints, signal, samples);
    images.binary32.at(column, row) = to_pixel(in_binary32.color, in_binary32.opacity);
    images.textures.at(column, row) = to_pixel<Binary32>(march_textures(volume, table, ray, scene.step));
    images.rounded_weights.at(column, row) =
        to_pixel<Binary32>(march_textures(rough_volume, rough_table, ray, scene.step));
  });
  for (const Worker& worker : workers) images.radius = std::max(images.radius, worker.radius);
  images.glsl = draw_by_hand_written_renderer(device, scene);
  return images;
}

struct Comparison {
  const char* image_name;
  Image Images::*image;
  const char* reference_name;
  Image Images::*reference;
};

constexpr std::array comparisons{
    Comparison{"binary64", &Images::binary64, "certified", &Images::certified},
    Comparison{"binary32", &Images::binary32, "binary64", &Images::binary64},
    Comparison{"textures", &Images::textures, "binary32", &Images::binary32},
    Comparison{"rounded_weights", &Images::rounded_weights, "textures", &Images::textures},
    Comparison{"glsl", &Images::glsl, "textures", &Images::textures},
    Comparison{"glsl", &Images::glsl, "binary32", &Images::binary32},
    Comparison{"glsl", &Images::glsl, "certified", &Images::certified},
    Comparison{"rounded_weights", &Images::rounded_weights, "certified", &Images::certified},
};

/// A comparison of two images of a scene.
struct Record {
  std::string shape;
  std::string camera;
  double step;
  int weight_bits;
  double mean_opacity;  ///< of the certified image
  double brightest;     ///< of its channels
  const Comparison* compared;
  ImageError error;
  double radius;  ///< of the certified image, if it is the reference
};

double brightest_channel(const Image& image) {
  double largest = 0;
  for (const auto& pixel : image.pixels) largest = std::max(largest, pixel.head<3>().maxCoeff());
  return largest;
}

double mean_opacity(const Image& image) {
  double sum = 0;
  for (const auto& pixel : image.pixels) sum += pixel[3];
  return sum / static_cast<double>(image.pixels.size());
}

template <class Get>
CellOf<Record> of_error(Get get) {
  return [get](const Record& record) { return std::invoke(get, record.error); };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  return {
      {.name = "shape", .description = "of the transfer function", .is_key = true, .cell = &Record::shape},
      {.name = "camera", .description = "orthographic or perspective", .is_key = true, .cell = &Record::camera},
      {.name = "step", .unit = "voxel", .description = "distance of samples", .is_key = true, .cell = &Record::step},
      {.name = "image",
       .description = "binary64: the midpoint rule on exact samples; binary32: in binary32 from the samples on; "
                      "textures: samples too, by a texture unit of exact weights; rounded_weights: weights of "
                      "weight_bits; glsl: the hand-written renderer",
       .is_key = true,
       .cell = [](const Record& record) { return record.compared->image_name; }},
      {.name = "reference",
       .description = "the image it is compared with",
       .is_key = true,
       .cell = [](const Record& record) { return record.compared->reference_name; }},
      {.name = "comparison",
       .description = "image minus reference, in words",
       .cell =
           [](const Record& record) {
             return std::string(record.compared->image_name) + " - " + record.compared->reference_name;
           }},
      {.name = "weight_bits", .unit = "bit", .description = "of rounded_weights", .cell = &Record::weight_bits},
      {.name = "mean_opacity", .description = "of the certified image", .cell = &Record::mean_opacity},
      {.name = "brightest", .description = "largest channel of the certified image", .cell = &Record::brightest},
      {.name = "error_max",
       .unit = "of white",
       .description = "largest difference of a channel",
       .radius = "radius",
       .cell = of_error(&ImageError::maximum)},
      {.name = "column",
       .unit = "pixel",
       .description = "where it is, from the left",
       .cell = of_error([](const ImageError& error) { return error.place[0]; })},
      {.name = "row",
       .unit = "pixel",
       .description = "where it is, from the top",
       .cell = of_error([](const ImageError& error) { return error.place[1]; })},
      {.name = "error_mean",
       .unit = "of white",
       .description = "mean difference over pixels and channels, signed",
       .radius = "radius",
       .cell = of_error(&ImageError::bias)},
      {.name = "error_rms",
       .unit = "of white",
       .description = "root mean square over pixels and channels",
       .radius = "radius",
       .cell = of_error(&ImageError::rmse)},
      {.name = "psnr",
       .unit = "dB",
       .description = "-20 log10 of error_rms: the peak is 1; null for equal images",
       .cell = of_error(&ImageError::psnr)},
      {.name = "error_relative",
       .description = "sum of magnitudes over the reference's sum (Danskin and Hanrahan 1992)",
       .cell = of_error(&ImageError::relative)},
      {.name = "radius",
       .unit = "of white",
       .description = "of the certified image, largest; 0 if it has no part",
       .cell = &Record::radius},
  };
}

std::vector<Record> records_of_field(const Experiment& experiment, const Options& options, const Field& field) {
  const auto device = open_gl(experiment.gl);
  std::vector<Record> records;
  for (const std::string& shape : options.shapes) {
    TexturedScene scene =
        textured_scene(field.grid, TableStudy::transfer(shape, options.extinction, experiment.seed), options.entries);
    scene.step = options.step;
    const Grid grid = drawn_grid(field.grid, scene);
    for (const GridView& view : options.views) {
      scene.camera = aimed(view, grid);
      const Images images = draw(scene, grid, options.weight_bits, *device);
      for (const Comparison& compared : comparisons) {
        const bool is_against_truth = compared.reference == &Images::certified;
        records.push_back({.shape = shape,
                           .camera = view.kind,
                           .step = options.step,
                           .weight_bits = options.weight_bits,
                           .mean_opacity = mean_opacity(images.certified),
                           .brightest = brightest_channel(images.certified),
                           .compared = &compared,
                           .error = image_error(images.*compared.image, images.*compared.reference),
                           .radius = is_against_truth ? images.radius : 0.0});
      }
    }
  }
  return records;
}

}  // namespace

extern const Measure gl_renderer_measure;
const Measure gl_renderer_measure{MeasureDefinition<Options, Record>{
    .name = "gl_renderer",
    .summary = "images of a hand-written renderer in GLSL, of the CPU, and certified ones",
    .uses_gl = true,
    .read = read_options,
    .columns = columns,
    .of_field = records_of_field}};

}  // namespace raytruth
