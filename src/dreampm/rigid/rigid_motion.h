// How rigid bodies move in a step: what matter gave, gravity, and impacts among them.
#pragma once
#include <memory>

#include "dreampm/backend/backend.h"

namespace dreampm {

/// Impacts of rigid bodies with each other, with colliders and walls.
class BodyContacts {
 public:
  virtual ~BodyContacts() = default;
  /// Changes the twists of the rigid bodies so that in a step of `dt` [s] from where they stand
  /// they do not enter each other, colliders or walls. `before`: of each body, before the forces of
  /// the step; what an impact gives back counts from there. A pure function of its arguments:
  /// nothing is kept from step to step, so that restarts are exact.
  virtual void resolve(std::vector<Collider>& colliders, const std::vector<RigidBody>& bodies,
                       const std::vector<Twist>& before, double dt) = 0;
};

/// Gives the bodies what gravity and matter gave them in a step of `dt`, whose contact `grid`
/// holds: the opposite of what matter received. Momentum is conserved to rounding. Then impacts, if
/// `contacts` is there.
template <class R>
void move_bodies(World<R>& world, const GridStats& grid, double dt, BodyContacts* contacts);

/// Brings rigid bodies that left through a periodic end in at the other. One that a spring or a
/// hand pulls to a point stays on its side of it.
template <class R>
void wrap_bodies(World<R>& world);

}  // namespace dreampm
