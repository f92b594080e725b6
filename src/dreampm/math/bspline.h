// Quadratic B-spline weights (Steffen et al. 2008). `u` is the position in cells minus 1/2, so that
// floor(u) is the first of the three nodes of an axis, and t = u - floor(u) - 1/2 in [-1/2, 1/2)
// the distance to the middle one.
#pragma once
#include "dreampm/math/scalar.h"

namespace dreampm {

template <class R>
struct Weights1 {
  R w[3];
};
template <class R>
DM_FN Weights1<R> bspline2(const R& t) {
  using S = Scalar<R>;
  const R a = R(S(0.5)) - t, b = R(S(0.5)) + t;
  return {{R(S(0.5)) * a * a, R(S(0.75)) - t * t, R(S(0.5)) * b * b}};
}

}  // namespace dreampm
