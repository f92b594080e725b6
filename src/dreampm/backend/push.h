// What walls, colliders and all else that acts on nodes gave to matter.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm {

/// What matter received in a step from one source.
struct Push {
  Vec3d impulse{};  ///< N s
  Vec3d angular{};  ///< N m s about the scene's origin
  double work = 0;  ///< J: of damping, the change of the nodes' kinetic energy; of walls and colliders, that of their
                    ///< impulse at the velocity after it, so that stopping a node is none and sliding is; of fields, at
                    ///< that after all
  void add(const Vec3d& at, double mass, const Vec3d& before, const Vec3d& after, const Vec3d& moved_at) {
    const Vec3d received = (after - before) * mass;
    impulse += received;
    angular += cross(at, received);
    work += dot(received, moved_at);
  }
  Push& operator+=(const Push& b) {
    impulse += b.impulse;
    angular += b.angular;
    work += b.work;
    return *this;
  }
  /// The same about the scene's origin, of a push whose places are cells of `dx` [m] from `first` [m] on.
  Push from_cells(const Vec3d& first, double dx) const { return {impulse, cross(first, impulse) + angular * dx, work}; }
};

}  // namespace dreampm
