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

}  // namespace dreampm
