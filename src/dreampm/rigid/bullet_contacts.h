// Impacts of rigid bodies by the Bullet library.
#pragma once
#include <memory>
#include <vector>

#include "dreampm/solver/rigid_motion.h"

namespace dreampm {

/// A closed wall of the box, as bodies meet it: the half-space before `point`, on the side of
/// `normal`.
struct BodyWall {
  Vec3d point, normal;
};

/// `shapes`: of each collider. `walls`: closed ones. `length` [m]: of a cell, by which margins are
/// measured.
std::unique_ptr<BodyContacts> make_bullet_contacts(const std::vector<CollisionShape>& shapes,
                                                   const std::vector<BodyWall>& walls, double length);

/// Of a world with rigid bodies; null of one without.
template <class R>
std::unique_ptr<BodyContacts> make_body_contacts(const World<R>& world);

}  // namespace dreampm
