// Impulse, angular impulse and work of walls, colliders and other sources.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm {

/// Impulse, angular impulse and work that matter received from one source in a step.
template <class R>
struct ImpulseSumOf {
  Vec3<R> impulse{};  ///< N s
  Vec3<R> angular{};  ///< N m s about the scene's origin
  /// J: of damping, the change of the nodes' kinetic energy; of walls and colliders, that of their
  /// impulse at the velocity after it, so that stopping a node is none and sliding is; of fields,
  /// at that after all.
  R work{};
  DM_FN void add(const Vec3<R>& at, const R& mass, const Vec3<R>& before, const Vec3<R>& after,
                 const Vec3<R>& moved_at) {
    const Vec3<R> received = (after - before) * mass;
    impulse += received;
    angular += cross(at, received);
    work += dot(received, moved_at);
  }
  DM_FN ImpulseSumOf& operator+=(const ImpulseSumOf& b) {
    impulse += b.impulse;
    angular += b.angular;
    work += b.work;
    return *this;
  }
  bool operator==(const ImpulseSumOf&) const = default;
  /// The same about the scene's origin, of a sum whose places are cells of `dx` [m] from `first`
  /// [m] on.
  DM_FN ImpulseSumOf from_cells(const Vec3<R>& first, const R& dx) const {
    return {impulse, cross(first, impulse) + angular * dx, work};
  }
};
using ImpulseSum = ImpulseSumOf<double>;

}  // namespace dreampm
