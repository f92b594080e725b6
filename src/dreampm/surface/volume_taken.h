// The volume that particles take, from how densely they lie.
#pragma once
#include "dreampm/surface/surface.h"

namespace dreampm {

/// The volume [m^3] that the particles take: what they have at rest, spacing^3 each, over their
/// density, which is read from a grid as the simulation reads it. What a reading lacks at a surface
/// is put right by its slope, so that a layer on a wall counts right within 3 % from three spacings
/// of depth on, one in the air from five (of four it counts 4 % too much); of drops and thinner
/// sheets a reading says little, and they count as at rest; so do fewer particles than fill the 27
/// cells of a kernel. Uses positions, spacing, walls and is_wall. The result does not depend on the
/// number of threads. Throws RunError for a position that is not finite.
double volume_taken(const SurfaceInput& input);

}  // namespace dreampm
