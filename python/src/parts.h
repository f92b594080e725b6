// What stands behind sim.particles, sim.materials, sim.walls and sim.colliders: names, and what
// they name.
#pragma once
#include "held.h"

namespace dreampm::python {

struct ParticleSets : PartOf {};
struct Materials : PartOf {};
struct Walls : PartOf {};
struct Colliders : PartOf {};

}  // namespace dreampm::python
