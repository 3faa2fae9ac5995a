#include "python/transfer_function.hpp"

#include "python/document.hpp"
#include "python/volume.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/documents/transfer_files/transfer_file.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>
#include <string_view>

namespace raytruth::python {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

namespace {

/// A path is a document too, as scenes have it.
JsonReader read_request(py::handle object) {
  const std::string name = "transfer_function";
  if (py::isinstance<py::str>(object) || py::hasattr(object, "__fspath__")) {
    const auto path = py::str(object).cast<std::string>();
    return JsonReader::from_text(nlohmann::ordered_json(path).dump(), name);
  }
  return read_document(object, name).json;
}

TransferFunction read(py::handle object, const Volume* volume) {
  std::optional<TransferVolume> context;
  if (volume != nullptr) context = transfer_volume(*volume->grid());
  std::vector<std::string> warnings;
  TransferDocument found =
      read_transfer_function(read_request(object), {.volume = context ? &*context : nullptr}, warnings);
  warn(warnings);
  return {std::move(found.transfer), std::move(found.description)};
}

void check_shapes(const Numbers& s, const Numbers& values, const Numbers& color, std::string_view name) {
  if (s.ndim() != 1) throw InputError(fmt::format("s: found {} axes; 1 is allowed", s.ndim()));
  if (values.ndim() != 1 || values.shape(0) != s.shape(0))
    throw InputError(fmt::format("{}: found another number than the {} of s; as many are allowed", name, s.shape(0)));
  if (color.ndim() != 2 || color.shape(0) != s.shape(0) || color.shape(1) != 3)
    throw InputError(
        fmt::format("color: found another shape than ({0}, 3); red, green, blue for each of the {0} of s "
                    "are allowed",
                    s.shape(0)));
}

Vector3<double> color_at(const Numbers& color, py::ssize_t i) {
  return {color.at(i, 0), color.at(i, 1), color.at(i, 2)};
}

/// Calls `make`; a point that it refuses is named by its place in the arrays.
template <class Make>
auto naming_points(const Make& make) {
  try {
    return make();
  } catch (const PointError& error) {
    throw InputError(fmt::format("point {}: {}", error.index, error.what()));
  }
}

TransferFunction from_extinctions(const Numbers& s, const Numbers& extinction, const Numbers& color) {
  check_shapes(s, extinction, color, "extinction");
  std::vector<TransferPoint> points;
  for (py::ssize_t i = 0; i < s.shape(0); ++i) points.push_back({s.at(i), {extinction.at(i), color_at(color, i)}});
  return naming_points([&] { return TransferFunction(PiecewiseLinear(std::move(points)), {}); });
}

TransferFunction from_opacities(const Numbers& s, const Numbers& opacity, const Numbers& color, double unit_length) {
  check_shapes(s, opacity, color, "opacity");
  std::vector<OpacityPoint> points;
  for (py::ssize_t i = 0; i < s.shape(0); ++i) points.push_back({s.at(i), opacity.at(i), color_at(color, i)});
  return naming_points([&] { return TransferFunction(from_opacity(points, unit_length), {}); });
}

py::object at(const TransferFunction& function, const Numbers& s) {
  const std::vector<py::ssize_t> shape(s.shape(), s.shape() + s.ndim());
  std::vector<py::ssize_t> color_shape = shape;
  color_shape.push_back(3);
  py::array_t<double> extinction(shape);
  py::array_t<double> color(color_shape);
  for (py::ssize_t i = 0; i < s.size(); ++i) {
    const Optics optics = function.transfer().at(s.data()[i]);
    extinction.mutable_data()[i] = optics.extinction;
    for (int channel = 0; channel < 3; ++channel) color.mutable_data()[3 * i + channel] = optics.color[channel];
  }
  return py::make_tuple(extinction, color);
}

}  // namespace

TransferFunction::Integrals::Integrals(const PiecewiseLinear& function)
    : transfer(function),
      reference{PerThread<RayIntegral>([function] { return RayIntegral(function, Emission::associated); }),
                PerThread<RayIntegral>([function] { return RayIntegral(function, Emission::plain); })},
      schemes{PerThread<SchemeIntegral>([function] { return SchemeIntegral(function, Emission::associated); }),
              PerThread<SchemeIntegral>([function] { return SchemeIntegral(function, Emission::plain); })} {}

TransferFunction::TransferFunction(PiecewiseLinear transfer, nlohmann::ordered_json description)
    : integrals_(std::make_shared<Integrals>(transfer)), description_(std::move(description)) {
  RayIntegral(integrals_->transfer, Emission::associated);
}

RayIntegral& TransferFunction::reference(Emission emission) const {
  return integrals_->reference[emission == Emission::associated ? 0 : 1].local();
}

SchemeIntegral& TransferFunction::schemes(Emission emission) const {
  return integrals_->schemes[emission == Emission::associated ? 0 : 1].local();
}

Emission emission_of(const std::string& name) {
  if (name == "associated") return Emission::associated;
  if (name == "plain") return Emission::plain;
  throw InputError(fmt::format("emission: found {}; associated or plain is allowed", name));
}

TransferFunction transfer_function_of(py::handle object) {
  if (py::isinstance<TransferFunction>(object)) return object.cast<TransferFunction>();
  return read(object, nullptr);
}

void add_transfer_function(py::module_& module) {
  py::class_<TransferFunction>(module, "TransferFunction", "Extinction, or opacity, and colour of a scalar.")
      .def(py::init(&read), py::arg("document"), py::kw_only(), py::arg("volume") = py::none(),
           "What scenes state as \"transfer_function\": a dict, or the path of a file of this or another program.")
      .def_static("from_extinctions", &from_extinctions, py::arg("s"), py::arg("extinction"), py::arg("color"),
                  "Points between which the extinction, per unit of length, is linear.")
      .def_static("from_opacities", &from_opacities, py::arg("s"), py::arg("opacity"), py::arg("color"),
                  py::arg("unit_length") = 1.0, "Points between which the opacity of a length is linear.")
      .def_property_readonly(
          "document",
          [](const TransferFunction& function) { return to_python(transfer_function_json(function.transfer())); },
          "As scenes, cases and tables state it.")
      .def_property_readonly(
          "description", [](const TransferFunction& function) { return to_python(function.description()); },
          "How the file of another program was understood.")
      .def("at", &at, py::arg("s"), "Extinctions, and colours with a last axis of 3, at scalars.")
      .def("__repr__", [](const TransferFunction& function) {
        const auto& points = function.transfer().points();
        return fmt::format("<raytruth.TransferFunction: {} points from {} to {}, linear in {}>", points.size(),
                           points.front().s, points.back().s,
                           function.transfer().is_linear_in_opacity() ? "opacity" : "extinction");
      });
}

}  // namespace raytruth::python
