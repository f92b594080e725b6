// Small vectors over any lane type R: float, double, Lanes<float>, and the integers.
#pragma once
#include "dreampm/math/scalar.h"
#include "dreampm/vec.h"

namespace dreampm {

/// Component by component, as for numbers.
template <class Mask, class R>
DM_FN Vec3<R> select(const Mask& m, const Vec3<R>& a, const Vec3<R>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

template <class R>
DM_FN Vec3<R> mul_add(const Vec3<R>& a, const R& s, const Vec3<R>& b) {
  return {mul_add(a.x, s, b.x), mul_add(a.y, s, b.y), mul_add(a.z, s, b.z)};
}
template <class R>
DM_FN Vec3<R> mul_sub(const Vec3<R>& a, const R& s, const Vec3<R>& b) {
  return {mul_sub(a.x, s, b.x), mul_sub(a.y, s, b.y), mul_sub(a.z, s, b.z)};
}

}  // namespace dreampm
