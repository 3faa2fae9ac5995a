#pragma once

#include <pybind11/pybind11.h>

namespace raytruth::python {

/// Signal, Integral, Rays, and the functions integral, rays and slab.
void add_integrals(pybind11::module_& module);

}  // namespace raytruth::python
