// The shapes of colliders as Bullet knows them.
#pragma once
#include <btBulletCollisionCommon.h>

#include <memory>
#include <vector>

#include "dreampm/pose.h"
#include "dreampm/state/rigid_body.h"

namespace dreampm {

/// A shape that Bullet asks for its bounds, and for its convex hull where it meets walls; else it
/// is met by distances (rigid/distance_contacts.h).
class DistanceShape final : public btConvexHullShape {
 public:
  DistanceShape() { m_shapeType = CUSTOM_POLYHEDRAL_SHAPE_TYPE; }
  /// Within which it stands, and moves in the step to come [m].
  btVector3 least{}, most{};

  void getAabb(const btTransform&, btVector3& low, btVector3& high) const override { low = least, high = most; }
};

/// A collider as Bullet knows it: a form, and where it stands in the collider.
struct Form {
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<btCollisionShape> shape;
  Pose placement;
  bool by_distance = false;  ///< `shape` is a DistanceShape
  std::vector<Vec3d> hull;   ///< m, in the collider: of one by distance
};

/// Returns the pose of a shape's form within the shape.
Pose placement_of(const Shape& shape);

/// `margin` [m]: half of what two bodies may be apart and still touch. `corner` [m]: from where the
/// vertices of meshes count. A rigid body whose convex hull is much larger than itself, and what
/// changes its surface, are met by distance.
Form form_of(const CollisionShape& collision, const Collider& collider, double margin, const Vec3d& corner);

}  // namespace dreampm
