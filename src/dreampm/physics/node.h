// One grid node in one step: gravity and the walls of the box.
#pragma once
#include "dreampm/physics/contact.h"

namespace dreampm {

/// The velocity [m/s] of a node with momentum `q` [kg m/s] and mass `m` > 0 [kg]: damped to the
/// part `keep`, then under gravity, which gives `kick` [m/s].
template <class S>
DM_FN Vec3<S> free_velocity(const Vec3<S>& q, const S& m, const S& keep, const Vec3<S>& kick) {
  return q * (S(1) / m) * keep + kick;
}

// Sides of the box, in the order x_min, x_max, y_min, y_max, z_min, z_max.
constexpr int axis_of(int side) { return side / 2; }
constexpr int inward_of(int side) { return side % 2 == 0 ? 1 : -1; }

/// The six planes of the box as node numbers, with their contact.
template <class S>
struct BoxWalls {
  int low[3], high[3];
  WallType type[6];
  S friction[6];

  /// Counted from the node `first` on.
  DM_FN BoxWalls from(const Vec3<std::int32_t>& first) const {
    BoxWalls w = *this;
    for (int a = 0; a < 3; ++a) w.low[a] -= first[a], w.high[a] -= first[a];
    return w;
  }
  /// True if some of the nodes from 0 up to `count` along an axis lie on the wall of that side, or
  /// behind it.
  DM_FN bool reaches(int side, int count) const { return side % 2 == 0 ? low[side / 2] >= 0 : high[side / 2] < count; }
  /// Returns a mask: true for the nodes `n` that do.
  template <class R>
  DM_FN auto holds(int side, const Vec3<R>& n) const {
    const int a = axis_of(side);
    const auto below = n[a] <= R(static_cast<S>(low[a]));
    return side % 2 == 0 ? below : !below && n[a] >= R(static_cast<S>(high[a]));
  }
  /// The velocity of those nodes after contact with it. A node in a corner meets one wall after the
  /// other.
  template <class R>
  DM_FN Vec3<R> contact(int side, const Vec3<R>& v) const {
    Vec3<R> normal{R(S(0)), R(S(0)), R(S(0))};
    normal[axis_of(side)] = R(static_cast<S>(inward_of(side)));
    return dreampm::contact(v, normal, type[side], friction[side]);
  }
  /// The part of a velocity along the axis of that wall that is let through, where matter has a gap
  /// before it and may come nearer at the speed `approach` >= 0.
  template <class R>
  DM_FN R let_through(int side, const Vec3<R>& v, const R& approach) const {
    const R inward(static_cast<S>(inward_of(side)));
    return max(min(v[axis_of(side)] * inward, R(S(0))), -approach) * inward;
  }
};

/// The velocity of the image of what moves with `v`, in a wall across `axis`. Where matter sticks
/// all of it is reversed, so that the velocity passes through zero at the wall itself.
template <class R>
DM_FN Vec3<R> image_of(const Vec3<R>& v, int axis, WallType wall) {
  if (wall == WallType::stick) return -v;
  Vec3<R> image = v;
  image[axis] = -image[axis];
  return image;
}

}  // namespace dreampm
