// The Python module `raytruth`: the library and its documents for numpy. raytruth.pyi, beside this file, says what
// everything takes and gives.

#include "experiments/output.hpp"
#include "experiments/version.hpp"
#include "python/documents.hpp"
#include "python/images.hpp"
#include "python/integrals.hpp"
#include "python/transfer_function.hpp"
#include "python/volume.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/memory_limit.hpp"
#include "raytruth/volume/files/read_volume.hpp"

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <optional>

namespace py = pybind11;

namespace {

constexpr const char* about =
    "Exact rays through volumes, and how far the schemes of volume rendering are from them.\n\n"
    "Errors are raytruth.InputError with the line that the program would print; what the program remarks on is\n"
    "warned of as raytruth.InputWarning. Work is done on all cores, without the interpreter lock.";

/// Bytes that one volume, image or document may need: tells it, and sets it where it is given.
std::uint64_t limit_of_memory(std::optional<std::uint64_t> bytes) {
  if (bytes) raytruth::set_memory_limit(*bytes);
  return raytruth::memory_limit();
}

}  // namespace

PYBIND11_MODULE(raytruth, module) {
  module.doc() = about;
  module.attr("__version__") = fmt::format("{}", raytruth::version);
  py::register_exception<raytruth::InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<raytruth::MissingError>(module, "MissingError", PyExc_RuntimeError);
  py::register_exception<raytruth::OutputError>(module, "OutputError", PyExc_OSError);
  module.attr("InputWarning") =
      py::reinterpret_steal<py::object>(PyErr_NewException("raytruth.InputWarning", PyExc_UserWarning, nullptr));
  raytruth::set_memory_limit(raytruth::memory_of_machine() / 4);
  module.def("memory_limit", &limit_of_memory, py::arg("bytes") = py::none(),
             "Bytes that one thing may need which a file or document announces (default: a quarter of the memory).");
  raytruth::python::add_volume(module);
  raytruth::python::add_transfer_function(module);
  raytruth::python::add_integrals(module);
  raytruth::python::add_images(module);
  raytruth::python::add_documents(module);
}
