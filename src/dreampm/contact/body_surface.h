// The surface of a rigid body as points that are found once and move with it. Points found anew
// where the body stands would change in number as it moves, and with them the push of the same
// water: a floating body would never come to rest.
#pragma once
#include <vector>

#include "dreampm/contact/collider_view.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// A part of the surface of a body, in the frame of its shape.
struct BodyPoint {
  Vec3d at;         ///< m
  Vec3d normal;     ///< outward
  Vec3d from_edge;  ///< as SurfacePoint::from_edge
  double area;      ///< [dx^2]
};

/// The points of the surface of a shape, one for each cell of `dx` [m] that it cuts and each way
/// that it faces there. The cells lie along the axes of the shape, evenly about the middle of its
/// bounds. Their areas are corrected by the least relative change with which the sums over the
/// points keep the divergence theorem: a constant pressure gives neither force nor torque, and one
/// that grows along an axis gives what the shape's volume displaces.
std::vector<BodyPoint> body_points(const std::shared_ptr<const Region>& shape, double dx);

}  // namespace dreampm
