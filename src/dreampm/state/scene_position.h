// From the place of a particle in its block to its position in the scene: what code for devices
// sees of a World for that.
#pragma once
#include "dreampm/math/scalar.h"
#include "dreampm/state/node.h"

namespace dreampm {

struct ScenePosition {
  Vec3d origin;  ///< m, the scene position of node `low`
  double dx;     ///< m, a cell
  Vec3i low;     ///< node planes of the domain's lower walls
  Vec3i period;  ///< cells of the domain along periodic axes; 0 along others

  /// The scene position [m] of a particle of block `b` at `at`, as in ParticleSet::u, within the
  /// domain on periodic axes.
  template <class R>
  DM_FN Vec3d operator()(const Vec3i& b, const Vec3<R>& at) const {
    Vec3d cells = static_cast<Vec3d>(first_stencil(b) - low);
    for (int a = 0; a < 3; ++a) {
      cells[a] += 0.5 + static_cast<double>(at[a]);
      if (period[a] == 0) continue;
      const double count = period[a];
      cells[a] -= cells[a] < 0 ? -count : cells[a] >= count ? count : 0;
    }
    return origin + cells * dx;
  }
};

}  // namespace dreampm
