// 3x3 matrices over any lane type R, row-major: m(i, j) is row i, column j.
#pragma once
#include "dreampm/math/scalar.h"
#include "dreampm/math/vec.h"

namespace dreampm {

template <class R>
struct Mat3 {
  R m[9]{};

  static constexpr Mat3 identity() { return diagonal(R(1), R(1), R(1)); }
  static constexpr Mat3 diagonal(R a, R b, R c) {
    Mat3 d;
    d.m[0] = a, d.m[4] = b, d.m[8] = c;
    return d;
  }
  constexpr R& operator()(int i, int j) { return m[3 * i + j]; }
  constexpr const R& operator()(int i, int j) const { return m[3 * i + j]; }
  constexpr Vec3<R> column(int j) const { return {m[j], m[3 + j], m[6 + j]}; }
  constexpr Vec3<R> row(int i) const { return {m[3 * i], m[3 * i + 1], m[3 * i + 2]}; }
  template <class T>
  constexpr explicit operator Mat3<T>() const {
    Mat3<T> r;
    for (int k = 0; k < 9; ++k) r.m[k] = static_cast<T>(m[k]);
    return r;
  }

  friend constexpr Mat3 operator+(const Mat3& a, const Mat3& b) {
    Mat3 r;
    for (int k = 0; k < 9; ++k) r.m[k] = a.m[k] + b.m[k];
    return r;
  }
  friend constexpr Mat3 operator-(const Mat3& a, const Mat3& b) {
    Mat3 r;
    for (int k = 0; k < 9; ++k) r.m[k] = a.m[k] - b.m[k];
    return r;
  }
  friend constexpr Mat3 operator*(const Mat3& a, const R& s) {
    Mat3 r;
    for (int k = 0; k < 9; ++k) r.m[k] = a.m[k] * s;
    return r;
  }
  friend constexpr Mat3 operator*(const R& s, const Mat3& a) { return a * s; }
  friend constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
    Mat3 r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    return r;
  }
  friend constexpr Vec3<R> operator*(const Mat3& a, const Vec3<R>& v) {
    return {a.m[0] * v.x + a.m[1] * v.y + a.m[2] * v.z, a.m[3] * v.x + a.m[4] * v.y + a.m[5] * v.z,
            a.m[6] * v.x + a.m[7] * v.y + a.m[8] * v.z};
  }
};

using Mat3f = Mat3<float>;
using Mat3d = Mat3<double>;

template <class R>
constexpr Mat3<R> transpose(const Mat3<R>& a) {
  Mat3<R> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r(i, j) = a(j, i);
  return r;
}
template <class R>
constexpr R determinant(const Mat3<R>& a) {
  return dot(a.row(0), cross(a.row(1), a.row(2)));
}
template <class R>
constexpr R trace(const Mat3<R>& a) {
  return a.m[0] + a.m[4] + a.m[8];
}
/// cof(A) = det(A) A^-T, defined for singular A too.
template <class R>
constexpr Mat3<R> cofactor(const Mat3<R>& a) {
  const Vec3<R> r0 = cross(a.row(1), a.row(2)), r1 = cross(a.row(2), a.row(0)), r2 = cross(a.row(0), a.row(1));
  return {{r0.x, r0.y, r0.z, r1.x, r1.y, r1.z, r2.x, r2.y, r2.z}};
}
template <class R>
constexpr Mat3<R> outer(const Vec3<R>& a, const Vec3<R>& b) {
  return {{a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z}};
}
template <class R>
constexpr R norm2(const Mat3<R>& a) {
  return dot(a.row(0), a.row(0)) + dot(a.row(1), a.row(1)) + dot(a.row(2), a.row(2));
}

/// a . b, by multiply-adds: what runs in lanes saves half of its instructions.
template <class R>
DM_FN R fused_dot(const Vec3<R>& a, const Vec3<R>& b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
template <class R>
DM_FN R fused_norm2(const Vec3<R>& a) {
  return fused_dot(a, a);
}
/// A B + C
template <class R>
DM_FN Mat3<R> mul_add(const Mat3<R>& a, const Mat3<R>& b, const Mat3<R>& c) {
  Mat3<R> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r(i, j) = mul_add(a(i, 0), b(0, j), mul_add(a(i, 1), b(1, j), mul_add(a(i, 2), b(2, j), c(i, j))));
  return r;
}

/// A symmetric matrix: six numbers.
template <class R>
struct Sym3 {
  R xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

  static constexpr Sym3 isotropic(R s) { return {s, s, s, R(0), R(0), R(0)}; }
  constexpr Mat3<R> full() const { return {{xx, xy, xz, xy, yy, yz, xz, yz, zz}}; }
  friend constexpr Sym3 operator+(const Sym3& a, const Sym3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend constexpr Sym3 operator*(const Sym3& a, const R& s) {
    return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.xz * s, a.yz * s};
  }
  friend constexpr Vec3<R> operator*(const Sym3& a, const Vec3<R>& v) {
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.xz * v.x + a.yz * v.y + a.zz * v.z};
  }
};
/// A + s I
template <class R>
DM_FN Sym3<R> plus_isotropic(const Sym3<R>& a, const R& s) {
  return {a.xx + s, a.yy + s, a.zz + s, a.xy, a.xz, a.yz};
}
/// A s + p I
template <class R>
DM_FN Sym3<R> mul_add_isotropic(const Sym3<R>& a, const R& s, const R& p) {
  return {mul_add(a.xx, s, p), mul_add(a.yy, s, p), mul_add(a.zz, s, p), a.xy * s, a.xz * s, a.yz * s};
}
/// A : A, by multiply-adds
template <class R>
DM_FN R fused_norm2(const Sym3<R>& a) {
  const R on = mul_add(a.xx, a.xx, mul_add(a.yy, a.yy, a.zz * a.zz));
  const R off = mul_add(a.xy, a.xy, mul_add(a.xz, a.xz, a.yz * a.yz));
  return mul_add(R(Scalar<R>(2)), off, on);
}
/// A B
template <class R>
DM_FN Mat3<R> fused_product(const Sym3<R>& a, const Mat3<R>& b) {
  Mat3<R> r;
  for (int j = 0; j < 3; ++j) {
    const Vec3<R> c = b.column(j);
    r(0, j) = fused_dot(Vec3<R>{a.xx, a.xy, a.xz}, c);
    r(1, j) = fused_dot(Vec3<R>{a.xy, a.yy, a.yz}, c);
    r(2, j) = fused_dot(Vec3<R>{a.xz, a.yz, a.zz}, c);
  }
  return r;
}
/// (A + A^T)/2
template <class R>
constexpr Sym3<R> symmetric_part(const Mat3<R>& a) {
  const R h(0.5);
  return {a.m[0], a.m[4], a.m[8], h * (a.m[1] + a.m[3]), h * (a.m[2] + a.m[6]), h * (a.m[5] + a.m[7])};
}

}  // namespace dreampm
