// Damped springs between a rigid body and a point that stands.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm {

/// Pulls the center of mass of a body to a point.
struct Spring {
  Vec3d to{};            ///< m
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
};

/// Pulls one point of a body, which turns it too: how a hand holds it.
struct Hold {
  Vec3d at{};     ///< m, of the shape as the scene gives it
  Spring spring;  ///< between that point and spring.to
};

}  // namespace dreampm
