// Where things are dropped, by the tool and as files.
#pragma once
#include <string>

#include "dreampm/play/tools/gesture.h"

namespace dreampm::play {

/// Where what is dropped over such a place begins to fall: high in the box, all of it within.
Vec3d above(const Hit& hit, const Box3d& domain, double size, double spacing);

/// The verb that drops a mesh from a file there.
Action drop_file(const std::string& file, const Vec3d& at, double size);

}  // namespace dreampm::play
