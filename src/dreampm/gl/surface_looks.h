// Looks with a smooth surface (screen_surface.h).
#pragma once
#include <memory>

#include "dreampm/gl/look.h"

namespace dreampm::gl {

/// "water": a liquid, by ParticleBatch::liquid.
std::unique_ptr<Look> make_water();
/// "skin": opaque matter.
std::unique_ptr<Look> make_skin();

}  // namespace dreampm::gl
