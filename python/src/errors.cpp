#include "errors.h"

#include <string>

#include "dreampm/error.h"

namespace nb = nanobind;

namespace dreampm::python {
namespace {

struct Exceptions {
  nb::object input, run, numerical;
};

nb::object add_exception(nb::module_& module, const char* name, const char* doc, nb::handle bases) {
  const std::string whole = nb::cast<std::string>(module.attr("__name__")) + "." + name;
  nb::object made = nb::steal(PyErr_NewExceptionWithDoc(whole.c_str(), doc, bases.ptr(), nullptr));
  if (!made.is_valid()) nb::raise_python_error();
  module.attr(name) = made;
  return made;
}

void translate(const std::exception_ptr& thrown, void* payload) {
  const auto& to = *static_cast<const Exceptions*>(payload);
  try {
    std::rethrow_exception(thrown);
  } catch (const NumericalFailure& e) {
    PyErr_SetString(to.numerical.ptr(), e.what());
  } catch (const RunError& e) {
    PyErr_SetString(to.run.ptr(), e.what());
  } catch (const InputError& e) {
    PyErr_SetString(to.input.ptr(), e.what());
  } catch (const Interrupted& e) {
    PyErr_SetString(PyExc_KeyboardInterrupt, e.what());
  }
}

}  // namespace

void bind_errors(nb::module_& module) {
  const nb::object error =
      add_exception(module, "Error", "What the library raises. The text says what would be right.", PyExc_Exception);
  const nb::object input =
      add_exception(module, "InputError",
                    "Something given is wrong: a scene, a mesh, an argument. Errors of a scene have a line each,\n"
                    "FILE:LINE:COLUMN: what is wrong, and what would be right.",
                    nb::make_tuple(error, nb::handle(PyExc_ValueError)));
  const nb::object run = add_exception(module, "RunError", "The run itself failed: numbers, memory, disk.",
                                       nb::make_tuple(error, nb::handle(PyExc_RuntimeError)));
  const nb::object numerical =
      add_exception(module, "NumericalFailure",
                    "The numbers of a step stopped being numbers, or a step cannot be taken. The simulation can then\n"
                    "only be restored.",
                    run);
  // A translator cannot be taken back: what it reads is there until the process ends.
  nb::register_exception_translator(translate, new Exceptions{input, run, numerical});
}

}  // namespace dreampm::python
