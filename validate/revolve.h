// Meshes that are turned on a lathe.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/geometry/mesh.h"

namespace dreampm::validate {

/// A point of a profile [m]: distance from the axis, height.
struct ProfilePoint {
  double radius, height;
};

/// The solid that a closed profile sweeps as it turns about a vertical axis through `foot`, in
/// `steps` steps. The profile goes round counter-clockwise (radius to the right, height upwards);
/// its last point joins its first. Points on the axis have the radius 0.
TriMesh revolved(const std::vector<ProfilePoint>& profile, const Vec3d& foot, int steps);

}  // namespace dreampm::validate
