#include "experiments/measure.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/vector3.hpp"
#include "raytruth/images/image.hpp"
#include "raytruth/images/image_error.hpp"
#include "raytruth/shading/highlight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace raytruth {

namespace {

struct Options {
  std::int64_t size = 0;
  double shininess = 0;
};

Options read_options(const Experiment& /*experiment*/, const JsonReader& json) {
  json.only({"kind", "size", "shininess"});
  return {.size = json.at("size").integer(8, 512), .shininess = json.at("shininess").number(1, 1e6)};
}

constexpr double ambient = 0.1;
constexpr double diffuse = 0.4;
constexpr double specular = 0.5;
constexpr double bump = 0.06;  ///< amplitude over the sphere's radius
constexpr double bump_frequency = 14;

/// The pictures that a result holds; of the other highlights it holds the error only.
constexpr std::array<std::string_view, 4> pictured{"lobe", "cone", "cone_minimax", "square_minimax"};

Vector3<double> unit(const Vector3<double>& vector) { return vector / vector.matrix().norm(); }

/// The unit normal of the sphere of radius 1 at a point of it; bumpy: of the level set of
/// |p| + bump product_i sin(bump_frequency p_i) through that point.
Vector3<double> normal_of(const Vector3<double>& point, bool is_bumpy) {
  if (!is_bumpy) return point;
  const Vector3<double> sines = (bump_frequency * point).sin();
  const Vector3<double> cosines = (bump_frequency * point).cos();
  const Vector3<double> slope(cosines[0] * sines[1] * sines[2], sines[0] * cosines[1] * sines[2],
                              sines[0] * sines[1] * cosines[2]);
  return unit(point + bump * bump_frequency * slope);
}

/// An orthographic view down the z axis; light from the upper left.
Image sphere_image(const Options& options, bool is_bumpy, const Highlight& highlight) {
  const Vector3<double> light = unit({-1, 1, 1.5});
  const Vector3<double> half = unit(light + Vector3<double>(0, 0, 1));
  const double exponent = highlight.exponent(options.shininess);
  Image image({options.size, options.size});
  for (std::int64_t row = 0; row < options.size; ++row)
    for (std::int64_t column = 0; column < options.size; ++column) {
      const double x = (2 * static_cast<double>(column) + 1) / static_cast<double>(options.size) - 1;
      const double y = 1 - (2 * static_cast<double>(row) + 1) / static_cast<double>(options.size);
      if (x * x + y * y > 1) continue;
      const Vector3<double> normal = normal_of({x, y, std::sqrt(1 - x * x - y * y)}, is_bumpy);
      const double light_sent = ambient + diffuse * std::max(0.0, (normal * light).sum()) +
                                specular * highlight.value_at_exponent((normal * half).sum(), exponent);
      image.at(column, row) = {light_sent, light_sent, light_sent, 1};
    }
  return image;
}

/// A row of pixels in 8-bit sRGB (IEC 61966-2-1), two hexadecimal digits each.
std::string gray_text(const Image& image, std::int64_t row) {
  std::string text;
  for (std::int64_t column = 0; column < image.size[0]; ++column) {
    const double linear = std::clamp(image.pixels[static_cast<std::size_t>(row * image.size[0] + column)][0], 0.0, 1.0);
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    text += fmt::format("{:02x}", std::lround(255 * encoded));
  }
  return text;
}

/// A picture against that of the lobe, or a line of its pixels.
struct Record {
  bool is_bumpy = false;
  const Highlight* highlight = nullptr;
  double shininess = 0;
  std::optional<ImageError> error = {};   ///< of the whole picture
  std::optional<std::int64_t> line = {};  ///< 0 on top
  std::string pixels = {};
};

Columns<ImageError> error_columns() {
  return {
      {.name = "image_error",
       .description = "sum |I - I_lobe| / sum I_lobe (Danskin and Hanrahan 1992)",
       .cell = [](const ImageError& error) { return error.relative.value_or(0); }},
      {.name = "image_rmse", .description = "root mean square of I - I_lobe, linear light", .cell = &ImageError::rmse},
      {.name = "image_psnr", .unit = "dB", .description = "-20 log10 of it; the peak is 1", .cell = &ImageError::psnr},
      {.name = "image_maximum", .description = "largest |I - I_lobe|", .cell = &ImageError::maximum},
  };
}

Columns<Record> columns(const Experiment& /*experiment*/, const Options& /*options*/) {
  Columns<Record> columns{
      {.name = "surface",
       .description = "smooth or bumpy sphere",
       .is_key = true,
       .cell = [](const Record& record) { return record.is_bumpy ? "bumpy" : "smooth"; }},
      {.name = "highlight",
       .description = "of its lighting",
       .is_key = true,
       .cell = [](const Record& record) { return record.highlight->name; }},
      {.name = "shininess", .description = "of the highlight", .is_key = true, .cell = &Record::shininess},
      {.name = "line",
       .description = "of the picture, 0 on top; null: the whole picture against that of the lobe",
       .is_key = true,
       .cell = &Record::line},
      {.name = "pixels",
       .description = "its pixels, 8-bit sRGB grays, two hexadecimal digits each",
       .cell = [](const Record& record) { return cell_if(record.line.has_value(), record.pixels); }},
  };
  append_part(columns, &Record::error, error_columns());
  return columns;
}

std::vector<Record> records(const Experiment& /*experiment*/, const Options& options) {
  std::vector<Record> records;
  for (const bool is_bumpy : {false, true}) {
    const Image lobe = sphere_image(options, is_bumpy, *find_named(catalogue::highlights(), "lobe"));
    for (const Highlight& highlight : catalogue::highlights()) {
      const Image image = sphere_image(options, is_bumpy, highlight);
      const Record of_picture{.is_bumpy = is_bumpy, .highlight = &highlight, .shininess = options.shininess};
      if (highlight.name != "lobe") records.emplace_back(of_picture).error = image_error(image, lobe);
      if (std::find(pictured.begin(), pictured.end(), highlight.name) == pictured.end()) continue;
      for (std::int64_t line = 0; line < options.size; ++line) {
        Record& record = records.emplace_back(of_picture);
        record.line = line;
        record.pixels = gray_text(image, line);
      }
    }
  }
  return records;
}

}  // namespace

extern const Measure spheres_measure;
const Measure spheres_measure{MeasureDefinition<Options, Record>{
    .name = "spheres",
    .summary = "pictures of a smooth and a bumpy sphere by several highlights, and their errors",
    .read = read_options,
    .columns = columns,
    .of_experiment = records}};

}  // namespace raytruth
