// Impacts of rigid bodies by the Bullet library.
#pragma once
#include <memory>
#include <vector>

#include "dreampm/rigid/rigid_motion.h"

namespace dreampm {

/// A closed wall of the box, as bodies meet it: the half-space before `point`, on the side of
/// `normal`.
struct BodyWall {
  Vec3d point, normal;
};

/// The space in which bodies meet.
struct BodyRoom {
  std::vector<BodyWall> walls;  ///< closed ones
  Box3d box;                    ///< m
  Vec3d period;                 ///< m, of periodic axes; else 0
  double cell = 0;              ///< m, by which margins are measured
};

/// `shapes`: of each collider; the vertices of their meshes count from the low corner of the box.
std::unique_ptr<BodyContacts> make_bullet_contacts(const std::vector<CollisionShape>& shapes, const BodyRoom& room,
                                                   BodyContacts* before = nullptr);

/// Makes the contacts of a world with rigid bodies; null for one without. `before`: those of the
/// same world with other colliders, which may be null: data of meshes that stay is taken over.
template <class R>
std::unique_ptr<BodyContacts> make_body_contacts(const World<R>& world, BodyContacts* before = nullptr);

}  // namespace dreampm
