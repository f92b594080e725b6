// Bullet's world for one step, with impacts that give back what restitution says whatever the
// length of the step.
#pragma once
#include <btBulletDynamicsCommon.h>

#include "dreampm/rigid/contact_context.h"

namespace dreampm {

/// Finds contacts as far ahead as bodies come in the step, so that they do not enter each other.
class ImpactDispatcher final : public btCollisionDispatcher {
 public:
  ImpactDispatcher(btCollisionConfiguration* configuration, const ContactContext& context)
      : btCollisionDispatcher(configuration), context_(context) {}
  btPersistentManifold* getNewManifold(const btCollisionObject* a, const btCollisionObject* b) override;

 private:
  const ContactContext& context_;
};

/// An impact at speed s, before the forces of the step, is to end at e s where the surfaces meet:
/// what a gap and the relative acceleration a add on the way there and back counts, so that
/// s'^2 = e^2 (s^2 + 2 a gap) - 2 a gap. Bullet's own takes the speed after the forces, and loses
/// all of it at a gap. What comes no faster than a dt, which forces give within a step, is at rest.
class ImpactWorld final : public btDiscreteDynamicsWorld {
 public:
  ImpactWorld(btDispatcher* dispatcher, btBroadphaseInterface* pairs, btConstraintSolver* solver,
              btCollisionConfiguration* configuration, const ContactContext& context)
      : btDiscreteDynamicsWorld(dispatcher, pairs, solver, configuration), context_(context) {}

  void solveConstraints(btContactSolverInfo& settings) override;

 private:
  void prepare(btManifoldPoint& point, const btCollisionObject& a, const btCollisionObject& b, double push_apart) const;
  const ContactContext& context_;
};

}  // namespace dreampm
