#include "dreampm/rigid/rigid_motion.h"

#include <cmath>

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
    twist.spin += inverse(inertia) * (torque - gyroscopic_torque(inertia, twist.spin) * dt);
    lock(body, twist);
  }
  if (!contacts) return;
  contacts->resolve(world.colliders, world.rigid, before, dt);
  for (const RigidBody& body : world.rigid) lock(body, world.colliders[body.collider].twist);
}

template <class R>
void wrap_bodies(World<R>& world) {
  const Box3d box = world.domain();
  for (const RigidBody& body : world.rigid) {
    if (body.spring || body.hold) continue;
    Collider& c = world.colliders[body.collider];
    for (int a = 0; a < 3; ++a) {
      if (!world.periodic[static_cast<std::size_t>(a)]) continue;
      const double length = box.size()[a], shift = -length * std::floor((c.twist.center[a] - box.min[a]) / length);
      if (shift == 0) continue;
      c.twist.center[a] += shift, c.pose.position[a] += shift, c.surface_pose.position[a] += shift;
    }
  }
}

template void wrap_bodies(World<float>&);
template void wrap_bodies(World<double>&);
template void move_bodies(World<float>&, const GridStats&, double, BodyContacts*);
template void move_bodies(World<double>&, const GridStats&, double, BodyContacts*);

}  // namespace dreampm
