#include "dreampm/solver/projection/collider_steps.h"

#include "dreampm/rigid/rigid_motion.h"
#include "dreampm/state/rigid_body.h"

namespace dreampm {

template <class R>
void move_to_end(World<R>& world, double dt, bool rigid) {
  for (Collider& c : world.colliders) {
    if (c.rigid != rigid) continue;
    c.advance(dt);
    if (c.path) c.pose = c.path->pose_at(world.time + dt);
    if (c.changing) c.time = world.time + dt;
    if (c.moves()) c.settle(c.slack * world.dx);
  }
}

template <class R>
void free_bodies(World<R>& world, const Vec3d& gained, double kick, bool turn) {
  for (const RigidBody& body : world.rigid) {
    Collider& c = world.colliders[body.collider];
    const Mat3d inertia = inertia_now(body, c);
    const Vec3d spin = c.twist.spin;
    c.twist = free_twist(body, c, gained, kick);
    if (turn) c.twist.spin -= inverse(inertia) * gyroscopic_torque(inertia, spin) * kick;
    lock(body, c.twist);
  }
}

#define DM_INSTANTIATE(R)                             \
  template void move_to_end(World<R>&, double, bool); \
  template void free_bodies(World<R>&, const Vec3d&, double, bool);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
