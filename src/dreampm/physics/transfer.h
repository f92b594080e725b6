// APIC / MLS-MPM transfer between a particle and its 27 nodes (Jiang et al. 2015; Hu et al. 2018). Lengths in cells.
// N is a node: four numbers {x, y, z, mass} with + and * by a scalar; a backend gives its own (plain struct, 4 lanes).
#pragma once
#include "dreampm/math/bspline.h"
#include "dreampm/math/mat3.h"

namespace dreampm {

/// The weights of one particle: base node (relative), and per axis three weights and the offset of the first node.
template <class R>
struct Stencil {
  int base[3];
  Weights1<R> w[3];
  R first[3];  ///< x_node0 - x_p in cells: -1 - t
};

/// `u`: position in cells minus 1/2 on each axis, |u| small.
template <class R>
DM_FN Stencil<R> make_stencil(const Vec3<R>& u) {
  Stencil<R> s;
  for (int a = 0; a < 3; ++a) {
    int base = static_cast<int>(u[a]);
    base -= u[a] < static_cast<R>(base);  // floor without libm
    const R t = u[a] - static_cast<R>(base) - R(0.5);
    s.base[a] = base;
    s.w[a] = bspline2(t);
    s.first[a] = R(-1) - t;
  }
  return s;
}

/// Weighted sums over the stencil: value = sum w n; along[a] = sum w n (x_i - x_p)_a.
template <class N>
struct Moments {
  N value, along[3];
};

/// `node(i, j, k)` gives the node base + (i, j, k).
template <class R, class N, class NodeAt>
DM_FN Moments<N> gather(const Stencil<R>& s, const NodeAt& node) {
  Moments<N> m{};
  for (int i = 0; i < 3; ++i) {
    N plane{}, plane_y{}, plane_z{};
    for (int j = 0; j < 3; ++j) {
      const N a = node(i, j, 0) * s.w[2].w[0], b = node(i, j, 1) * s.w[2].w[1], c = node(i, j, 2) * s.w[2].w[2];
      const N row = (a + b) + c;
      const N row_z = row * s.first[2] + (b + c * R(2));
      const R wy = s.w[1].w[j];
      plane = plane + row * wy;
      plane_y = plane_y + row * (wy * (s.first[1] + R(j)));
      plane_z = plane_z + row_z * wy;
    }
    const R wx = s.w[0].w[i];
    m.value = m.value + plane * wx;
    m.along[0] = m.along[0] + plane * (wx * (s.first[0] + R(i)));
    m.along[1] = m.along[1] + plane_y * wx;
    m.along[2] = m.along[2] + plane_z * wx;
  }
  return m;
}

/// Adds w (q + sum_a slope[a] (x_i - x_p)_a) to every node of the stencil.
template <class R, class N, class NodeAt>
DM_FN void scatter(const Stencil<R>& s, const N& q, const N slope[3], const NodeAt& node) {
  const N corner = q + slope[0] * s.first[0] + slope[1] * s.first[1] + slope[2] * s.first[2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const R wxy = s.w[0].w[i] * s.w[1].w[j];
      const N row = corner + slope[0] * R(i) + slope[1] * R(j);
      for (int k = 0; k < 3; ++k) {
        auto& n = node(i, j, k);
        n = n + (row + slope[2] * R(k)) * (wxy * s.w[2].w[k]);
      }
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
