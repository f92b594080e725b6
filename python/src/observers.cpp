// Observers that write files of a simulation while it runs.
#include "dreampm/observers.h"

#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "convert.h"
#include "held.h"

namespace dreampm::python {
namespace {

template <class Files>
void bind_attach(nb::handle simulation, const char* about) {
  nb::cpp_function_def(
      [](HeldSimulation& held, const Files& files) { held.call([&](Simulation& s) { attach(s, files); }); },
      nb::scope(simulation), nb::name("attach"), nb::is_method(), nb::arg("files"), about);
}

}  // namespace

void bind_observers(nb::module_& m) {
  using Path = std::filesystem::path;
  nb::class_<LedgerFile>(m, "LedgerFile", "A row a frame of mass, momentum and energy: for Simulation.attach.")
      .def("__init__", [](LedgerFile* self, Path file) { new (self) LedgerFile{std::move(file)}; }, nb::arg("file"));
  nb::class_<ParticleFiles>(m, "ParticleFiles", "A PLY file of all particles a frame: for Simulation.attach.")
      .def(
          "__init__",
          [](ParticleFiles* self, Path folder, std::vector<std::string> attributes) {
            new (self) ParticleFiles{std::move(folder), std::move(attributes)};
          },
          nb::arg("folder"), nb::arg("attributes") = std::vector<std::string>{"velocity"},
          "Attributes: velocity, f, j, jp, density, pressure, color.");
  nb::class_<ProbeFiles>(m, "ProbeFiles", "The rows of the scene's probes, a CSV file each: for Simulation.attach.")
      .def(
          "__init__", [](ProbeFiles* self, Path folder) { new (self) ProbeFiles{std::move(folder)}; },
          nb::arg("folder"));
  nb::class_<CheckpointFiles>(m, "CheckpointFiles", "Moments that Scene.load goes on from: for Simulation.attach.")
      .def(
          "__init__",
          [](CheckpointFiles* self, Path folder, int every, int keep) {
            new (self) CheckpointFiles{std::move(folder), every, keep};
          },
          nb::arg("folder"), nb::arg("every") = 10, nb::arg("keep") = 2,
          "After each `every` frames; the newest `keep` stay, 0: all.");
  const nb::object simulation = m.attr("Simulation");
  bind_attach<LedgerFile>(simulation, "Writes these files from now on, at the end of each frame.");
  bind_attach<ParticleFiles>(simulation, "The same of particles.");
  bind_attach<ProbeFiles>(simulation, "The same of probes.");
  bind_attach<CheckpointFiles>(simulation, "The same of moments to go on from.");
}

}  // namespace dreampm::python
