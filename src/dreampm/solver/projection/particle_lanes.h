// Particles side by side, one a lane: what loops over those of a block share.
#pragma once
#include <cmath>
#include <cstdint>

#include "dreampm/math/vec.h"

namespace dreampm {

// `Row` handles as many particles as S has lanes, as OneParticle does for plain numbers.

template <class R>
struct OneParticle {
  static R load(const R* p, int) { return *p; }
  static void store(R a, R* p, int) { *p = a; }
  static R all(const R* p) { return *p; }
  static void keep(R a, R* p) { *p = a; }
  static R floor(R a) { return std::floor(a); }
  static void whole(R a, std::int32_t (&to)[1]) { to[0] = static_cast<std::int32_t>(a); }
  static void pairs(const R* from, const std::int32_t (&number)[1], R& first, R& second) {
    first = from[number[0]], second = from[number[0] + 1];
  }
  static unsigned bits(bool m) { return m; }
  static bool mask(unsigned bits) { return (bits & 1) != 0; }
  static void records(R a, R b, R c, R d, R* p) { p[0] = a, p[1] = b, p[2] = c, p[3] = d; }
  static int record_of(int) { return 0; }
};

/// Among which samples of a staggered grid places lie: faces of an axis are half a cell before
/// centers along it.
template <class S>
struct StaggeredLanes {
  Vec3<S> face, center;          ///< whole numbers: the samples on the low side
  Vec3<S> face_way, center_way;  ///< from there [cells]
  /// `x`: in cells from a corner of cells, `middle`: from a center of cells; both 0 or more.
  template <class Row>
  static DM_FN StaggeredLanes at(const Vec3<S>& x, const Vec3<S>& middle, Row) {
    StaggeredLanes place;
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      place.face[a] = Row::floor(x[a]), place.center[a] = Row::floor(middle[a]);
      place.face_way[a] = x[a] - place.face[a], place.center_way[a] = middle[a] - place.center[a];
    }
    return place;
  }
  DM_FN Vec3<S> way_of_faces(int axis) const {
    Vec3<S> way = center_way;
    way[axis] = face_way[axis];
    return way;
  }
  /// The place in an array with these strides; `axis` -1: of centers.
  DM_FN S number(int axis, int along_x, int along_y, int along_z) const {
    const auto at = [&](int a) __attribute__((always_inline)) { return a == axis ? face[a] : center[a]; };
    using R = Scalar<S>;
    return at(0) * S(static_cast<R>(along_x)) + at(1) * S(static_cast<R>(along_y)) + at(2) * S(static_cast<R>(along_z));
  }
};

}  // namespace dreampm
