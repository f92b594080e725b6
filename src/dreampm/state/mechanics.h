// Energy and angular momentum of one particle, its affine motion included.
#pragma once
#include "dreampm/math/mat3.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Returns the mass of all particles [kg].
template <class R>
double mass_of(const World<R>& world) {
  double mass = 0;
  for (const ParticleSet<R>& set : world.sets) mass += set.mass * static_cast<double>(set.size());
  return mass;
}

/// Returns the inertia of the affine part C of one particle of a set [kg m^2]: dx^2/4 per mass for
/// a quadratic kernel (Jiang et al. 2015), dx^2/6 for the trilinear kernel of the projection, in
/// the mean over places; 0 without an affine part.
template <class R>
double affine_inertia(const ParticleSet<R>& set, double dx) {
  return set.transfer.affine * set.mass * dx * dx / (set.carries_motion ? 6 : 4);
}
/// Returns the kinetic energy of one particle of a set [J].
template <class R>
double kinetic_energy(const ParticleSet<R>& set, double dx, const Vec3d& v, const Mat3d& c) {
  return 0.5 * set.mass * length2(v) + 0.5 * affine_inertia(set, dx) * norm2(c);
}
/// Returns the angular momentum about the origin of one particle at `x` [kg m^2/s].
template <class R>
Vec3d angular_momentum(const ParticleSet<R>& set, double dx, const Vec3d& x, const Vec3d& v, const Mat3d& c) {
  return cross(x, v) * set.mass +
         Vec3d{c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1)} * affine_inertia(set, dx);
}

}  // namespace dreampm
