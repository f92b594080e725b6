// The context of Bullet's callbacks: data of the step that it resolves.
#pragma once
#include <cmath>
#include <vector>

#include "dreampm/state/collider.h"

namespace dreampm {

/// A collider or a wall, as its contacts need it.
struct ContactBody {
  const Collider* collider = nullptr;  ///< null of a wall
  /// Points of its surface, in the collider [m]; the middle of a ball. Null where none are needed.
  const std::vector<Vec3d>* points = nullptr;
  double radius = 0;       ///< m: of a ball; 0 of others, whose points lie on the surface
  Twist before{};          ///< before the forces of the step
  double restitution = 1;  ///< that of two bodies is the product of both
  double speed = 0;        ///< m/s, of its fastest point
  Vec3d period{};          ///< m, of axes along which it wraps; else 0
};

struct ContactContext {
  std::vector<ContactBody> bodies;  ///< by the user index of Bullet's objects: colliders, then walls
  Vec3d origin;                     ///< m: of Bullet's coordinates
  Vec3d period;                     ///< m, of periodic axes; else 0
  double dt = 0;                    ///< s
  double reach = 0;                 ///< m: what may be apart and touches
};

/// The shift by whole periods that takes a point `way` [m] off nearest to where the way begins.
inline Vec3d to_nearest(const Vec3d& way, const Vec3d& period) {
  Vec3d shift{};
  for (int a = 0; a < 3; ++a)
    if (period[a] > 0) shift[a] = -period[a] * std::round(way[a] / period[a]);
  return shift;
}

}  // namespace dreampm
