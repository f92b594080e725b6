#include "dreampm/rigid/impacts.h"

#include <algorithm>

#include "dreampm/rigid/bullet_vectors.h"

namespace dreampm {
namespace {

const ContactBody& body_of(const ContactContext& context, const btCollisionObject& object) {
  return context.bodies[static_cast<std::size_t>(object.getUserIndex())];
}

/// Moves a point of a contact to where it acts on a body: the contact may be one of its copy beyond
/// a periodic end.
void bring_home(btVector3& point, const ContactBody& body, const btCollisionObject& object) {
  point += bullet(to_nearest(from_bullet(point - object.getWorldTransform().getOrigin()), body.period));
}

}  // namespace

btPersistentManifold* ImpactDispatcher::getNewManifold(const btCollisionObject* a, const btCollisionObject* b) {
  btPersistentManifold* manifold = btCollisionDispatcher::getNewManifold(a, b);
  const double ahead = (body_of(context_, *a).speed + body_of(context_, *b).speed) * context_.dt;
  manifold->setContactBreakingThreshold(manifold->getContactBreakingThreshold() + ahead);
  return manifold;
}

void ImpactWorld::solveConstraints(btContactSolverInfo& settings) {
  for (int m = 0; m < m_dispatcher1->getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *m_dispatcher1->getInternalManifoldPointer()[m];
    for (int p = 0; p < manifold.getNumContacts(); ++p)
      prepare(manifold.getContactPoint(p), *manifold.getBody0(), *manifold.getBody1(), settings.m_erp2);
  }
  btDiscreteDynamicsWorld::solveConstraints(settings);
}

void ImpactWorld::prepare(btManifoldPoint& point, const btCollisionObject& a, const btCollisionObject& b,
                          double push_apart) const {
  const ContactBody &first = body_of(context_, a), &second = body_of(context_, b);
  bring_home(point.m_positionWorldOnA, first, a), bring_home(point.m_positionWorldOnB, second, b);
  const Vec3d on_a = from_bullet(point.m_positionWorldOnA) + context_.origin,
              on_b = from_bullet(point.m_positionWorldOnB) + context_.origin;
  const Vec3d normal = from_bullet(point.m_normalWorldOnB);  // from b to a
  const auto now = [](const ContactBody& body, const Vec3d& at) {
    return body.collider ? body.collider->velocity(at) : Vec3d{};
  };
  const auto before = [&](const ContactBody& body, const Vec3d& at) {
    return body.collider && body.collider->rigid ? body.before.at(at) : now(body, at);
  };
  const double gap = point.getDistance();
  const double speed_now = dot(now(second, on_b) - now(first, on_a), normal),
               speed = dot(before(second, on_b) - before(first, on_a), normal);
  const double gives = first.restitution * second.restitution;
  // The velocity of a changing surface in the body's frame, which Bullet's objects do not know
  // [m/s].
  const auto own = [](const ContactBody& body, const Vec3d& at) {
    return body.collider && body.collider->changing ? body.collider->velocity(at) - body.collider->twist.at(at)
                                                    : Vec3d{};
  };
  const double changes = dot(own(second, on_b) - own(first, on_a), normal);
  double apart = std::max(0.0, -gap) * push_apart / context_.dt;
  const double acceleration = (speed_now - speed) / context_.dt;
  const bool hits = speed_now * context_.dt > gap && gives > 0 && speed > std::max(acceleration * context_.dt, 0.0);
  if (hits) {
    const double fall = 2 * acceleration * gap, meets = speed * speed + fall;
    apart = std::max(apart, std::sqrt(std::max(0.0, gives * gives * std::max(0.0, meets) - fall)));
  } else if (gap > 0) {
    apart = -gap / context_.dt;  // as far as they may come
  }
  // Bullet parts what is d deep at d push_apart / dt, and lets what is apart come as far.
  apart += changes;
  point.m_combinedRestitution = 0;
  point.setDistance(apart > 0 ? -apart * context_.dt / push_apart : -apart * context_.dt);
}

}  // namespace dreampm
