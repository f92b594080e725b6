// APIC / MLS-MPM transfer between a particle and its 27 nodes (Jiang et al. 2015; Hu et al. 2018). Lengths in cells.
// Moments are taken about the middle node, whose neighbours lie at whole distances, and shifted to the particle at the
// end. What a node holds is one number or several: N offers +, -, n * s, mul_add(n, s, n) and mul_sub(n, s, n) with a
// weight s.
#pragma once
#include "dreampm/math/bspline.h"
#include "dreampm/math/mat3.h"

namespace dreampm {

/// The stencil of one particle: per axis the first of three nodes (a whole number, relative), the particle's distance
/// from the middle one in [-1/2, 1/2], and the weights.
template <class R>
struct Stencil {
  R base[3], t[3];
  R w[3][3];

  int node(int a) const { return static_cast<int>(base[a]); }
  R weight(int i, int j, int k) const { return w[0][i] * w[1][j] * w[2][k]; }
};

/// `u`: position in cells minus 1/2 on each axis, |u| small. A particle halfway between two stencils may get either:
/// their weights are the same there.
template <class R>
DM_FN Stencil<R> make_stencil(const Vec3<R>& u) {
  using S = Scalar<R>;
  Stencil<R> s;
  for (int a = 0; a < 3; ++a) {
    s.base[a] = round_int(u[a] - R(S(0.5)));
    s.t[a] = u[a] - s.base[a] - R(S(0.5));
    const Weights1<R> weights = bspline2(s.t[a]);
    for (int k = 0; k < 3; ++k) s.w[a][k] = weights.w[k];
  }
  return s;
}

/// Three nodes along z, or what stands for them.
template <class N>
struct NodeRow {
  N n[3];
};

/// The weighted sum of three nodes in a line, and its first moment about the middle one.
template <class N>
struct LineSum {
  N value, along;
};
template <class N, class R>
DM_FN LineSum<N> sum_line(const N (&n)[3], const R (&w)[3]) {
  const N first = n[0] * w[0];
  return {mul_add(n[1], w[1], mul_add(n[2], w[2], first)), mul_sub(n[2], w[2], first)};
}
template <class R, class N>
DM_FN N second_difference(const N& before, const N& middle, const N& after) {
  return mul_add(middle, R(Scalar<R>(-2)), before + after);
}
template <class N, class R>
DM_FN N weigh_line(const N (&n)[3], const R (&w)[3]) {
  return mul_add(n[2], w[2], mul_add(n[1], w[1], n[0] * w[0]));
}

/// One axis of a stencil among `count` nodes, three or four: of four it may begin at the second, so that particles of
/// two cells can share rows.
template <class R, int count>
struct Shared {
  R w[count];
  R t;  ///< the particle's distance from the second node

  Shared() = default;
  DM_FN Shared(const R (&weights)[3], const R& from_middle)
    requires(count == 3)
      : w{weights[0], weights[1], weights[2]}, t(from_middle) {}
  /// `second`: which particles begin there.
  DM_FN Shared(const R (&weights)[3], const R& from_middle, const typename LaneTraits<R>::Mask& begins_second)
    requires(count == 4)
      : second(begins_second) {
    using S = Scalar<R>;
    const R zero(S(0));
    w[0] = select(second, zero, weights[0]);
    for (int k = 1; k < 3; ++k) w[k] = select(second, weights[k - 1], weights[k]);
    w[3] = select(second, weights[2], zero);
    t = from_middle + select(second, R(S(1)), zero);
  }

  /// sum + n w_k (k - 1): the first moment about the second node.
  template <class N>
  DM_FN N add_moment(int k, const N& n, const N& sum) const {
    return k == 1 ? sum : mul_add(n, w[k] * R(Scalar<R>(k - 1)), sum);
  }

  /// The second difference of the stencil's three among the nodes.
  template <class N>
  DM_FN N bend(const N (&n)[count]) const {
    const N first = second_difference<R>(n[0], n[1], n[2]);
    if constexpr (count == 3)
      return first;
    else
      return select(second, second_difference<R>(n[1], n[2], n[3]), first);
  }

