// Contact of bodies by signed distances: of those with hollows, which a convex hull would fill, and
// of colliders whose surface changes.
#pragma once
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "dreampm/rigid/contact_context.h"
#include "dreampm/state/rigid_body.h"

namespace dreampm {

/// Bullet's own configuration, but for pairs of which one is a DistanceShape and the other no
/// plane: there the points of each meet the distance of the other.
class DistanceConfiguration final : public btDefaultCollisionConfiguration {
 public:
  DistanceConfiguration(const btDefaultCollisionConstructionInfo& pools, const ContactContext& context);
  btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int type0, int type1) override;

 private:
  std::unique_ptr<btCollisionAlgorithmCreateFunc> by_distance_;
};

/// The corners of a collider [m], in it: of a box and of a mesh, points about the rims of a
/// cylinder, and the middle of a ball. The vertices of meshes count from `corner` [m].
std::vector<Vec3d> corner_points(const CollisionShape& collision, const Vec3d& corner);

/// The corners of a body, and of what is no ball points of its surface, about one a cell of `dx`
/// [m].
std::vector<Vec3d> contact_points(const Collider& collider, const CollisionShape& collision, const Vec3d& corner,
                                  double dx);

}  // namespace dreampm
