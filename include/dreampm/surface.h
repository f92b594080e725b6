// Liquid particles as a closed triangle mesh.
#pragma once
#include "dreampm/mesh.h"

namespace dreampm {

struct SurfaceOptions {
  double voxel = 0.5;  ///< edge of a voxel over that of a cell of the simulation, as in a scene; 1/16 to 1 at 8 a cell
  int smooth = 2;      ///< rounds of smoothing, 0 to 10
  double overlap = 0.5;  ///< spacings that it reaches into walls and colliders that it touches, 0 to 1
};

}  // namespace dreampm
