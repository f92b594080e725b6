// Stage 9: the mesh reaches into walls and solids, so that no film of air is left before them.
#pragma once
#include "dreampm/geometry/mesh.h"
#include "dreampm/surface/contour.h"

namespace dreampm::surface {

struct OverlapSettings {
  float depth;  ///< m, into walls and solids; less in thin ones
  float gap;    ///< m, of air between the mesh and a solid that count as contact
};

/// `mesh` is that of `quads`, finished. Vertices on walls and solids go in against their normals,
/// those where the free surface ends along that surface, so that it stays as it is outside. Where
/// the surface faces a solid at less than the gap it goes too, the less the more it looks away.
void extend(TriMesh& mesh, const QuadMesh& quads, const Bounds& bounds, const OverlapSettings& settings);

}  // namespace dreampm::surface
