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
  /// `x`: x, y, z and anything, in cells from the low corner of a cell, 1/2 or more.
  DM_FN explicit StaggeredPlace(const Four<R>& x)
      : face_(__builtin_convertvector(x, Four<int>)),
        center_(__builtin_convertvector(x + R(0.5), Four<int>) - 1),
        face_way_(x - __builtin_convertvector(face_, Four<R>)),
        // Centers are half a cell on.
        center_way_(x - R(0.5) - __builtin_convertvector(center_, Four<R>)) {}
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
  Four<int> face_, center_;
  Four<R> face_way_, center_way_;
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
  weights = (Four<R>{1, 1, 0, 0} + Four<R>{-1, -1, 1, 1} * cell.way[1]) *
            (Four<R>{1, 0, 1, 0} + Four<R>{-1, 1, -1, 1} * cell.way[2]);
}

template <class R>
DM_FN R sum_of_four(const Four<R>& v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

/// What each of the four gives to the value at a place among the samples.
template <class R>
DM_FN void trilinear_parts(const TrilinearCell<R>& cell, const Corners<R>& at, Four<R>& parts) {
  Four<R> w;
  side_weights(cell, w);
  parts = (at.low + cell.way[0] * (at.high - at.low)) * w;
}

/// The value of samples at a place among them.
template <class R>
DM_FN R trilinear_value(const TrilinearCell<R>& cell, const Corners<R>& at) {
  Four<R> parts;
  trilinear_parts(cell, at, parts);
  return sum_of_four<R>(parts);
}

/// The value there, and the slopes along x, y, z [1/cell].
template <class R>
DM_FN void trilinear_slope(const TrilinearCell<R>& cell, const Corners<R>& at, Four<R>& found) {
  const Four<R> rise_y{-1, -1, 1, 1}, rise_z{-1, 1, -1, 1};
  const Four<R> along_y = Four<R>{1, 1, 0, 0} + rise_y * cell.way[1],
                along_z = Four<R>{1, 0, 1, 0} + rise_z * cell.way[2];
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
  FaceSum& operator+=(const FaceSum& b) {
    momentum += b.momentum, weight += b.weight;
    return *this;
  }
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
