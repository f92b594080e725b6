// Leaves out the part of a thing that is before a plane, to look inside.
#pragma once
#include <initializer_list>
#include <vector>

#include "dreampm/render/render.h"

namespace dreampm {

struct CutPlane {
  Vec3d point{};   ///< m
  Vec3d normal{};  ///< of unit length; what lies on this side is left out
  bool before(const Vec3f& p) const { return dot(static_cast<Vec3d>(p) - point, normal) > 0; }
};

/// Cuts a closed mesh, and closes it again by a flat face on the plane. `colors`: one a vertex, or
/// empty; cut with it. The mesh's velocities are dropped.
void cut_mesh(TriMesh& mesh, std::vector<Vec3f>& colors, const CutPlane& plane);

/// Drops the points before the plane, and what they have: colors and velocities, one each or none.
void cut_points(std::vector<Vec3f>& points, std::initializer_list<std::vector<Vec3f>*> theirs, const CutPlane& plane);

}  // namespace dreampm
