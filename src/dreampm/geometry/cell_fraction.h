// How much of a cubic cell lies below a plane.
#pragma once
#include <algorithm>
#include <cmath>

#include "dreampm/math/vec.h"

namespace dreampm {

/// The part [0, 1] of a unit cell with n.(x - center) + d < 0: d is the signed distance of its
/// center [cells], n the unit normal. Exact for a plane (inclusion and exclusion of the corners;
/// Scardovelli and Zaleski 2000, eq. 7).
inline double cell_fraction(double d, const Vec3d& n) {
  // a component of 1e-3 for 0 tilts the plane by a thousandth of a cell and saves the degenerate
  // cases
  const double a = std::max(std::abs(n.x), 1e-3), b = std::max(std::abs(n.y), 1e-3), c = std::max(std::abs(n.z), 1e-3);
  const double t = 0.5 * (a + b + c) - d;
  if (t <= 0) return 0;
  if (t >= a + b + c) return 1;
  const auto cube = [](double x) { return x > 0 ? x * x * x : 0.0; };
  const double sum =
      cube(t) - cube(t - a) - cube(t - b) - cube(t - c) + cube(t - a - b) + cube(t - a - c) + cube(t - b - c);
  return std::clamp(sum / (6 * a * b * c), 0.0, 1.0);
}

}  // namespace dreampm
