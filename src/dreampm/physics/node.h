// One grid node in one step: gravity and the walls of the box.
#pragma once
#include "dreampm/physics/contact.h"

namespace dreampm {

/// The six planes of the box as node numbers, with their contact. Sides in the order x_min, x_max, y_min, y_max, z_min,
/// z_max.
template <class S>
struct BoxWalls {
  int low[3], high[3];
  WallType type[6];
  S friction[6];
};

/// Contact of the node at `n` with the walls that it lies on or behind.
template <class S>
DM_FN Vec3<S> box_contact(Vec3<S> v, const int n[3], const BoxWalls<S>& walls) {
  for (int a = 0; a < 3; ++a) {
    Vec3<S> normal{S(0), S(0), S(0)};
    if (n[a] <= walls.low[a]) {
      normal[a] = S(1);
      v = contact(v, normal, walls.type[2 * a], walls.friction[2 * a]);
    } else if (n[a] >= walls.high[a]) {
      normal[a] = S(-1);
      v = contact(v, normal, walls.type[2 * a + 1], walls.friction[2 * a + 1]);
    }
  }
  return v;
}

}  // namespace dreampm
