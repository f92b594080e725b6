#include "dreampm/solver/rigid_motion.h"

namespace dreampm {
template <class R>
void move_bodies(World<R>& world, const GridStats& grid, double dt, BodyContacts* contacts) {
  const Vec3d kick = world.gravity_over(dt) * dt;
  std::vector<Twist> before;
  for (const RigidBody& body : world.rigid) {
    Collider& c = world.colliders[body.collider];
    Twist& twist = c.twist;
    before.push_back(twist);
    const ImpulseSum& given = grid.colliders.at(body.collider);  // to the matter
    const Vec3d torque = cross(twist.center, given.impulse) - given.angular;
    const Mat3d inertia = inertia_now(body, c);
    twist = free_twist(body, c, kick, dt);
    twist.velocity -= given.impulse / body.mass;
    // Euler's equations: spin x (I spin) turns the angular momentum with the body.
    twist.spin += inverse(inertia) * (torque - cross(twist.spin, inertia * twist.spin) * dt);
    lock(body, twist);
  }
  if (!contacts) return;
  contacts->resolve(world.colliders, world.rigid, before, dt);
  for (const RigidBody& body : world.rigid) lock(body, world.colliders[body.collider].twist);
}

template void move_bodies(World<float>&, const GridStats&, double, BodyContacts*);
template void move_bodies(World<double>&, const GridStats&, double, BodyContacts*);

}  // namespace dreampm
