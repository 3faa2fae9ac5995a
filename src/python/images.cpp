#include "python/images.hpp"

#include "experiments/output.hpp"
#include "python/document.hpp"
#include "python/threads.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/documents/image_comparison.hpp"
#include "raytruth/documents/rendering_json.hpp"
#include "raytruth/documents/scene_document.hpp"
#include "raytruth/images/image_file.hpp"
#include "raytruth/render/renderer.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace raytruth::python {

namespace py = pybind11;
using Json = nlohmann::ordered_json;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

namespace {

/// An image as Python holds it.
struct PythonImage {
  Numbers pixels;     ///< (height, width, 4): linear light over black, and opacity
  py::object radius;  ///< (height, width), or None
  py::object info;    ///< what `raytruth render` prints
};

Numbers array_of(const Image& image) {
  Numbers array({image.size[1], image.size[0], std::int64_t{4}});
  double* to = array.mutable_data();
  for (const Eigen::Array4d& pixel : image.pixels) to = std::copy_n(pixel.data(), 4, to);
  return array;
}

/// Hears Ctrl-C, and tells whoever wants to know how far the rendering is.
class Progress {
 public:
  explicit Progress(py::object callback) : callback_(std::move(callback)) {}

  void operator()(std::size_t done, std::size_t of) const {
    const py::gil_scoped_acquire with_lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!callback_.is_none()) callback_(done, of);
  }

 private:
  py::object callback_;
};

PythonImage render(py::handle scene_document, const std::optional<std::string>& data, std::optional<double> nan,
                   int threads, const py::object& progress) {
  const Threads limit(threads);
  const Document document = read_document(scene_document, "scene");
  SceneFile scene = read_scene(document.json, {.volumes = volume_access(document, data, nan), .opacity = {}});
  warn(scene.warnings);
  if (scene.program)
    document.json.at("scheme").refuse("a program", "a scheme, or `raytruth render --programs`, which runs it,");
  scene.scene.covers_camera = true;
  Json info{{"size", scene.scene.camera.size},
            {"scheme", scene.scene.scheme},
            {"volume", std::move(scene.volume)},
            {"border", name_of(scene.scene.border)},
            {"transfer_function", std::move(scene.transfer_function)}};
  if (!scene.fitted_camera.is_null()) info["fitted_camera"] = scene.fitted_camera;
  if (!scene.warnings.empty()) info["warnings"] = scene.warnings;
  const Progress tell(progress);
  const Rendering rendering = [&] {
    const py::gil_scoped_release without_lock;
    return document.json.at("scheme").blame_for([&] { return Renderer(std::move(scene.scene)).render(tell); });
  }();
  PythonImage image{array_of(rendering.image), py::none(), py::none()};
  if (!rendering.radii.empty()) {
    info.update(radius_json(rendering));
    Numbers radius({rendering.image.size[1], rendering.image.size[0]});
    std::copy(rendering.radii.begin(), rendering.radii.end(), radius.mutable_data());
    image.radius = std::move(radius);
  }
  image.info = to_python(info);
  return image;
}

/// An image, and whether it has opacities.
struct Compared {
  Image image;
  bool has_opacity;
};

Compared image_of_array(const Numbers& array, const std::string& name) {
  if (array.ndim() != 3 || array.size() == 0 || (array.shape(2) != 3 && array.shape(2) != 4))
    throw InputError(
        fmt::format("{}: found another shape than (height, width, 3 or 4); red, green, blue in linear light "
                    "over black, and opacity, are allowed",
                    name));
  if (array.shape(0) > largest_image_side || array.shape(1) > largest_image_side)
    throw InputError(
        fmt::format("{}: found more than {} pixels along a side; fewer are allowed", name, largest_image_side));
  const auto channels = array.shape(2);
  Compared found{Image({array.shape(1), array.shape(0)}), channels == 4};
  const double* from = array.data();
  for (Eigen::Array4d& pixel : found.image.pixels) {
    pixel[3] = 1;
    for (py::ssize_t channel = 0; channel < channels; ++channel) {
      pixel[channel] = *from++;
      if (!std::isfinite(pixel[channel]))
        throw InputError(fmt::format("{}: found {}; finite numbers are allowed", name, pixel[channel]));
    }
  }
  return found;
}

/// Reads a rendered image, an array, or a file of linear light.
Compared compared_of(py::handle given, const std::string& name) {
  if (py::isinstance<PythonImage>(given)) return image_of_array(given.cast<const PythonImage&>().pixels, name);
  if (py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__")) {
    const auto path = py::str(given).cast<std::string>();
    StoredImage stored = read_image(path);
    if (stored.is_png)
      throw InputError(
          fmt::format("{}: {}: found a .png, which encodes light; .pfm, .npy or an array of linear light is "
                      "allowed, and `raytruth compare` decodes it",
                      name, path));
    return {std::move(stored.image), stored.has_opacity};
  }
  const auto array = Numbers::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw InputError(fmt::format("{}: found no image; an Image, an array of numbers or a path is allowed", name));
  }
  return image_of_array(array, name);
}

py::object compare(py::handle reference, py::handle image, double peak) {
  if (!(peak > 0 && std::isfinite(peak)))
    throw InputError(fmt::format("peak: found {}; a finite number > 0 is allowed", peak));
  const Compared truth = compared_of(reference, "reference");
  const Compared other = compared_of(image, "image");
  return to_python(image_error_json(other.image, truth.image, truth.has_opacity && other.has_opacity, peak));
}

Numbers read_pixels(const std::filesystem::path& path) {
  const StoredImage stored = read_image(path);
  const Numbers all = array_of(stored.image);
  if (stored.has_opacity) return all;
  return Numbers(all.attr("__getitem__")(py::make_tuple(py::ellipsis(), py::slice(0, 3, 1))));
}

void save(const PythonImage& image, const std::string& path, bool linear, bool binary64) {
  const std::filesystem::path file = path;
  const Compared stored = image_of_array(image.pixels, "pixels");
  write_whole(file,
              image_file(stored.image, file.extension().string(), linear ? Transfer8Bit::linear : Transfer8Bit::srgb,
                         binary64 ? NpyNumbers::binary64 : NpyNumbers::binary32));
}

}  // namespace

void add_images(py::module_& module) {
  py::class_<PythonImage>(module, "Image", "A rendered scene.")
      .def_readonly("pixels", &PythonImage::pixels,
                    "(height, width, 4): red, green, blue in linear light, and opacity.")
      .def_readonly("radius", &PythonImage::radius, "(height, width), of the scheme 'reference'; else None.")
      .def_readonly("info", &PythonImage::info, "What `raytruth render` prints.")
      .def("save", &save, py::arg("path"), py::kw_only(), py::arg("linear") = false, py::arg("binary64") = false,
           "Writes a .png, .pfm or .npy, as `raytruth render` does.");
  module.def("render", &render, py::arg("scene"), py::kw_only(), py::arg("data") = py::none(),
             py::arg("nan") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
             "Renders a scene by the scheme that it names, or the true image.");
  module.def("read_image", &read_pixels, py::arg("path"), "The numbers of a .png, .pfm or .npy, as they are stored.");
  module.def("compare", &compare, py::arg("reference"), py::arg("image"), py::kw_only(), py::arg("peak") = 1.0,
             "The errors of an image against a reference, as `raytruth compare` tells them.");
}

}  // namespace raytruth::python
