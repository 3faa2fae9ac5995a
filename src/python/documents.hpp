#pragma once

#include <pybind11/pybind11.h>

namespace raytruth::python {

/// What takes and gives documents, as the program's commands do: evaluate, table, vectors, score, available, run,
/// advise.
void add_documents(pybind11::module_& module);

}  // namespace raytruth::python
