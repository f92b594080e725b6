// Description of a force field: one table feeds parser, messages and the written scene.
//
// A field is a struct with
//   name, help       how scenes call it, and what it does
//   params           its table: numbers and vectors of the struct, in the order of the scene
//   Step<R>          one step of dt at a node: built once a step by Step<R>::of(field, dt); R: float or double
//     (v, x)         the velocity after dt [m/s] of a node at x [m] that moves at v and feels nothing else
//     fastest(s, x)  a bound of |velocity| after dt at x, for any velocity of at most s [m/s]; never below s, and it
//                    must not fall with dt
//   head(passage)    the most energy that it can give on the way [m^2/s^2 = J/kg], at least 0: what gravity gives is
//                    g h. Held back, matter presses with density * head; let go, it comes to sqrt(2 head). A liquid's
//                    sound has to be fast beside that (setup/assemble.cpp)
//   bounds()         optional: a box [m] outside of which it does nothing
#pragma once
#include <array>

#include "dreampm/physics/member_param.h"

namespace dreampm {

/// The way of matter through a field.
struct Passage {
  Box3d from;                     ///< where it may come from [m]
  Box3d within;                   ///< where it may go, and the field acts [m]
  std::array<bool, 3> endless{};  ///< along which axes it may go round and round: there `from` is as `within`
};

/// Returns the work per mass of a constant acceleration a [m/s^2] from the farthest corner of
/// `from` against it to the farthest corner of `within` along it [m^2/s^2].
inline double head_of(const Vec3d& a, const Passage& p) {
  double head = 0;
  for (int i = 0; i < 3; ++i)
    head += a[i] * (a[i] > 0 ? p.within.max[i] - p.from.min[i] : p.within.min[i] - p.from.max[i]);
  return head > 0 ? head : 0;
}

/// Returns the kinetic energy per mass [m^2/s^2] of matter that was drawn to the velocity u [m/s]
/// round by round, beyond the energy of one round.
inline double head_of_rounds(const Vec3d& u, const Passage& p) {
  double head = 0;
  for (int i = 0; i < 3; ++i) head += p.endless[static_cast<std::size_t>(i)] ? u[i] * u[i] / 2 : 0;
  return head;
}

}  // namespace dreampm
