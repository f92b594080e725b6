// APIC / MLS-MPM transfer between a particle and its 27 nodes (Jiang et al. 2015; Hu et al. 2018). Lengths in cells.
// The nodes are taken by rows of three along z. A row type is given by the backend: plain structs, or SIMD vectors that
// hold a whole row; it offers
//   Row::Weights(w)                 three weights along z
//   mul_add(row, s, row), row * s   s a scalar
//   Row::spread(node, weights)         the row node * w_k
//   collapse(row, weights)          the node sum_k w_k row_k
#pragma once
#include "dreampm/math/bspline.h"
#include "dreampm/math/mat3.h"

namespace dreampm {

/// One axis of a stencil: three weights, and the same times the distances of the nodes from the particle.
template <class R>
struct Axis {
  R w[3], moment[3];
  R first;  ///< x_node0 - x_p in cells: -1 - t
};

/// The stencil of one particle: per axis the first of three nodes (a whole number, relative) and the weights.
template <class R>
struct Stencil {
  R base[3];
  Axis<R> axis[3];

  int node(int a) const { return static_cast<int>(base[a]); }
  R weight(int i, int j, int k) const { return axis[0].w[i] * axis[1].w[j] * axis[2].w[k]; }
};

/// `u`: position in cells minus 1/2 on each axis, |u| small. A particle halfway between two stencils may get either:
/// their weights are the same there.
template <class R>
DM_FN Stencil<R> make_stencil(const Vec3<R>& u) {
  using S = Scalar<R>;
  Stencil<R> s;
  for (int a = 0; a < 3; ++a) {
    s.base[a] = round_int(u[a] - R(S(0.5)));
    const R t = u[a] - s.base[a] - R(S(0.5));
    const Weights1<R> weights = bspline2(t);
    Axis<R>& axis = s.axis[a];
    axis.first = R(S(-1)) - t;
    for (int k = 0; k < 3; ++k) {
      axis.w[k] = weights.w[k];
      axis.moment[k] = weights.w[k] * (axis.first + R(S(k)));
    }
  }
  return s;
}

/// A row of plain nodes N: four numbers with + and * by a scalar.
template <class N, class R>
struct NodeRow {
  using Node = N;
  struct Weights {
    R w[3];
    DM_FN Weights(const R (&weights)[3]) : w{weights[0], weights[1], weights[2]} {}
  };
  N n[3];

  friend DM_FN NodeRow operator*(const NodeRow& a, R s) { return {{a.n[0] * s, a.n[1] * s, a.n[2] * s}}; }
  friend DM_FN NodeRow operator+(const NodeRow& a, const NodeRow& b) {
    return {{a.n[0] + b.n[0], a.n[1] + b.n[1], a.n[2] + b.n[2]}};
  }
  friend DM_FN NodeRow mul_add(const NodeRow& a, R s, const NodeRow& b) { return a * s + b; }
  static DM_FN NodeRow spread(const N& node, const Weights& w) {
    return {{node * w.w[0], node * w.w[1], node * w.w[2]}};
  }
  friend DM_FN N collapse(const NodeRow& a, const Weights& w) {
    return (a.n[0] * w.w[0] + a.n[1] * w.w[1]) + a.n[2] * w.w[2];
  }
};

/// Weighted sums over the stencil: value = sum w n; along[a] = sum w n (x_i - x_p)_a.
template <class N>
struct Moments {
  N value, along[3];
};

/// `row(i, j)` gives the nodes base + (i, j, 0 .. 2). X: Axis of scalars, or anything with its members.
template <class Row, class X, class RowAt>
DM_FN Moments<typename Row::Node> gather(const X& x, const X& y, const X& z, const RowAt& row) {
  Row sum{}, sum_x{}, sum_y{};
  for (int i = 0; i < 3; ++i) {
    Row plane{}, plane_y{};
    for (int j = 0; j < 3; ++j) {
      const Row r = row(i, j);
      plane = mul_add(r, y.w[j], plane);
      plane_y = mul_add(r, y.moment[j], plane_y);
    }
    sum = mul_add(plane, x.w[i], sum);
    sum_x = mul_add(plane, x.moment[i], sum_x);
    sum_y = mul_add(plane_y, x.w[i], sum_y);
  }
  const typename Row::Weights w(z.w), moment(z.moment);
  return {collapse(sum, w), {collapse(sum_x, w), collapse(sum_y, w), collapse(sum, moment)}};
}

/// Adds w (q + sum_a slope[a] (x_i - x_p)_a) to every node of the stencil: `add(i, j, row)`.
template <class Row, class X, class Q, class AddRow>
DM_FN void scatter(const X& x, const X& y, const X& z, const Q& q, const Q (&slope)[3], const AddRow& add) {
  const typename Row::Weights w(z.w), moment(z.moment);
  const Row base = Row::spread(q, w) + Row::spread(slope[2], moment);
  const Row slope_x = Row::spread(slope[0], w), slope_y = Row::spread(slope[1], w);
  for (int i = 0; i < 3; ++i) {
    const Row plane = mul_add(slope_x, x.moment[i], base * x.w[i]), plane_y = slope_y * x.w[i];
    for (int j = 0; j < 3; ++j) add(i, j, mul_add(plane, y.w[j], plane_y * y.moment[j]));
  }
}

/// The same with a whole stencil.
template <class Row, class R, class RowAt>
DM_FN Moments<typename Row::Node> gather(const Stencil<R>& s, const RowAt& row) {
  return gather<Row>(s.axis[0], s.axis[1], s.axis[2], row);
}
template <class Row, class R, class Q, class AddRow>
DM_FN void scatter(const Stencil<R>& s, const Q& q, const Q (&slope)[3], const AddRow& add) {
  scatter<Row>(s.axis[0], s.axis[1], s.axis[2], q, slope, add);
}

/// For scatter over plain nodes: adds a row's three to `node(i, j, k)`, references.
template <class NodeAt>
auto adding_to(const NodeAt& node) {
  return [node](int i, int j, const auto& row) {
    for (int k = 0; k < 3; ++k) {
      auto& n = node(i, j, k);
      n = n + row.n[k];
    }
  };
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
