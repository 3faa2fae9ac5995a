#pragma once

#include <pybind11/pybind11.h>

namespace raytruth::python {

/// Image, and the functions render, read_image and compare.
void add_images(pybind11::module_& module);

}  // namespace raytruth::python
