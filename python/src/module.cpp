// The module _dreampm, which the package dreampm shows.
#include "bindings.h"
#include "dreampm/version.h"
#include "errors.h"

NB_MODULE(_dreampm, m) {
  namespace python = dreampm::python;
  m.doc() = "Simulation of liquids and solids by the material point method.";
  m.attr("version") = dreampm::version;
  python::bind_errors(m);
  python::bind_values(m);
  python::bind_model(m);
  python::bind_scene(m);
  python::bind_matter(m);
  python::bind_device_arrays(m);
  python::bind_parts(m);
  python::bind_reads(m);
  python::bind_simulation(m);
  python::bind_observers(m);
  python::bind_pipeline(m);
}
