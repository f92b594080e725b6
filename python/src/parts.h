// The mappings sim.particles, sim.materials, sim.walls, sim.colliders and sim.probes: names, and
// the objects of these names.
#pragma once
#include "held.h"

namespace dreampm::python {

struct ParticleSets : PartOf {};
struct Materials : PartOf {};
struct Walls : PartOf {};
struct Colliders : PartOf {};
struct Probes : PartOf {};

}  // namespace dreampm::python
