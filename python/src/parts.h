// What stands behind sim.particles, sim.materials, sim.walls, sim.colliders and sim.probes: names,
// and what they name.
#pragma once
#include "held.h"

namespace dreampm::python {

struct ParticleSets : PartOf {};
struct Materials : PartOf {};
struct Walls : PartOf {};
struct Colliders : PartOf {};
struct Probes : PartOf {};

}  // namespace dreampm::python
