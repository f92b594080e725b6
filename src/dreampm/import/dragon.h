// A little dragon, made by code.
#pragma once
#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// A closed mesh of some 10,000 triangles: body, neck, head with horns, wings, legs, tail and a
/// ridge of spikes, rounded into one. It stands on y = 0, looks along +x, and is 3.2 units long.
TriMesh little_dragon();

}  // namespace dreampm
