// Rigid bodies: colliders that move as forces and impulses make them.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "dreampm/geometry/mesh.h"
#include "dreampm/math/mat3.h"
#include "dreampm/physics/spring.h"
#include "dreampm/shape.h"
#include "dreampm/state/collider.h"

namespace dreampm {

/// A rigid body: it moves the pose and twist of its collider. The center of the twist is its center
/// of mass.
struct RigidBody {
  std::size_t collider = 0;           ///< of World::colliders
  double mass = 1;                    ///< kg
  Vec3d center{};                     ///< m: of mass, in the shape as the scene gives it
  Mat3d inertia = Mat3d::identity();  ///< kg m^2 about the center of mass, in the axes of that shape
  double restitution = 0;             ///< of impacts with bodies, walls and colliders
  /// Components of velocity and spin along the axes of the scene that stay 0: x, y, z, rx, ry, rz.
  std::array<bool, 6> locked{};
  std::optional<Spring> spring{};
  std::optional<Hold> hold{};  ///< besides
};

/// The inertia of a body as it stands, in the axes of the scene [kg m^2].
inline Mat3d inertia_now(const RigidBody& body, const Collider& collider) {
  const Quaternion& q = collider.pose.rotation;
  const Vec3d x = q({1, 0, 0}), y = q({0, 1, 0}), z = q({0, 0, 1});
  const Mat3d r{{x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z}};
  return r * body.inertia * transpose(r);
}
/// spin x (I spin) of Euler's equations, which turns the angular momentum with the body [N m].
inline Vec3d gyroscopic_torque(const Mat3d& inertia, const Vec3d& spin) { return cross(spin, inertia * spin); }
/// Takes the locked components out of a twist of the body.
inline void lock(const RigidBody& body, Twist& twist) {
  for (int a = 0; a < 3; ++a) {
    if (body.locked[static_cast<std::size_t>(a)]) twist.velocity[a] = 0;
    if (body.locked[static_cast<std::size_t>(a) + 3]) twist.spin[a] = 0;
  }
}
/// The inverse of a symmetric matrix of full rank.
inline Mat3d inverse(const Mat3d& m) { return transpose(cofactor(m)) * (1 / determinant(m)); }

/// Adds to a twist of the body what the spring of a hold gives in a step of `dt` [s]. The impulse J
/// is implicit, and stable however stiff the spring is: with x and v of the held point and its
/// response K to an impulse, J = -dt (k (x - to) + (d + k dt) (v + K J)).
inline void pull(const RigidBody& body, const Collider& collider, const Hold& hold, double dt, Twist& twist) {
  const Mat3d turns = inverse(inertia_now(body, collider));
  const Vec3d at = collider.pose(hold.at), arm = at - twist.center;
  const auto& [to, stiffness, damping] = hold.spring;
  const double weight = dt * (damping + stiffness * dt);
  Mat3d resists = Mat3d::identity();
  for (int a = 0; a < 3; ++a) {
    Vec3d unit{};
    unit[a] = weight;
    const Vec3d gives = unit / body.mass + cross(turns * cross(arm, unit), arm);
    for (int b = 0; b < 3; ++b) resists(b, a) += gives[b];
  }
  const Vec3d impulse = inverse(resists) * ((at - to) * (-stiffness * dt) - twist.at(at) * weight);
  twist.velocity += impulse / body.mass;
  twist.spin += turns * cross(arm, impulse);
}

/// The twist that it has after a step of `dt` [s] in which no matter touches it: of gravity's
/// `kick` [m/s], and of its springs. Damping is implicit; so is a stiffness whose oscillation a
/// step does not resolve, which damps it.
inline Twist free_twist(const RigidBody& body, const Collider& collider, const Vec3d& kick, double dt) {
  const Twist& now = collider.twist;
  Twist next = now;
  next.velocity += kick;
  if (body.spring) {
    const double pull = body.spring->stiffness * dt / body.mass, phase2 = pull * dt;
    next.velocity = (next.velocity - (now.center - body.spring->to) * pull) /
                    (1 + body.spring->damping * dt / body.mass + (phase2 > 1 ? phase2 : 0));
  }
  if (body.hold) pull(body, collider, *body.hold, dt, next);
  lock(body, next);
  return next;
}

/// The shape with which a body meets others: the collider's shape, and its surface if that is no
/// box, sphere, cylinder or plane.
struct CollisionShape {
  Shape shape;
  std::shared_ptr<const TriMesh> mesh;  ///< m, as the scene gives it
  bool obstacle = true;                 ///< false of a pin, which bodies pass
};

}  // namespace dreampm
