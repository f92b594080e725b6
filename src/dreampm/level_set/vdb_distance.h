// The two steps that OpenVDB does for level sets of meshes, behind plain data.
#pragma once
#include "dreampm/geometry/brick_grid.h"
#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// Distance >= 0 [voxels] to the nearest triangle of a mesh whose vertices are given in voxels, in
/// bricks near it; clamped to `band`. Bricks with no value are further than `band` (marked
/// outside). The grid has a margin of one brick.
BrickGrid unsigned_distance(const TriMesh& mesh, float band);

/// The distance >= 0 to the zero surface of a signed `field`, of which only the values near zero
/// and the signs are used, in bricks of the same box. That surface is closed, so this is a distance
/// also where the field jumps.
BrickGrid closed_distance(const BrickGrid& field);

}  // namespace dreampm
