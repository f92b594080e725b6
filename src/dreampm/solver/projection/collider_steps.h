// Colliders and rigid bodies in a step of the projection.
#pragma once
#include "dreampm/state/world.h"

namespace dreampm {

/// Moves colliders to where they stand at the end of a step of `dt` [s]: rigid bodies or the
/// others.
template <class R>
void move_to_end(World<R>& world, double dt, bool rigid);

/// Gives rigid bodies the twist that they have without matter, `kick` [s] of forces later, of which
/// gravity gives `gained` [m/s]; `turn`: whether those that spin turn their axis, too.
template <class R>
void free_bodies(World<R>& world, const Vec3d& gained, double kick, bool turn);

}  // namespace dreampm
