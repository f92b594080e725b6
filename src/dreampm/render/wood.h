// The color of wood: rings about a pith, fibers and pores along it, as a solid texture, so that
// sides, ends and cut faces agree.
#pragma once
#include "dreampm/render/looks.h"
#include "dreampm/render/render.h"

namespace dreampm::trace {

/// Reflectance at p [m], averaged over `footprint` [m].
Vec3f wood_color(const Wood& look, const TextureFrame& frame, const Vec3f& p, float footprint);

}  // namespace dreampm::trace
