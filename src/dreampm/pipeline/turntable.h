// A camera that goes round the scene.
#pragma once
#include <vector>

#include "dreampm/math/vec.h"
#include "dreampm/model/render.h"

namespace dreampm {

/// Cameras at even steps of a circle about the vertical, the first where `camera` stands, the next
/// to its right. One that is fitted to the box [m] keeps the distance at which the box fits into
/// all of the pictures, which are width : height = aspect; one from a point to a point circles the
/// vertical through the latter.
std::vector<model::Camera> turntable(const model::Camera& camera, const Box3d& box, double aspect, int pictures);

}  // namespace dreampm
