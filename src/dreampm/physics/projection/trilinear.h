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

/// The eight samples around a place: at[i][j][k], on the low or the high side along x, y, z.
template <class S>
struct Samples {
  S at[2][2][2];
};

template <class S>
DM_FN S between(const S& low, const S& high, const S& way) {
  return low + way * (high - low);
}

/// The value of samples at a place among them. `way`: from the lowest [cells].
template <class S>
DM_FN S trilinear_value(const Vec3<S>& way, const Samples<S>& samples) {
  const auto& at = samples.at;
  const auto side = [&](int i) __attribute__((always_inline)) {
    return between(between(at[i][0][0], at[i][0][1], way.z), between(at[i][1][0], at[i][1][1], way.z), way.y);
  };
  return between(side(0), side(1), way.x);
}

/// The value there, and the slopes along x, y, z [1/cell].
template <class S>
DM_FN void trilinear_slope(const Vec3<S>& way, const Samples<S>& samples, S& value, Vec3<S>& slope) {
  const auto& at = samples.at;
  S side[2], along_y[2], along_z[2];
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i) {
    const S low = at[i][0][1] - at[i][0][0], high = at[i][1][1] - at[i][1][0];
    const S first = at[i][0][0] + way.z * low, second = at[i][1][0] + way.z * high;
    along_y[i] = second - first, along_z[i] = between(low, high, way.y);
    side[i] = first + way.y * along_y[i];
  }
  slope = {side[1] - side[0], between(along_y[0], along_y[1], way.x), between(along_z[0], along_z[1], way.x)};
  value = side[0] + way.x * slope.x;
}

/// A particle's contribution to a face: momentum over its mass, and weight.
template <class R>
struct FaceSum {
  R momentum{}, weight{};
  FaceSum& operator+=(const FaceSum& b) {
    momentum += b.momentum, weight += b.weight;
    return *this;
  }
};

/// The shares of a particle in the eight samples around it.
template <class S>
DM_FN void trilinear_shares(const Vec3<S>& way, Samples<S>& shares) {
  const S one(Scalar<S>(1));
  const S along_z[2] = {one - way.z, way.z};
#pragma GCC unroll 2
  for (int k = 0; k < 2; ++k) {
    const S high = along_z[k] * way.y, low = along_z[k] - high;
    shares.at[1][0][k] = low * way.x, shares.at[0][0][k] = low - shares.at[1][0][k];
    shares.at[1][1][k] = high * way.x, shares.at[0][1][k] = high - shares.at[1][1][k];
  }
}

/// Computes a particle's contributions to the eight faces around it: momentum over its mass, and
/// weights. `v`, `rise`: its velocity along the faces' axis, and the change of it along x, y, z
/// [over a cell].
template <class S>
DM_FN void given_to_faces(const Vec3<S>& way, const S& v, const Vec3<S>& rise, Samples<S>& momenta,
                          Samples<S>& weights) {
  trilinear_shares(way, weights);
  const S lowest = v - rise.x * way.x - rise.y * way.y - rise.z * way.z;
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i)
#pragma GCC unroll 2
    for (int j = 0; j < 2; ++j) {
      const S beside = i ? lowest + rise.x : lowest, first = j ? beside + rise.y : beside;
      momenta.at[i][j][0] = weights.at[i][j][0] * first;
      momenta.at[i][j][1] = weights.at[i][j][1] * (first + rise.z);
    }
}

// The same of one particle, in fours.

/// The eight samples around a place: those on the low and on the high side along x, each with y, z
/// low low, low high, high low, high high.
template <class R>
struct Corners {
  Four<R> low, high;
};

template <class R>
DM_FN Vec3<R> way_of(const TrilinearCell<R>& cell) {
  return {cell.way[0], cell.way[1], cell.way[2]};
}
template <class R>
DM_FN Corners<R> corners_of(const Samples<R>& s) {
  return {Four<R>{s.at[0][0][0], s.at[0][0][1], s.at[0][1][0], s.at[0][1][1]},
          Four<R>{s.at[1][0][0], s.at[1][0][1], s.at[1][1][0], s.at[1][1][1]}};
}

/// The value, and the slopes along x, y, z.
template <class R>
DM_FN void trilinear_slope(const TrilinearCell<R>& cell, const Corners<R>& at, Four<R>& found) {
  Samples<R> samples;
  for (int n = 0; n < 8; ++n) samples.at[n >> 2][n >> 1 & 1][n & 1] = (n < 4 ? at.low : at.high)[n & 3];
  R value;
  Vec3<R> slope;
  trilinear_slope(way_of(cell), samples, value, slope);
  found = Four<R>{value, slope.x, slope.y, slope.z};
}

/// Four times two FaceSums along z: by x and y low low, low high, high low, high high. `motion`: v
/// and rise.
template <class R>
DM_FN void given_to_faces(const TrilinearCell<R>& cell, const Four<R>& motion, Four<R> (&given)[4]) {
  Samples<R> momenta, weights;
  given_to_faces(way_of(cell), R(motion[0]), Vec3<R>{motion[1], motion[2], motion[3]}, momenta, weights);
  for (int n = 0; n < 4; ++n) {
    const R(&m)[2] = momenta.at[n >> 1][n & 1], (&w)[2] = weights.at[n >> 1][n & 1];
    given[n] = Four<R>{m[0], w[0], m[1], w[1]};
  }
}

template <class R>
DM_FN Corners<R> shares_of_centers(const TrilinearCell<R>& cell) {
  Samples<R> shares;
  trilinear_shares(way_of(cell), shares);
  return corners_of(shares);
}

}  // namespace dreampm
