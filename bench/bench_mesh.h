// A mesh for benches.
#pragma once
#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// A ball with three lobes about the axis y, of about that many faces.
TriMesh lobed_ball(const Vec3d& middle, double radius, int faces);

}  // namespace dreampm
