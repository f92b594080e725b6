// Matter that emitters bring in between steps.
#pragma once
#include <cstdint>

#include "dreampm/backend/backend.h"

namespace dreampm {

/// Sums of the matter that came in.
struct Entered {
  std::uint64_t particles = 0;
  double mass = 0;    ///< kg
  Vec3d momentum{};   ///< kg m/s
  Vec3d angular{};    ///< kg m^2/s about the scene's origin
  double energy = 0;  ///< J, kinetic and of gravity
  Entered& operator+=(const Entered& b);
};

template <class R>
class Solver;

/// Brings in what emitters gave since the last call, before the step that comes. Nothing is born
/// within half a spacing of matter that is there, inside of a collider or a rigid body, or where a
/// jet comes back to its tap round a periodic axis. Changes the order of particles: `motion`, of
/// the last step, no longer fits.
template <class R>
Entered emit(World<R>& world, Backend<R>& backend, Solver<R>& solver, Motion<R>& motion);

/// The largest speed [m/s] of matter that comes in from now to `ahead` [s] later.
template <class R>
double emission_speed(const World<R>& world, double ahead);

}  // namespace dreampm
