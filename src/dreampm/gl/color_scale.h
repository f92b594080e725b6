// Colors for numbers: a map whose lightness grows evenly from dark violet over blue, teal and green
// to bright yellow. Plain arithmetic, without OpenGL.
#pragma once
#include <array>

#include "dreampm/math/vec.h"

namespace dreampm::gl {

/// A polynomial in t for each of sRGB's channels; color_scale.glsl gets these numbers.
extern const std::array<Vec3f, 7> color_scale_coefficients;

/// sRGB, 0 to 1, at t; below 0 and above 1 as at the ends, for NaN as at 0. For legends.
Vec3f color_scale(float t);

}  // namespace dreampm::gl
