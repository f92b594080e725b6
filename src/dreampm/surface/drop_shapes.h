// Drops too small for the grid: spheres, and caps on what they touch.
#pragma once
#include <span>

#include "dreampm/surface/drops.h"

namespace dreampm::surface {

/// Between the surface of water and a glass that is not quite clean, in the water [rad]: 50
/// degrees.
inline constexpr float contact_angle = 0.873f;

/// Adds the drops to the mesh, each of its own volume; velocities only if the mesh has. One whose
/// middle is nearer than its radius to a wall or a solid lies there as a spherical cap, which
/// reaches `depth` [m] into it; others are spheres, moved off the walls so that they fit.
void add_small_drops(TriMesh& mesh, std::span<const SmallDrop> drops, const Bounds& bounds, float spacing, float depth);

}  // namespace dreampm::surface
