// What matter does to a rigid body at the points of its surface, summed (backend/body_coupling.h).
// Compilers of device code read it too.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm {

/// Sums over points s with J_s, the velocity of the point along its normal per velocity and spin of
/// the body [1, m]: of impulses, sum l_s A_s J_s, and of the response of matter, sum e_s A_s J_s
/// J_s^T, the lower half row by row.
struct BodySums {
  double given[6], matter[21];

  static DM_FN BodySums none() {
    BodySums sums;
    for (double& number : sums.given) number = 0;
    for (double& number : sums.matter) number = 0;
    return sums;
  }
  DM_FN void add(const BodySums& other) {
    for (int i = 0; i < 6; ++i) given[i] += other.given[i];
    for (int i = 0; i < 21; ++i) matter[i] += other.matter[i];
  }
  /// `impulse`: l_s A_s [N s]; `stiffness`: e_s A_s [kg].
  DM_FN void add_point(const Vec3d& linear, const Vec3d& angular, double impulse, double stiffness) {
    const double j[6] = {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
    for (int i = 0, n = 0; i < 6; ++i) {
      given[i] += impulse * j[i];
      for (int k = 0; k <= i; ++k) matter[n++] += stiffness * j[i] * j[k];
    }
  }
};

}  // namespace dreampm
