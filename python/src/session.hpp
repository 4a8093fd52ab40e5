// Solves one after another, which reuse what did not change.
#pragma once

#include <pybind11/pybind11.h>

namespace sunfleck::python {

void bind_session(pybind11::module_& module);

}  // namespace sunfleck::python
