// Water that meets glass. The surface of a liquid wraps particles: it ends a fraction of a cell
// short of a wall, or inside of it. What overlaps is the ranks' affair (interface.h); what falls
// short is stretched over the gap here, or a film of air would mirror there.
#pragma once
#include <optional>

#include "dreampm/render/render.h"

namespace dreampm::trace {

/// The mesh of a clear `object` with its vertices near clear objects of a higher priority brought
/// into those: vertices that face such a surface within scene.wetting, and come less near the
/// further off they are. A vertex within `hair` [m] of a wall of the basin keeps to that. Nothing
/// where there is nothing to do. Throws RunError if Embree fails.
std::optional<TriMesh> wetted(const RenderScene& scene, const RenderObject& object, float hair);

}  // namespace dreampm::trace
