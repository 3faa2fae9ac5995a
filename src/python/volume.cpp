#include "python/volume.hpp"

#include "python/document.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/volume/files/find_volume.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

namespace raytruth::python {

namespace py = pybind11;

namespace {

void check_spacing(const std::array<double, 3>& spacing) {
  for (const double length : spacing)
    if (!(length > 0 && std::isfinite(length)))
      throw InputError(
          fmt::format("spacing: found [{}]; three finite numbers > 0 are allowed", fmt::join(spacing, ", ")));
}

/// Puts `nan` in place of what is NaN, and refuses everything else that is not finite.
void check_values(Grid& grid, std::optional<double> nan) {
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    double& value = grid.values[i];
    if (std::isnan(value) && nan) value = *nan;
    if (std::isfinite(value)) continue;
    const auto row = static_cast<std::size_t>(grid.size[0]);
    const auto slice = row * static_cast<std::size_t>(grid.size[1]);
    throw InputError(fmt::format("array: found {} at x {}, y {}, z {}; finite numbers are allowed{}", value, i % row,
                                 i % slice / row, i / slice,
                                 std::isnan(value) ? ", or nan=VALUE, what NaN becomes" : ""));
  }
}

/// Whether whole numbers of 64 bits lose digits as binary64.
bool has_numbers_beyond_binary64(const py::array& array) {
  if (array.itemsize() < 8 || (array.dtype().kind() != 'i' && array.dtype().kind() != 'u')) return false;
  const py::object largest = array.attr("max")();
  const py::object smallest = array.attr("min")();
  const py::int_ limit(std::int64_t{1} << 53);
  return largest > limit || smallest < py::int_(-(std::int64_t{1} << 53));
}

Volume read(const std::string& name, const std::optional<std::array<double, 3>>& spacing, std::optional<double> nan,
            std::optional<std::int64_t> time_step, bool repair, const std::optional<std::string>& data) {
  if (spacing) check_spacing(*spacing);
  raytruth::Volume volume = [&] {
    const py::gil_scoped_release without_lock;
    raytruth::Volume found = read_volume(find_volume(name, volume_folders(data.value_or(""))),
                                         {.nan = nan, .time_step = time_step, .spacing = spacing}, memory_limit());
    if (repair) repair_first_byte(found);
    return found;
  }();
  const std::string file = volume.file.filename().string();
  std::vector<std::string> warnings = warnings_of(volume, file);
  if (!volume.has_spacing)
    warnings.push_back(
        fmt::format("warning: {}: the file states no spacing, so 1 is taken along every axis; "
                    "spacing=(x, y, z) states it",
                    file));
  warn(warnings);
  return {std::make_shared<const Grid>(std::move(volume.grid)), file};
}

}  // namespace

Volume Volume::from_array(const py::array& array, const std::array<double, 3>& spacing, const std::string& order,
                          std::optional<double> nan, const std::string& name) {
  check_spacing(spacing);
  if (order != "zyx" && order != "xyz") throw InputError(fmt::format("order: found {}; zyx or xyz is allowed", order));
  if (nan && !std::isfinite(*nan)) throw InputError(fmt::format("nan: found {}; a finite number is allowed", *nan));
  if (name.empty()) throw InputError("name: found an empty text; another one is allowed");
  if (array.ndim() != 3) throw InputError(fmt::format("array: found {} axes; 3 are allowed", array.ndim()));
  if (array.size() == 0) throw InputError("array: found no voxels; every size from 1 on is allowed");
  const char kind = array.dtype().kind();
  if (std::string_view("biuf").find(kind) == std::string_view::npos)
    throw InputError(fmt::format("array: found numbers of the type {}; real numbers are allowed",
                                 py::str(array.dtype()).cast<std::string>()));
  need_memory(static_cast<std::uint64_t>(array.size()) * sizeof(double), fmt::format("{} voxels", array.size()),
              "array");
  if (has_numbers_beyond_binary64(array))
    warn({fmt::format("warning: {}: whole numbers beyond 2^53 are rounded to binary64", name)});
  const py::object ordered = order == "zyx" ? py::object(array) : array.attr("T");
  const auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(ordered);
  if (!values) throw py::error_already_set();
  Grid grid{.size = {values.shape(2), values.shape(1), values.shape(0)}, .spacing = spacing, .values = {}};
  grid.values.assign(values.data(), values.data() + values.size());
  check_values(grid, nan);
  return {std::make_shared<const Grid>(std::move(grid)), name};
}

py::array_t<double> Volume::array() const {
  py::capsule keep(new std::shared_ptr<const Grid>(grid_),
                   [](void* pointer) { delete static_cast<std::shared_ptr<const Grid>*>(pointer); });
  const auto& size = grid_->size;
  py::array_t<double> view({size[2], size[1], size[0]}, grid_->values.data(), keep);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

void add_volume(py::module_& module) {
  py::class_<Volume>(module, "Volume", "Scalars on a regular grid.")
      .def(py::init(&Volume::from_array), py::arg("array"), py::kw_only(),
           py::arg("spacing") = std::array{1.0, 1.0, 1.0}, py::arg("order") = "zyx", py::arg("nan") = py::none(),
           py::arg("name") = "array",
           "Copies an array of three axes, indexed [z, y, x], or [x, y, z] with order='xyz'.")
      .def_property_readonly("array", &Volume::array, "The voxels, binary64, read-only, indexed [z, y, x].")
      .def_property_readonly("name", &Volume::name, "What results call it.")
      .def_property_readonly(
          "size", [](const Volume& volume) { return py::tuple(py::cast(volume.grid()->size)); },
          "Voxels along x, y, z.")
      .def_property_readonly(
          "spacing", [](const Volume& volume) { return py::tuple(py::cast(volume.grid()->spacing)); },
          "Distance of voxels along x, y, z.")
      .def_property_readonly(
          "range", [](const Volume& volume) { return volume.grid()->range(); }, "Smallest and largest value.")
      .def("__repr__", [](const Volume& volume) {
        return fmt::format("<raytruth.Volume {}: {} voxels, spacing {}>", volume.name(),
                           fmt::join(volume.grid()->size, " x "), fmt::join(volume.grid()->spacing, " x "));
      });
  module.def("read_volume", &read, py::arg("name"), py::kw_only(), py::arg("spacing") = py::none(),
             py::arg("nan") = py::none(), py::arg("time_step") = py::none(), py::arg("repair") = false,
             py::arg("data") = py::none(), "Reads a file, or finds a volume of that name as the program does.");
}

}  // namespace raytruth::python
