// Functions of a symmetric 3x3 matrix, f(A) = sum f(a_i) v_i v_i^T, over the lane contract and
// without eigenvectors: the eigenvalues in closed form (Smith 1961, "Eigenvalues of a symmetric 3x3
// matrix", by the cosine of a third of an angle), then the matrices of Sylvester's formula. Where
// two eigenvalues are nearly equal the closed form has lost half the digits of their gap (Habera
// and Zilian 2021, arXiv:2111.02117). So only the third, which stands apart, is taken from it; the
// gap is measured on what is left of A in the plane of those two (as Scherzinger and Dohrmann 2008
// do with eigenvectors).
#pragma once
#include "dreampm/math/mat3.h"
#include "dreampm/math/scalar.h"

namespace dreampm {

/// A symmetric A by its eigenvalues: `apart` is the largest or the least one, whichever is further
/// from the other two, `middle` the one between, `other` at the far end. Errors are a few epsilon
/// of |A|, whatever the gaps.
template <class R>
struct Spectrum3 {
  R apart{}, middle{}, other{};
  Sym3<R> along;  ///< v v^T of `apart`
  Sym3<R> plane;  ///< v v^T of `middle` less that of `other`; bounded where these are equal and it has no meaning

  /// f(A) of the values of f at apart, middle and other. Exactly a multiple of 1 where the three
  /// are equal.
  DM_FN Sym3<R> function(const R& f_apart, const R& f_middle, const R& f_other) const {
    const R half(Scalar<R>(0.5));
    const R mean = half * (f_middle + f_other), difference = half * (f_middle - f_other), lift = f_apart - mean;
    const auto on = [&](const R& a, const R& p) { return mul_add(lift, a, mul_add(difference, p, mean)); };
    const auto off = [&](const R& a, const R& p) { return mul_add(lift, a, difference * p); };
    return {on(along.xx, plane.xx),  on(along.yy, plane.yy),  on(along.zz, plane.zz),
            off(along.xy, plane.xy), off(along.xz, plane.xz), off(along.yz, plane.yz)};
  }
};

namespace spectrum_detail {

/// cos(acos(r)/3) for r in [0, 1], to 1 epsilon: the best polynomial of degree 7 (error 1e-8, found
/// by Remez' exchange), in double one step of Newton's method on 4 c^3 - 3 c = r after it (error
/// 1.5 times the square).
template <class R>
DM_FN R cosine_of_third(const R& r) {
  using S = Scalar<R>;
  constexpr double k[] = {0.866025413,   0.166665327,   -0.0480818168,  0.0244188479,
                          -0.0143644468, 0.00777328346, -0.00300159172, 0.000564993149};
  // Pairs of terms side by side (Estrin's scheme), since what follows has to wait for it.
  const R r2 = r * r, r4 = r2 * r2;
  const auto pair = [&](int i) { return mul_add(R(S(k[i + 1])), r, R(S(k[i]))); };
  R c = mul_add(mul_add(pair(6), r2, pair(4)), r4, mul_add(pair(2), r2, pair(0)));
  if constexpr (sizeof(S) > 4) {
    const R c2 = c * c, three(S(3));
    c = c - (c * (R(S(4)) * c2 - three) - r) / (R(S(12)) * c2 - three);
  }
  return c;
}

}  // namespace spectrum_detail

template <class R>
DM_FN Spectrum3<R> spectrum_of(const Sym3<R>& a) {
  using S = Scalar<R>;
  const R one(S(1)), half(S(0.5)), third(S(1) / S(3));
  // A = q + p B with tr B = 0, |B|^2 = 6: the eigenvalues of B are 2 cos(angle), 2 cos(angle +- 120
  // degrees).
  const R q = (a.xx + a.yy + a.zz) * third;
  Sym3<R> b{a.xx - q, a.yy - q, a.zz - q, a.xy, a.xz, a.yz};
  const R p2 = fused_norm2(b) * R(S(1) / S(6));
  // Below this squares are denormals.
  constexpr S least = sizeof(S) == 4 ? S(1e-30) : S(1e-290);
  const R shrink = one / sqrt(max(p2, R(least))), p = p2 * shrink;
  b = b * shrink;
  // adj B, and r = det B/2, the cosine of three times the angle.
  const R xy = -b.xy, xz = -b.xz, yz = -b.yz;
  const Sym3<R> adj{mul_add(b.yy, b.zz, yz * b.yz), mul_add(b.xx, b.zz, xz * b.xz), mul_add(b.xx, b.yy, xy * b.xy),
                    mul_add(b.xz, b.yz, xy * b.zz), mul_add(b.xy, b.yz, xz * b.yy), mul_add(b.xy, b.xz, yz * b.xx)};
  const R r = half * fused_dot(Vec3<R>{b.xx, b.xy, b.xz}, Vec3<R>{adj.xx, adj.xy, adj.xz});
  const R c = spectrum_detail::cosine_of_third(min(abs(r), one));
  // k, the eigenvalue of B that stands apart: on the side of r.
  const R k = select(r < R(S(0)), -(c + c), c + c);

  Spectrum3<R> s;
  // v v^T = adj(B - k)/(3 k^2 - 3), for adj(B - k) = adj B + k B + k^2 where tr B = 0.
  const R scale = one / mul_add(R(S(12)) * c, c, R(S(-3))), slope = k * scale, shift = k * slope;
  s.along = {mul_add(adj.xx, scale, mul_add(b.xx, slope, shift)),
             mul_add(adj.yy, scale, mul_add(b.yy, slope, shift)),
             mul_add(adj.zz, scale, mul_add(b.zz, slope, shift)),
             mul_add(adj.xy, scale, b.xy * slope),
             mul_add(adj.xz, scale, b.xz * slope),
             mul_add(adj.yz, scale, b.yz * slope)};
  // B without that part and the mean -k/2 of the others is +-(gap/2) times `plane`.
  const R mean = half * k, taken = -(k + mean);
  const Sym3<R> rest{mul_add(taken, s.along.xx, b.xx + mean), mul_add(taken, s.along.yy, b.yy + mean),
                     mul_add(taken, s.along.zz, b.zz + mean), mul_add(taken, s.along.xy, b.xy),
                     mul_add(taken, s.along.xz, b.xz),        mul_add(taken, s.along.yz, b.yz)};
  const R size = sqrt(max(half * fused_norm2(rest), R(least)));
  const R gap = select(r < R(S(0)), -size, size);  // half of it; the middle one lies on the side of k
  s.plane = rest * (one / gap);
  s.apart = mul_add(p, k, q);
  s.middle = mul_add(p, gap - mean, q);
  s.other = q - p * (gap + mean);
  return s;
}

}  // namespace dreampm
