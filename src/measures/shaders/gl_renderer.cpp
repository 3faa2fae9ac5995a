#include "experiments/measure.hpp"
#include "measures/images/grid_view.hpp"
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

Options read_options(const JsonReader& json) {
  json.only({"kind", "shapes", "extinction", "entries", "step", "weight_bits", "size", "views"});
  std::vector<std::string_view> shapes;
  for (const auto& transfer : catalogue::transfers)
    if (transfer.make != nullptr) shapes.push_back(transfer.name);
  Options options{.shapes = {},
                  .extinction = json.at("extinction").number(0, largest_extinction),
                  .entries = json.at("entries").integer(2, most_entries),
                  .step = json.at("step").number(0x1p-10, 1024),
                  .weight_bits = static_cast<int>(json.at("weight_bits").integer(1, most_weight_bits)),
                  .views = {}};
  for (const JsonReader& shape : json.at("shapes").items()) options.shapes.push_back(shape.word(shapes));
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

/// The same scene, drawn in every way.
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

}  // namespace

std::vector<Column> gl_renderer_columns(const Experiment& /*experiment*/, const JsonReader& options) {
  read_options(options);
  return {
      {.name = "shape", .unit = "", .description = "of the transfer function", .is_key = true},
      {.name = "camera", .unit = "", .description = "orthographic or perspective", .is_key = true},
      {.name = "step", .unit = "voxel", .description = "distance of samples", .is_key = true},
      {.name = "image",
       .unit = "",
       .description = "binary64: the midpoint rule on exact samples; binary32: in binary32 from the samples on; "
                      "textures: samples too, by a texture unit of exact weights; rounded_weights: weights of "
                      "weight_bits; glsl: the hand-written renderer",
       .is_key = true},
      {.name = "reference", .unit = "", .description = "the image it is compared with", .is_key = true},
      {.name = "comparison", .unit = "", .description = "image minus reference, in words"},
      {.name = "weight_bits", .unit = "bit", .description = "of rounded_weights"},
      {.name = "mean_opacity", .unit = "", .description = "of the certified image"},
      {.name = "brightest", .unit = "", .description = "largest channel of the certified image"},
      {.name = "error_max", .unit = "of white", .description = "largest difference of a channel", .radius = "radius"},
      {.name = "column", .unit = "pixel", .description = "where it is, from the left"},
      {.name = "row", .unit = "pixel", .description = "where it is, from the top"},
      {.name = "error_mean",
       .unit = "of white",
       .description = "mean difference over pixels and channels, signed",
       .radius = "radius"},
      {.name = "error_rms",
       .unit = "of white",
       .description = "root mean square over pixels and channels",
       .radius = "radius"},
      {.name = "psnr", .unit = "dB", .description = "-20 log10 of error_rms: the peak is 1; null for equal images"},
      {.name = "error_relative",
       .unit = "",
       .description = "sum of magnitudes over the reference's sum (Danskin and Hanrahan 1992)"},
      {.name = "radius", .unit = "of white", .description = "of the certified image, largest; 0 if it has no part"},
  };
}

std::vector<Row> gl_renderer_rows(const Experiment& experiment, const JsonReader& options, const Field& field) {
  const Options asked = read_options(options);
  const auto device = open_gl(experiment.gl);
  std::vector<Row> rows;
  for (const std::string& shape : asked.shapes) {
    const auto& entry = *std::find_if(catalogue::transfers.begin(), catalogue::transfers.end(),
                                      [&shape](const auto& transfer) { return transfer.name == shape; });
    TexturedScene scene = textured_scene(field.grid, entry.make(asked.extinction, experiment.seed), asked.entries);
    scene.step = asked.step;
    const Grid grid = drawn_grid(field.grid, scene);
    for (const GridView& view : asked.views) {
      scene.camera = aimed(view, grid);
      const Images images = draw(scene, grid, asked.weight_bits, *device);
      for (const auto& [image_name, image, reference_name, reference] : comparisons) {
        const ImageError error = image_error(images.*image, images.*reference);
        const bool is_against_truth = reference == &Images::certified;
        rows.push_back({{"shape", shape},
                        {"camera", view.kind},
                        {"step", asked.step},
                        {"image", image_name},
                        {"reference", reference_name},
                        {"comparison", std::string(image_name) + " - " + reference_name},
                        {"weight_bits", std::int64_t{asked.weight_bits}},
                        {"mean_opacity", mean_opacity(images.certified)},
                        {"brightest", brightest_channel(images.certified)},
                        {"error_max", error.maximum},
                        {"column", error.place[0]},
                        {"row", error.place[1]},
                        {"error_mean", error.bias},
                        {"error_rms", error.rmse},
                        {"psnr", error.psnr ? Value(*error.psnr) : Value()},
                        {"error_relative", error.relative ? Value(*error.relative) : Value()},
                        {"radius", is_against_truth ? images.radius : 0.0}});
      }
    }
  }
  return rows;
}

}  // namespace raytruth
