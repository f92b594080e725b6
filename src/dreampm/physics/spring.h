// Damped springs between a rigid body and a point that stands.
#pragma once
#include "dreampm/model/colliders.h"

namespace dreampm {

/// Pulls one point of a body, which turns it too: how a hand holds it.
struct Hold {
  Vec3d at{};     ///< m, of the shape as the scene gives it
  Spring spring;  ///< between that point and spring.to
};

}  // namespace dreampm
