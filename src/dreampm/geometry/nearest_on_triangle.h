// The point of a triangle that is nearest to another.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm {

/// Weights of the corners a, b, c at the triangle's point nearest to `p` (Ericson 2005, Real-Time
/// Collision Detection, 5.1.5). Those of `a` where the triangle is a point.
template <class R>
Vec3<R> nearest_weights(const Vec3<R>& p, const Vec3<R>& a, const Vec3<R>& b, const Vec3<R>& c) {
  const Vec3<R> ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const R d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const R vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const R w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const R sum = va + vb + vc;
  return sum > 0 ? Vec3<R>{va / sum, vb / sum, vc / sum} : Vec3<R>{1, 0, 0};
}

}  // namespace dreampm
