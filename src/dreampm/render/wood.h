// The color of wood: rings about a pith, fibers and pores along it, as a solid texture, so that
// sides, ends and cut faces agree.
#pragma once
#include "dreampm/render/render.h"

namespace dreampm::trace {

struct WoodPattern {
  Vec3f color{0.51f, 0.25f, 0.09f};  ///< linear reflectance of the early wood, 0 to 1; late wood is darker
  float ring = 0;                    ///< m from ring to ring; 0: by the size of the object
};

/// Reflectance at p [m], averaged over `footprint` [m].
Vec3f wood_color(const WoodPattern& look, const TextureFrame& frame, const Vec3f& p, float footprint);

}  // namespace dreampm::trace
