// Parts of the regions of solids.
#pragma once
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/geometry/region.h"

namespace dreampm {

inline Box3d box_of(const Vec3d& low, const Vec3d& high) {
  Box3d box;
  box.min = low, box.max = high;
  return box;
}

/// A loop that the compiler makes vectors of.
template <class Distance>
void for_points(const PointColumns& points, double* to, const Distance& distance) {
  const double *const x = points.at[0], *const y = points.at[1], *const z = points.at[2];
  for (std::size_t i = 0; i < points.count; ++i) to[i] = distance(Vec3d{x[i], y[i], z[i]});
}

/// Region::normal's differences over this, on either side [m]: rounding and curvature both stay far
/// below what friction or the eye resolves.
inline constexpr double normal_step = 1e-6;
inline Vec3d unit_gradient(const Vec3d& g) { return length2(g) > 0 ? normalized(g) : Vec3d{0, 1, 0}; }

inline void want_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) fail_input("{} is {}: a length above 0 m is wanted", what, value);
}

}  // namespace dreampm
