// Singular value decomposition F = U diag(s) V^T of 3x3 matrices over the lane contract, U and V
// rotations (det +1), s0 >= s1 >= |s2|, and s2 < 0 for an inverted F (Irving, Teran, Fedkiw 2004,
// "Invertible finite elements"). One-sided Jacobi (Hestenes 1958): the columns of F V are made
// orthogonal, which keeps small singular values exact where an eigenproblem of F^T F would square
// them away.
#pragma once
#include "dreampm/math/mat3.h"
#include "dreampm/math/scalar.h"

namespace dreampm {

template <class R>
struct Svd3 {
  Mat3<R> u, v;
  Vec3<R> s;
};

namespace svd_detail {

template <class R>
struct Columns {
  Vec3<R> b[3], v[3];
};

// Rotates columns p and q so that b_p . b_q = 0 (Golub and Van Loan, section 8.6.3).
template <class R>
DM_FN void orthogonalize(Columns<R>& k, int p, int q) {
  using S = Scalar<R>;
  const R zero(S(0)), one(S(1));
  const R a = dot(k.b[p], k.b[p]), b = dot(k.b[q], k.b[q]), g = dot(k.b[p], k.b[q]);
  // Below this the product is rounding noise; rotating by it only stirs denormals.
  constexpr S noise = sizeof(S) == 4 ? S(1e-30) : S(1e-290);
  const auto small = abs(g) <= R(noise);
  const R zeta = (b - a) / select(small, one, g + g);
  const R root = sqrt(mul_add(zeta, zeta, one));
  const R t = select(small, zero, select(zeta < zero, R(S(-1)), one) / (abs(zeta) + root));
  const R c = one / sqrt(mul_add(t, t, one)), s = c * t;
  const Vec3<R> bp = k.b[p], vp = k.v[p];
  k.b[p] = bp * c - k.b[q] * s;
  k.b[q] = bp * s + k.b[q] * c;
  k.v[p] = vp * c - k.v[q] * s;
  k.v[q] = vp * s + k.v[q] * c;
}

// Exchanges columns p < q if q is longer; one is negated so that V stays a rotation.
template <class R>
DM_FN void order(Columns<R>& k, int p, int q) {
  const auto swap = dot(k.b[q], k.b[q]) > dot(k.b[p], k.b[p]);
  for (int i = 0; i < 3; ++i) {
    const R bp = k.b[p][i], vp = k.v[p][i];
    k.b[p][i] = select(swap, k.b[q][i], bp);
    k.b[q][i] = select(swap, -bp, k.b[q][i]);
    k.v[p][i] = select(swap, k.v[q][i], vp);
    k.v[q][i] = select(swap, -vp, k.v[q][i]);
  }
}

// A unit vector perpendicular to the unit vector a.
template <class R>
DM_FN Vec3<R> perpendicular(const Vec3<R>& a) {
  using S = Scalar<R>;
  const R zero(S(0));
  const auto x_small = abs(a.x) < R(S(0.6));
  const Vec3<R> p{select(x_small, zero, -a.y), select(x_small, -a.z, a.x), select(x_small, a.y, zero)};
  return p * (R(S(1)) / sqrt(dot(p, p)));
}

}  // namespace svd_detail

template <class R>
DM_FN Svd3<R> svd3(const Mat3<R>& f) {
  using S = Scalar<R>;
  const R zero(S(0)), one(S(1));
  R largest = abs(f.m[0]);
  for (int i = 1; i < 9; ++i) largest = max(abs(f.m[i]), largest);
  constexpr S least = sizeof(S) == 4 ? S(1e-37) : S(1e-300);
  const auto vanishes = largest < R(least);
  const R scale = select(vanishes, one, largest);
  const R shrink = one / scale;
  svd_detail::Columns<R> k;
  for (int j = 0; j < 3; ++j) {
    k.b[j] = f.column(j) * shrink;
    k.v[j] = {zero, zero, zero};
    k.v[j][j] = one;
  }
  constexpr int sweeps = sizeof(S) == 4 ? 5 : 7;
#pragma GCC unroll 1
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    svd_detail::orthogonalize(k, 0, 1);
    svd_detail::orthogonalize(k, 0, 2);
    svd_detail::orthogonalize(k, 1, 2);
  }
  svd_detail::order(k, 0, 1);
  svd_detail::order(k, 0, 2);
  svd_detail::order(k, 1, 2);

  // U column by column; a vanishing singular value leaves its direction free, so any perpendicular
  // one will do.
  constexpr S tiny = sizeof(S) == 4 ? S(1e-12) : S(1e-28);  // relative, of squared lengths
  const R n0 = dot(k.b[0], k.b[0]);
  const auto zero0 =
      n0 < R(S(0.01));  // after scaling, the longest column is at least 1/sqrt(3) of the norm unless F = 0
  const R s0 = sqrt(n0);
  const R i0 = one / select(zero0, one, s0);
  const Vec3<R> u0{select(zero0, one, k.b[0].x * i0), select(zero0, zero, k.b[0].y * i0),
                   select(zero0, zero, k.b[0].z * i0)};
  Vec3<R> b1 = k.b[1] - u0 * dot(u0, k.b[1]);
  const R n1 = dot(b1, b1);
  const auto zero1 = n1 <= R(tiny) * n0;
  const R i1 = one / sqrt(select(zero1, one, n1));
  const Vec3<R> free1 = svd_detail::perpendicular(u0);
  Vec3<R> u1;
  for (int i = 0; i < 3; ++i) u1[i] = select(zero1, free1[i], b1[i] * i1);
  const Vec3<R> u2 = cross(u0, u1);

  Svd3<R> r;
  for (int i = 0; i < 3; ++i) {
    r.u(i, 0) = u0[i], r.u(i, 1) = u1[i], r.u(i, 2) = u2[i];
    r.v(i, 0) = k.v[0][i], r.v(i, 1) = k.v[1][i], r.v(i, 2) = k.v[2][i];
  }
  const R back = select(vanishes, zero, scale);
  r.s = {s0 * back, max(dot(u1, k.b[1]), zero) * back, dot(u2, k.b[2]) * back};
  return r;
}

/// The rotation of F: R = U V^T, the nearest one with det +1.
template <class R>
DM_FN Mat3<R> rotation_of(const Svd3<R>& d) {
  return d.u * transpose(d.v);
}

}  // namespace dreampm
