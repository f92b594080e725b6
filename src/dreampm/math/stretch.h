// The stretches of F = U diag(s) V^T as isotropic laws need them: s, functions U diag(f) U^T of the
// left stretch, and F with other stretches, U diag(t) V^T. None of these takes eigenvectors where F
// is an invertible, moderate deformation: s^2 - 1 are the eigenvalues of F F^T - 1, and U diag(t)
// V^T = U diag(t/s) U^T F. Else it is the decomposition of svd3.h, lane by lane, so that no
// particle's result depends on its neighbors.
#pragma once
#include "dreampm/math/svd3.h"
#include "dreampm/math/symmetric_function.h"

namespace dreampm {

template <class R>
struct Stretches {
  Vec3<R> s;  ///< in the order of `frame`: the one that stands apart, the middle one, the other; one may be < 0
  Spectrum3<R> frame;  ///< of U
  Mat3<R> base;        ///< U diag(base_s) V^T: F itself, or where that cannot be divided by s, its rotation
  Vec3<R> base_s;

  DM_FN R largest() const { return max(s.x, s.z); }
  DM_FN R least() const { return min(s.x, s.z); }
  DM_FN R product() const { return s.x * s.y * s.z; }
  /// U diag(f) U^T
  DM_FN Sym3<R> function(const Vec3<R>& f) const { return frame.function(f.x, f.y, f.z); }
  /// U diag(t) V^T
  DM_FN Mat3<R> with(const Vec3<R>& t) const {
    return fused_product(function({t.x / base_s.x, t.y / base_s.y, t.z / base_s.z}), base);
  }
};

/// The least square of a stretch, over the largest and over 1, up to which no decomposition is
/// needed: what is asked of it then errs no more than by way of the decomposition
/// (tests/math/stretch_test.cpp). For functions of stretches alone:
inline constexpr double least_for_functions = 1.0 / 100;
/// and where F is put together again, which divides by them.
inline constexpr double least_for_parts = 1.0 / 8;

namespace stretch_detail {

template <class R>
DM_FN Sym3<R> left_strain(const Mat3<R>& f) {
  const R one(Scalar<R>(1));
  const Vec3<R> a = f.row(0), b = f.row(1), c = f.row(2);
  const auto square = [&](const Vec3<R>& r) { return mul_add(r.x, r.x, mul_add(r.y, r.y, r.z * r.z - one)); };
  return {square(a), square(b), square(c), fused_dot(a, b), fused_dot(a, c), fused_dot(b, c)};
}

}  // namespace stretch_detail

/// `least`: one of the two constants above.
template <class R>
DM_FN Stretches<R> stretches_of(const Mat3<R>& f, double least) {
  using S = Scalar<R>;
  const R one(S(1));
  Stretches<R> d;
  d.frame = spectrum_of(stretch_detail::left_strain(f));
  Spectrum3<R>& a = d.frame;
  d.s = {sqrt(a.apart + one), sqrt(a.middle + one), sqrt(a.other + one)};
  d.base = f;
  d.base_s = d.s;
  // A NaN is not tame.
  const R smallest = min(a.apart, a.other) + one, border = R(S(least)) * max(max(a.apart, a.other) + one, one);
  const auto tame = smallest > border && determinant(f) > R(S(0));
  if (any(!tame)) [[unlikely]] {
    const Svd3<R> svd = svd3(f);
    const Mat3<R> turned = rotation_of(svd);
    const auto keep = [&](R& x, const R& of_svd) { x = select(tame, x, of_svd); };
    const auto dyad = [&](int i, int j, int k) { return svd.u(i, k) * svd.u(j, k); };
    const auto replace = [&](Sym3<R>& x, const auto& entry) {
      keep(x.xx, entry(0, 0)), keep(x.yy, entry(1, 1)), keep(x.zz, entry(2, 2));
      keep(x.xy, entry(0, 1)), keep(x.xz, entry(0, 2)), keep(x.yz, entry(1, 2));
    };
    replace(a.along, [&](int i, int j) { return dyad(i, j, 0); });
    replace(a.plane, [&](int i, int j) { return dyad(i, j, 1) - dyad(i, j, 2); });
    for (int i = 0; i < 3; ++i) keep(d.s[i], svd.s[i]), keep(d.base_s[i], one);
    for (int k = 0; k < 9; ++k) keep(d.base.m[k], turned.m[k]);
  }
  return d;
}

}  // namespace dreampm
