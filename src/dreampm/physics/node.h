// One grid node in one step: gravity and the walls of the box.
#pragma once
#include "dreampm/physics/contact.h"

namespace dreampm {

/// The velocity [m/s] of a node with momentum `q` [kg m/s] and mass `m` > 0 [kg]: damped to the part `keep`, then under
/// gravity, which gives `kick` [m/s].
template <class S>
DM_FN Vec3<S> free_velocity(const Vec3<S>& q, const S& m, const S& keep, const Vec3<S>& kick) {
  return q * (S(1) / m) * keep + kick;
}

/// The six planes of the box as node numbers, with their contact. Sides in the order x_min, x_max, y_min, y_max, z_min,
/// z_max.
template <class S>
struct BoxWalls {
  int low[3], high[3];
  WallType type[6];
  S friction[6];
};

/// Contact of the node at `n` with the walls that it lies on or behind. Calls push(side, before, after) for each.
template <class S, class Pushed>
DM_FN Vec3<S> box_contact(Vec3<S> v, const int n[3], const BoxWalls<S>& walls, const Pushed& push) {
  for (int a = 0; a < 3; ++a) {
    const bool low = n[a] <= walls.low[a];
    if (!low && n[a] < walls.high[a]) continue;
    const int side = low ? 2 * a : 2 * a + 1;
    Vec3<S> normal{S(0), S(0), S(0)};
    normal[a] = low ? S(1) : S(-1);
    const Vec3<S> before = v;
    v = contact(v, normal, walls.type[side], walls.friction[side]);
    push(side, before, v);
  }
  return v;
}
template <class S>
DM_FN Vec3<S> box_contact(const Vec3<S>& v, const int n[3], const BoxWalls<S>& walls) {
  return box_contact(v, n, walls, [](int, const Vec3<S>&, const Vec3<S>&) {});
}

}  // namespace dreampm
