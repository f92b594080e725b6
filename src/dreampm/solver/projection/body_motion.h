// Rigid bodies in the equations of the projection: six velocities each, that impulses change.
#pragma once
#include <array>

#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/state/rigid_body.h"

namespace dreampm {

/// Along x, y, z, and about them: velocities and spins, or impulses and angular impulses.
using Six = std::array<double, 6>;
/// Symmetric.
using SixBySix = std::array<Six, 6>;

inline double dot(const Six& a, const Six& b) {
  double sum = 0;
  for (std::size_t n = 0; n < 6; ++n) sum += a[n] * b[n];
  return sum;
}
inline Six operator*(const SixBySix& m, const Six& x) {
  Six y;
  for (std::size_t n = 0; n < 6; ++n) y[n] = dot(m[n], x);
  return y;
}

/// The velocity along an axis at `arm` [m] from the center, for each component of a body's twist.
Six along_axis(int axis, const Vec3d& arm);

/// The way [m] from the center of a collider's twist to a place `way` cells from the low corner of
/// a cell, on periodic axes to the nearest copy of it.
template <class R>
Vec3d arm_to(const World<R>& world, const Collider& collider, const Vec3i& cell, const Vec3d& way);

/// Mass and inertia, and their inverse: what a twist changes by for an impulse. Of locked
/// components the first is that of 1 kg and the second 0.
SixBySix mass_of(const RigidBody& body, const Collider& collider);
SixBySix response_of(const RigidBody& body, const Collider& collider);

/// The inverse of one that is positive definite.
SixBySix inverse(SixBySix m);

inline void add(Twist& twist, const Six& change) {
  twist.velocity += Vec3d{change[0], change[1], change[2]};
  twist.spin += Vec3d{change[3], change[4], change[5]};
}

}  // namespace dreampm
