#include "python_host.h"

#include <nanobind/stl/string.h>

namespace nb = nanobind;

namespace dreampm::python {

void PythonHost::log(const char* level, const std::string& line) {
  const nb::gil_scoped_acquire held;
  nb::module_::import_("logging").attr("getLogger")("dreampm").attr(level)("%s", line);
}

bool PythonHost::stop_requested() {
  if (raised_) return true;
  const auto now = std::chrono::steady_clock::now();
  if (now - asked_ < std::chrono::milliseconds(50)) return false;
  asked_ = now;
  const nb::gil_scoped_acquire held;
  if (PyErr_CheckSignals() == 0) return false;
  raised_.emplace();  // takes the exception at hand
  return true;
}

}  // namespace dreampm::python
