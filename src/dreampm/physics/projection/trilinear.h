// Transfer between a particle and the faces or centers of cells by trilinear weights: APIC on a
// staggered grid (Jiang, Schroeder, Selle, Teran and Stomakhin 2015, section 5.3).
#pragma once
#include "dreampm/math/four.h"
#include "dreampm/math/scalar.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// A place among samples that lie a cell apart: the samples on its low side, and the way from them
/// in cells.
template <class R>
struct TrilinearCell {
  int first[3];
  R way[3];
};

/// Among which samples of a staggered grid a place lies.
template <class R>
class StaggeredPlace {
 public:
  /// `x`: in cells from the low corner of a cell, 1/2 or more.
  DM_FN explicit StaggeredPlace(const Vec3<R>& x) {
    for (int a = 0; a < 3; ++a) {
      face_[a] = static_cast<int>(x[a]);
      face_way_[a] = x[a] - static_cast<R>(face_[a]);
      // Centers are half a cell on.
      center_[a] = static_cast<int>(x[a] + R(0.5)) - 1;
      center_way_[a] = x[a] - R(0.5) - static_cast<R>(center_[a]);
    }
  }
  /// Among the faces of an axis, each by the cell on its high side.
  DM_FN TrilinearCell<R> faces(int axis) const {
    TrilinearCell<R> cell = centers();
    cell.first[axis] = face_[axis], cell.way[axis] = face_way_[axis];
    return cell;
  }
  DM_FN TrilinearCell<R> centers() const {
    return {{center_[0], center_[1], center_[2]}, {center_way_[0], center_way_[1], center_way_[2]}};
  }
  /// The cell that it is in.
  DM_FN int cell(int axis) const { return face_[axis]; }

 private:
  int face_[3], center_[3];
  R face_way_[3], center_way_[3];
};

/// The eight samples around a place: those on the low and on the high side along x, each with y, z
/// low low, low high, high low, high high.
template <class R>
struct Corners {
  Four<R> low, high;
};

/// Weights of the four of a side, by y and z.
template <class R>
DM_FN void side_weights(const TrilinearCell<R>& cell, Four<R>& weights) {
  const R y = cell.way[1], z = cell.way[2];
  weights = Four<R>{1 - y, 1 - y, y, y} * Four<R>{1 - z, z, 1 - z, z};
}

template <class R>
DM_FN R sum_of_four(const Four<R>& v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

/// The value of samples at a place among them.
template <class R>
DM_FN R trilinear_value(const TrilinearCell<R>& cell, const Corners<R>& at) {
  Four<R> w;
  side_weights(cell, w);
  return sum_of_four<R>((at.low + cell.way[0] * (at.high - at.low)) * w);
}

/// The value there, and the slopes along x, y, z [1/cell].
template <class R>
DM_FN void trilinear_slope(const TrilinearCell<R>& cell, const Corners<R>& at, Four<R>& found) {
  const R y = cell.way[1], z = cell.way[2];
  const Four<R> along_y{1 - y, 1 - y, y, y}, along_z{1 - z, z, 1 - z, z}, rise_y{-1, -1, 1, 1}, rise_z{-1, 1, -1, 1};
  const Four<R> along_x = at.high - at.low, v = at.low + cell.way[0] * along_x, w = along_y * along_z;
  const Four<R> value = v * w, x = along_x * w, in_y = v * (rise_y * along_z), in_z = v * (along_y * rise_z);
  // Four sums of four.
  const Four<R> a = __builtin_shufflevector(value, x, 0, 4, 1, 5) + __builtin_shufflevector(value, x, 2, 6, 3, 7);
  const Four<R> b = __builtin_shufflevector(in_y, in_z, 0, 4, 1, 5) + __builtin_shufflevector(in_y, in_z, 2, 6, 3, 7);
  found = __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
}

/// What a particle gives to a face: momentum over its mass, and weight.
template <class R>
struct FaceSum {
  R momentum{}, weight{};
};

/// What a particle gives to the eight faces around it, as four times two FaceSums along z: by x and
/// y low low, low high, high low, high high. `motion`: its velocity along the faces' axis, and what
/// this changes by along x, y, z [over a cell].
template <class R>
DM_FN void given_to_faces(const TrilinearCell<R>& cell, const Four<R>& motion, Four<R> (&given)[4]) {
  const R x = cell.way[0], y = cell.way[1], z = cell.way[2];
  // At the corner where all is low.
  const R v = motion[0] - motion[1] * x - motion[2] * y - motion[3] * z;
  const Four<R> at{v, 1, v + motion[3], 1}, over_x{motion[1], 0, motion[1], 0}, over_y{motion[2], 0, motion[2], 0};
  const Four<R> w{1 - z, 1 - z, z, z}, high_y = w * y, low_y = w - high_y, beyond = at + over_x;
  given[0] = ((1 - x) * low_y) * at;
  given[1] = ((1 - x) * high_y) * (at + over_y);
  given[2] = (x * low_y) * beyond;
  given[3] = (x * high_y) * (beyond + over_y);
}

/// The shares of a particle in the centers of the eight cells around it: those on the low and on
/// the high side along x.
template <class R>
DM_FN Corners<R> shares_of_centers(const TrilinearCell<R>& cell) {
  Four<R> w;
  side_weights(cell, w);
  const Four<R> high = w * cell.way[0];
  return {w - high, high};
}

}  // namespace dreampm
