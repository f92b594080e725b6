// How far a particle is from a wall of the box, in the numbers of its block, and which side of it a
// face is turned like. Compilers of device code read it too.
#pragma once
#include "dreampm/math/vec.h"
#include "dreampm/physics/node.h"

namespace dreampm {

/// Cells from a particle at which the spline of a node ends.
inline constexpr double kernel_reach = 1.5;

/// The first node of a particle's stencil along an axis, counted from the first that its block
/// reaches. `u`: its place, as ParticleSet::u.
template <class R>
DM_FN int first_node(R u) {
  const int towards_zero = static_cast<int>(u);
  return towards_zero - (u < static_cast<R>(towards_zero)) + 1;
}

/// The side of the box whose normal is nearest to this one.
template <class R>
DM_FN int side_like(const Vec3<R>& normal) {
  int a = 0;
  for (int b = 1; b < 3; ++b)
    if (abs(normal[b]) > abs(normal[a])) a = b;
  return 2 * a + (normal[a] < R(0));
}

/// True if a face of that normal is turned like a side of the box: has at least 0.4 along the
/// side's.
template <class R>
DM_FN bool turned_like(const Vec3<R>& normal, int side) {
  return !(normal[axis_of(side)] * static_cast<R>(inward_of(side)) < R(0.4));
}

/// The distance [cells] from a wall of the box.
template <class R>
struct WallDistance {
  R shift, inward;

  /// The wall of `side`, whose nodes lie in `plane`, counted from there too.
  DM_FN WallDistance(int plane, int side)
      : shift(static_cast<R>(kernel_reach - plane)), inward(static_cast<R>(inward_of(side))) {}
  DM_FN R of(R u) const { return (u + shift) * inward; }
};

}  // namespace dreampm
