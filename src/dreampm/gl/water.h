// The look "water": a smooth surface around particles of a liquid, found in screen space.
#pragma once
#include <memory>

#include "dreampm/gl/look.h"

namespace dreampm::gl {

/// Distance and thickness by particles as spheres, smoothed by the filter of N. Truong and C. Yuksel,
/// "A Narrow-Range Filter for Screen-Space Fluid Rendering" (2018); all but the last pass at half
/// the size.
std::unique_ptr<Look> make_water();

}  // namespace dreampm::gl
