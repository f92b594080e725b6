// Small vectors: positions, velocities, axes.
#pragma once
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace dreampm {

/// Three components of any number type: float, double, integers, and the solver's lanes.
template <class R>
struct Vec3 {
  R x{}, y{}, z{};

  constexpr R& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const R& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  template <class T>
  constexpr explicit operator Vec3<T>() const {
    return {static_cast<T>(x), static_cast<T>(y), static_cast<T>(z)};
  }
  constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  constexpr Vec3& operator*=(const R& s) { return *this = *this * s; }
  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator*(const Vec3& a, const R& s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(const R& s, const Vec3& a) { return a * s; }
  friend constexpr Vec3 operator/(const Vec3& a, const R& s) { return {a.x / s, a.y / s, a.z / s}; }
  friend constexpr bool operator==(const Vec3& a, const Vec3& b)
    requires std::is_arithmetic_v<R>
  {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec3i = Vec3<std::int32_t>;

template <class R>
constexpr R dot(const Vec3<R>& a, const Vec3<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
constexpr Vec3<R> cross(const Vec3<R>& a, const Vec3<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class R>
constexpr R length2(const Vec3<R>& a) {
  return dot(a, a);
}
template <class R>
R length(const Vec3<R>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
/// a/|a|, or a itself if it is zero.
template <class R>
  requires std::is_floating_point_v<R>
Vec3<R> normalized(const Vec3<R>& a) {
  const R l = length(a);
  return l > 0 ? a / l : a;
}
template <class R>
  requires std::is_arithmetic_v<R>
constexpr Vec3<R> min(const Vec3<R>& a, const Vec3<R>& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class R>
  requires std::is_arithmetic_v<R>
constexpr Vec3<R> max(const Vec3<R>& a, const Vec3<R>& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
template <class R>
bool is_finite(const Vec3<R>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// An axis-aligned box; empty until something is added.
template <class R>
struct Box3 {
  Vec3<R> min{R(1e30), R(1e30), R(1e30)}, max{R(-1e30), R(-1e30), R(-1e30)};

  constexpr bool empty() const { return max.x < min.x || max.y < min.y || max.z < min.z; }
  constexpr Vec3<R> size() const { return max - min; }
  constexpr Vec3<R> center() const { return (min + max) * R(0.5); }
  constexpr void add(const Vec3<R>& p) {
    min = dreampm::min(min, p);
    max = dreampm::max(max, p);
  }
  constexpr bool contains(const Vec3<R>& p) const {
    return p.x >= min.x && p.y >= min.y && p.z >= min.z && p.x <= max.x && p.y <= max.y && p.z <= max.z;
  }
};
using Box3f = Box3<float>;
using Box3d = Box3<double>;

}  // namespace dreampm
