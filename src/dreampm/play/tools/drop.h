// Where things are dropped, by the tool and as files.
#pragma once
#include "dreampm/play/tools/gesture.h"

namespace dreampm::play {

/// Where what is dropped over such a place begins to fall: high in the box, all of it within.
Vec3d above(const Hit& hit, const Box3d& domain, double size, double spacing);

}  // namespace dreampm::play
