// The parts of the module, a file each.
#pragma once
#include <nanobind/nanobind.h>

namespace dreampm::python {

void bind_values(nanobind::module_& module);         ///< reports, poses, shapes, snapshots
void bind_model(nanobind::module_& module);          ///< dreampm.model
void bind_scene(nanobind::module_& module);          ///< Scene
void bind_matter(nanobind::module_& module);         ///< Particles, Mesh, write_png
void bind_device_arrays(nanobind::module_& module);  ///< DeviceParticles, DeviceArray
void bind_parts(nanobind::module_& module);          ///< materials, walls and colliders of a simulation
void bind_reads(nanobind::module_& module);          ///< what is read of a simulation, rays
void bind_simulation(nanobind::module_& module);     ///< Simulation, render
void bind_observers(nanobind::module_& module);      ///< Simulation.attach
void bind_pipeline(nanobind::module_& module);       ///< make, validate

}  // namespace dreampm::python
