// Contact of bodies by signed distances: of those with hollows, which a convex hull would fill, and
// of colliders whose surface changes.
#pragma once
#include <btBulletDynamicsCommon.h>

#include <memory>

#include "dreampm/rigid/contact_context.h"

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

/// Points of the surface of a body [m], in the collider: about one a cell of `dx` [m], and the
/// corners of what has some.
std::vector<Vec3d> contact_points(const Collider& collider, const Shape& shape, double dx);

}  // namespace dreampm