 private:
  typename LaneTraits<R>::Mask second{};  ///< which particles begin at the second of four
};

/// Weighted sums over the stencil: value = sum w n; along[a] = sum w n (x_i - x_p)_a; bend[a]: of the second
/// differences along a, weighed along the other axes. The spline's second derivative times dx^2.
template <class N>
struct Moments {
  N value, along[3], bend[3];
};

/// The axes that a gather finds bends along, a bit each. Most gathers need none, and they are not free.
enum Bends : unsigned { no_bends = 0, all_bends = 7 };
constexpr Bends bend_along(int axis) { return static_cast<Bends>(1u << axis); }

/// `row(i, j)` gives the stencil's three nodes along z, in the row of nodes i along x and j along y. `z`: weights.
template <class N, Bends bends, class R, int nx, int ny, class RowAt>
DM_FN Moments<N> gather(const Shared<R, nx>& x, const Shared<R, ny>& y, const R (&z)[3], const R& t_z,
                        const RowAt& row) {
  constexpr auto wanted = [](int axis) { return (bends & bend_along(axis)) != 0; };
  Moments<N> m{};
  N planes[nx];
#pragma GCC unroll 4
  for (int i = 0; i < nx; ++i) {
    N plane{}, plane_y{}, plane_z{}, bend_z{}, lines[ny];
#pragma GCC unroll 4
    for (int j = 0; j < ny; ++j) {
      const NodeRow<N> nodes = row(i, j);
      const LineSum<N> line = sum_line(nodes.n, z);
      plane = mul_add(line.value, y.w[j], plane);
      plane_y = y.add_moment(j, line.value, plane_y);
      plane_z = mul_add(line.along, y.w[j], plane_z);
      if constexpr (wanted(1)) lines[j] = line.value;
      if constexpr (wanted(2))
        bend_z = mul_add(second_difference<R>(nodes.n[0], nodes.n[1], nodes.n[2]), y.w[j], bend_z);
    }
    m.value = mul_add(plane, x.w[i], m.value);
    m.along[0] = x.add_moment(i, plane, m.along[0]);
    m.along[1] = mul_add(plane_y, x.w[i], m.along[1]);
    m.along[2] = mul_add(plane_z, x.w[i], m.along[2]);
    if constexpr (wanted(0)) planes[i] = plane;
    if constexpr (wanted(1)) m.bend[1] = mul_add(y.bend(lines), x.w[i], m.bend[1]);
    if constexpr (wanted(2)) m.bend[2] = mul_add(bend_z, x.w[i], m.bend[2]);
  }
  if constexpr (wanted(0)) m.bend[0] = x.bend(planes);
  // From moments about a node to those about the particle.
  m.along[0] = mul_add(m.value, -x.t, m.along[0]);
  m.along[1] = mul_add(m.value, -y.t, m.along[1]);
  m.along[2] = mul_add(m.value, -t_z, m.along[2]);
  return m;
}

/// The value alone.
template <class N, class R, int nx, int ny, class RowAt>
DM_FN N gather_value(const Shared<R, nx>& x, const Shared<R, ny>& y, const R (&z)[3], const RowAt& row) {
  N value{};
#pragma GCC unroll 4
  for (int i = 0; i < nx; ++i) {
    N plane{};
#pragma GCC unroll 4
    for (int j = 0; j < ny; ++j) plane = mul_add(weigh_line(row(i, j).n, z), y.w[j], plane);
    value = mul_add(plane, x.w[i], value);
  }
  return value;
}

/// The same of one stencil by itself: `row(i, j)` gives the NodeRow base + (i, j, 0 .. 2).
template <class N, Bends bends, class R, class RowAt>
DM_FN Moments<N> gather(const Stencil<R>& s, const RowAt& row) {
  return gather<N, bends>(Shared<R, 3>(s.w[0], s.t[0]), Shared<R, 3>(s.w[1], s.t[1]), s.w[2], s.t[2], row);
}
template <class N, class R, class RowAt>
DM_FN N gather_value(const Stencil<R>& s, const RowAt& row) {
  return gather_value<N>(Shared<R, 3>(s.w[0], s.t[0]), Shared<R, 3>(s.w[1], s.t[1]), s.w[2], row);
}

/// By how much 4 sum w v (x_i - x_p) along an axis exceeds the derivative of the splines' own field, sum w' v, for a
/// bend of 1 along it: `t` as in Stencil.
template <class R>
DM_FN R affine_excess(const R& t) {
  using S = Scalar<R>;
  return (R(S(0.5)) - R(S(2)) * t * t) * t;
}

/// q + sum_a slope[a] (x_i - x_p)_a at the middle node, which lies at -t.
template <class N, class R>
DM_FN N at_middle(const N& q, const N (&slope)[3], const R (&t)[3]) {
  return mul_add(slope[2], -t[2], mul_add(slope[1], -t[1], mul_add(slope[0], -t[0], q)));
}

/// A row of nodes along z that holds w_z(k) (middle + k slope_z), k about the middle node, and the slopes along x and y
/// times w_z likewise, becomes the nine rows of a stencil: `add(i, j, row)`, to be weighed by w_x(i) w_y(j) yet.
template <class Row, class AddRow>
DM_FN void spread_rows(const Row& row, const Row& slope_x, const Row& slope_y, const AddRow& add) {
  const Row lines[3] = {row - slope_y, row, row + slope_y};
  for (int j = 0; j < 3; ++j) {
    add(0, j, lines[j] - slope_x);
    add(1, j, lines[j]);
    add(2, j, lines[j] + slope_x);
  }
}

/// Adds w (q + sum_a slope[a] (x_i - x_p)_a) to every node of the stencil: `node(i, j, k)`, references.
template <class N, class R, class NodeAt>
DM_FN void scatter(const Stencil<R>& s, const N& q, const N (&slope)[3], const NodeAt& node) {
  const N middle = at_middle(q, slope, s.t);
  for (int k = 0; k < 3; ++k) {
    const N along = k == 0 ? middle - slope[2] : k == 1 ? middle : middle + slope[2];
    spread_rows(along * s.w[2][k], slope[0] * s.w[2][k], slope[1] * s.w[2][k], [&](int i, int j, const N& row) {
      N& n = node(i, j, k);
      n = mul_add(row, s.w[0][i] * s.w[1][j], n);
    });
  }
}

/// C = 4 sum w v (x_i - x_p)^T / dx [1/s], from moments in cells and velocities in m/s.
inline constexpr double apic_inertia = 4;

/// The part of a full quadratic kernel on the open side of a wall, by its distance `d` in cells (negative: inside the
/// wall): sum_i w_i V_i with V_i = the open part of node i's kernel. The density measured on the grid is divided by it.
template <class R>
DM_FN R open_fraction(const R& d) {
  using S = Scalar<R>;
  const R near = R(S(0.5)) + R(S(23.0 / 48)) * d;
  const R a = R(S(1.5)) - d, b = R(S(1)) - d, c = R(S(2.5)) - d;
  const R middle = R(S(1)) - R(S(0.25)) * a * a - (R(S(0.75)) - b * b) * R(S(1.0 / 48));
  const R far = R(S(1)) - c * c * R(S(1.0 / 96));
  return select(d < R(S(0.5)), near, select(d < R(S(1.5)), middle, select(d < R(S(2.5)), far, R(S(1)))));
}

}  // namespace dreampm
