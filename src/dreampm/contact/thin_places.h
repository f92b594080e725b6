// Thin places: walls and edges of about a cell, which splines between nodes do not resolve.
// Particles there need their exact distance.
#pragma once
#include <cstdint>

#include "dreampm/contact/body_kernel.h"
#include "dreampm/contact/collider_view.h"

namespace dreampm {

/// Cells from a surface within which particles are given their exact distance where they need it: a
/// particle is put back from half a cell before a surface at most, as far as it moves in a step.
constexpr double thin_places_reach = 0.5 + 0.87;

/// True if splines between nodes do not resolve the solid behind the surface that is nearest to a
/// free place, `distance` away.
bool needs_distance(const ColliderView& view, const Vec3d& at, double distance);

/// The cells of the view's block in which particles need their exact distance, a bit each: those of
/// free places that need it, and all around them, for a particle just inside of a collider to be
/// put back.
std::uint64_t thin_cells(const ColliderView& view);

/// The same of one rigid body, whatever is beside it.
std::uint64_t thin_cells(const ColliderView& view, std::uint16_t body, const BodyKernel& kernel);

}  // namespace dreampm
