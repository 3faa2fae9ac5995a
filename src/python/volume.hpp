#pragma once

#include "raytruth/volume/grid.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace raytruth::python {

/// Voxels that Python holds.
class Volume {
 public:
  Volume(std::shared_ptr<const Grid> grid, std::string name) : grid_(std::move(grid)), name_(std::move(name)) {}

  /// Copies an array of three axes of any real type, indexed [z, y, x], or [x, y, z] if `order` is "xyz". Throws
  /// InputError.
  static Volume from_array(const pybind11::array& array, const std::array<double, 3>& spacing, const std::string& order,
                           std::optional<double> nan, const std::string& name);

  [[nodiscard]] const std::shared_ptr<const Grid>& grid() const { return grid_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The voxels as a read-only array [z, y, x] that keeps them alive.
  [[nodiscard]] pybind11::array_t<double> array() const;

 private:
  std::shared_ptr<const Grid> grid_;
  std::string name_;
};

void add_volume(pybind11::module_& module);

}  // namespace raytruth::python
