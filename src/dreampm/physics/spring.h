// A damped spring between a rigid body and a point that stands.
#pragma once
#include "dreampm/math/vec.h"

namespace dreampm {

/// Pulls the centre of mass of a body to a point.
struct Spring {
  Vec3d to{};            ///< m
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
};

}  // namespace dreampm
