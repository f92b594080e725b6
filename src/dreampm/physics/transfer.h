// APIC / MLS-MPM transfer between a particle and its 27 nodes (Jiang et al. 2015; Hu et al. 2018).
// Lengths in cells. Moments are taken about the middle node, whose neighbors lie at whole
// distances, and shifted to the particle at the end. What a node holds is one number or several: N
// offers +, -, n * s, mul_add(n, s, n) and mul_sub(n, s, n) with a weight s.
#pragma once
#include "dreampm/math/bspline.h"
#include "dreampm/math/mat3.h"

namespace dreampm {

/// The stencil of one particle: per axis the first of three nodes (a whole number, relative), the
/// particle's distance from the middle one in [-1/2, 1/2], and the weights.
template <class R>
struct Stencil {
  R base[3], t[3];
  R w[3][3];

  DM_FN int node(int a) const { return static_cast<int>(base[a]); }
  DM_FN R weight(int i, int j, int k) const { return w[0][i] * w[1][j] * w[2][k]; }
};

/// `u`: position in cells minus 1/2 on each axis, |u| small. A particle halfway between two
/// stencils may get either: their weights are the same there.
template <class R>
DM_FN Stencil<R> make_stencil(const Vec3<R>& u) {
  using S = Scalar<R>;
  Stencil<R> s;
  for (int a = 0; a < 3; ++a) {
    const R place = u[a] - R(S(0.5));
    s.base[a] = round_int(place);
    s.t[a] = place - s.base[a];
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

/// The spline that three nodes along z make between them: its value at t cells from the middle one
/// is middle + t slope + (1/4 + t^2) bend.
template <class N>
struct LineSpline {
  N middle, slope, bend;
};
template <class R, class N>
DM_FN LineSpline<N> line_spline(const N& before, const N& middle, const N& after) {
  const R half(Scalar<R>(0.5));
  return {middle, (after - before) * half, mul_sub(before + after, half, middle)};
}
template <class N>
DM_FN NodeRow<N> nodes_of(const LineSpline<N>& line) {
  const N outer = line.middle + line.bend;
  return {{outer - line.slope, line.middle, outer + line.slope}};
}

/// The place of a particle along such a line.
template <class R>
struct LinePlace {
  R t;              ///< from the middle
  R bend;           ///< factor of the bend in the value
  R moment_factor;  ///< factor of the bend in four times the first moment

  explicit DM_FN LinePlace(const R& from_middle) : t(from_middle) {
    using S = Scalar<R>;
    const R square = t * t;
    bend = R(S(0.25)) + square;
    moment_factor = t * (R(S(3)) - R(S(4)) * square);
  }
  template <class N>
  DM_FN N value(const LineSpline<N>& line) const {
    return mul_add(line.bend, bend, mul_add(line.slope, t, line.middle));
  }
  /// 4 sum w n (z_i - z_p)
  template <class N>
  DM_FN N moment(const N& slope, const N& bent) const {
    return mul_add(bent, moment_factor, slope);
  }
};

template <class R, class N>
DM_FN N second_difference(const N& before, const N& middle, const N& after) {
  return mul_add(middle, R(Scalar<R>(-2)), before + after);
}
/// One axis of a stencil among `count` nodes, three or four: of four it may begin at the second, so
/// that particles of two cells can share rows.
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

  /// Adds the node number k, in turn from 0 on, to a weighted sum and to the first moment about the
  /// second node. Sums need not be zero before.
  template <class N>
  DM_FN void add(int k, const N& n, N& sum, N& moment) const {
    if (k == 0) {
      sum = moment = n * w[0];
      return;
    }
    if (k == 2) moment = mul_sub(n, w[2], moment);
    if constexpr (count == 4)
      if (k == 3) moment = mul_add(n, w[3] + w[3], moment);
    sum = mul_add(n, w[k], sum);
  }
  template <class N>
  DM_FN void add(int k, const N& n, N& sum) const {
    sum = k == 0 ? n * w[0] : mul_add(n, w[k], sum);
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

/// Weighted sums over the stencil: value = sum w n; first_moment[a] = sum w n (x_i - x_p)_a;
/// bend[a]: of the second differences along a, weighed along the other axes. The spline's second
/// derivative times dx^2.
template <class N>
struct Moments {
  N value, first_moment[3], bend[3];
};

/// The axes that a gather finds bends along, a bit each. Most gathers need none, and they are not
/// free.
enum Bends : unsigned { no_bends = 0, all_bends = 7 };
constexpr Bends bend_along(int axis) { return static_cast<Bends>(1u << axis); }

/// `row(i, j)` gives the spline along z in the row of nodes i along x and j along y.
template <class N, Bends bends, class R, int nx, int ny, class RowAt>
DM_FN Moments<N> gather(const Shared<R, nx>& x, const Shared<R, ny>& y, const LinePlace<R>& z, const RowAt& row) {
  using S = Scalar<R>;
  constexpr auto wanted = [](int axis) { return (bends & bend_along(axis)) != 0; };
  // First along y, in every plane, then along x: all sums at once would not fit the registers.
  struct Plane {
    N value, y, slope, bend_y, bend_z;
  };
  Plane planes[nx];
#pragma GCC unroll 4
  for (int i = 0; i < nx; ++i) {
    Plane& plane = planes[i];
    N lines[ny];
#pragma GCC unroll 4
    for (int j = 0; j < ny; ++j) {
      const LineSpline<N> line = row(i, j);
      const N value = z.value(line);
      y.add(j, value, plane.value, plane.y);
      if constexpr (wanted(1)) lines[j] = value;
      if constexpr (wanted(2)) {
        y.add(j, line.slope, plane.slope);
        y.add(j, line.bend, plane.bend_z);
      } else {
        y.add(j, z.moment(line.slope, line.bend), plane.slope);
      }
    }
    if constexpr (wanted(1)) plane.bend_y = y.bend(lines);
  }
  Moments<N> m;
  N slope, bend_z;
#pragma GCC unroll 4
  for (int i = 0; i < nx; ++i) {
    const Plane& plane = planes[i];
    x.add(i, plane.value, m.value, m.first_moment[0]);
    x.add(i, plane.y, m.first_moment[1]);
    x.add(i, plane.slope, slope);
    if constexpr (wanted(1)) x.add(i, plane.bend_y, m.bend[1]);
    if constexpr (wanted(2)) x.add(i, plane.bend_z, bend_z);
  }
  if constexpr (wanted(0)) {
    N values[nx];
    for (int i = 0; i < nx; ++i) values[i] = planes[i].value;
    m.bend[0] = x.bend(values);
  }
  if constexpr (wanted(2)) {
    m.bend[2] = bend_z * R(S(2));
    slope = z.moment(slope, bend_z);
  }
  // From moments about a node to those about the particle.
  m.first_moment[0] = mul_add(m.value, -x.t, m.first_moment[0]);
  m.first_moment[1] = mul_add(m.value, -y.t, m.first_moment[1]);
  m.first_moment[2] = slope * R(S(0.25));
  return m;
}

/// The value alone.
template <class N, class R, int nx, int ny, class RowAt>
DM_FN N gather_value(const Shared<R, nx>& x, const Shared<R, ny>& y, const LinePlace<R>& z, const RowAt& row) {
  N value;
#pragma GCC unroll 4
  for (int i = 0; i < nx; ++i) {
    N plane;
#pragma GCC unroll 4
    for (int j = 0; j < ny; ++j) y.add(j, z.value(row(i, j)), plane);
    x.add(i, plane, value);
  }
  return value;
}

/// The splines of rows of nodes.
template <class R, class NodesAt>
DM_FN auto splines_of(const NodesAt& nodes) {
  return [&nodes](int i, int j) __attribute__((always_inline)) {
    const auto row = nodes(i, j);
    return line_spline<R>(row.n[0], row.n[1], row.n[2]);
  };
}

/// The same of one stencil by itself: `row(i, j)` gives the NodeRow base + (i, j, 0 .. 2).
template <class N, Bends bends, class R, class RowAt>
DM_FN Moments<N> gather(const Stencil<R>& s, const RowAt& row) {
  return gather<N, bends>(Shared<R, 3>(s.w[0], s.t[0]), Shared<R, 3>(s.w[1], s.t[1]), LinePlace<R>(s.t[2]),
                          splines_of<R>(row));
}
template <class N, class R, class RowAt>
DM_FN N gather_value(const Stencil<R>& s, const RowAt& row) {
  return gather_value<N>(Shared<R, 3>(s.w[0], s.t[0]), Shared<R, 3>(s.w[1], s.t[1]), LinePlace<R>(s.t[2]),
                         splines_of<R>(row));
}

/// Returns the excess of 4 sum w v (x_i - x_p) along an axis over the derivative of the splines'
/// own field, sum w' v, for a bend of 1 along it: `t` as in Stencil.
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

/// A row of nodes along z that holds w_z(k) (middle + k slope_z), k about the middle node, and the
/// slopes along x and y times w_z too, becomes the nine rows of a stencil: `add(i, j, row)`, to be
/// weighed by w_x(i) w_y(j) yet.
template <class Row, class AddRow>
DM_FN void spread_rows(const Row& row, const Row& slope_x, const Row& slope_y, const AddRow& add) {
  const Row lines[3] = {row - slope_y, row, row + slope_y};
  for (int j = 0; j < 3; ++j) {
    add(0, j, lines[j] - slope_x);
    add(1, j, lines[j]);
    add(2, j, lines[j] + slope_x);
  }
}

/// Calls add(i, j, k, term, w) for the nodes of the stencil in turn: what the node gets is term w,
/// and in sum w_i (q + sum_a slope[a] (x_i - x_p)_a).
template <class N, class R, class Add>
DM_FN void scatter_terms(const Stencil<R>& s, const N& q, const N (&slope)[3], const Add& add) {
  const N middle = at_middle(q, slope, s.t);
  for (int k = 0; k < 3; ++k) {
    const N value = k == 0 ? middle - slope[2] : k == 1 ? middle : middle + slope[2];
    spread_rows(value * s.w[2][k], slope[0] * s.w[2][k], slope[1] * s.w[2][k],
                [&](int i, int j, const N& row) { add(i, j, k, row, s.w[0][i] * s.w[1][j]); });
  }
}

/// Adds w (q + sum_a slope[a] (x_i - x_p)_a) to every node of the stencil: `node(i, j, k)`,
/// references.
template <class N, class R, class NodeAt>
DM_FN void scatter(const Stencil<R>& s, const N& q, const N (&slope)[3], const NodeAt& node) {
  scatter_terms(s, q, slope, [&](int i, int j, int k, const N& term, const R& w) {
    N& n = node(i, j, k);
    n = mul_add(term, w, n);
  });
}

/// C = 4 sum w v (x_i - x_p)^T / dx [1/s], from moments in cells and velocities in m/s.
inline constexpr double apic_inertia = 4;

/// The part of a full quadratic kernel on the open side of a wall, by its distance `d` in cells
/// (negative: inside the wall): sum_i w_i V_i with V_i = the open part of node i's kernel. The
/// density measured on the grid is divided by it.
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
