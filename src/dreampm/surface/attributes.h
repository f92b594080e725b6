// Stage 8: triangles, normals, velocities, volume.
#pragma once
#include <span>

#include "dreampm/geometry/mesh.h"
#include "dreampm/surface/cells.h"
#include "dreampm/surface/contour.h"

namespace dreampm::surface {

/// Splits each quad along its shorter diagonal and gives every vertex a normal: on walls the wall's
/// own, exactly; where the free surface meets a wall that of the free surface; else the mean of the
/// faces around, by area.
TriMesh finish(const QuadMesh& quads);

/// Velocity at each vertex from the particles within 1.5 cells of it: a line fitted by weighted
/// least squares, so that a linear velocity field comes out as it is; where particles are few,
/// their mean. `grid` holds `positions`.
void carry_velocities(TriMesh& mesh, std::span<const Vec3f> positions, std::span<const Vec3f> velocities,
                      const CellGrid& grid);

/// Volume enclosed by a closed mesh, m^3.
double enclosed_volume(const TriMesh& mesh);

}  // namespace dreampm::surface
