// The library's errors as exceptions of Python.
#pragma once
#include <nanobind/nanobind.h>

namespace dreampm::python {

/// Adds Error, InputError, RunError and NumericalFailure to the module, and throws these where the
/// library throws its own. An Interrupted that no signal explains is a KeyboardInterrupt.
void bind_errors(nanobind::module_& module);

}  // namespace dreampm::python
