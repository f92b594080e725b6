// Pictures and grids of light, blurred.
#pragma once
#include <cmath>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::trace {

/// The values to each side that a blur of that width reaches.
inline int blur_reach(float sigma) { return static_cast<int>(std::ceil(2.5f * sigma)); }
/// Blurs `width` x `height` values, row by row, by a Gaussian of `sigma` of them, edges repeated.
void blur(std::vector<Vec3f>& values, int width, int height, float sigma);

}  // namespace dreampm::trace
