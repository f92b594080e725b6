// Liquid particles -> a closed, manifold triangle mesh of the water surface.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "dreampm/geometry/mesh.h"
#include "dreampm/math/vec.h"
#include "dreampm/surface/sparse_field.h"

namespace dreampm {

/// The particles to be wrapped. Every particle stands for a volume spacing^3.
struct SurfaceInput {
  std::span<const Vec3f> positions{};   ///< m
  std::span<const Vec3f> velocities{};  ///< m/s, one a particle, or empty
  float spacing = 0;                    ///< h, m
  Box3f walls{};                        ///< m; only the sides marked in is_wall count
  std::array<bool, 6> is_wall{};        ///< x_min, x_max, y_min, y_max, z_min, z_max: a wall that the liquid wets
};

/// Particles must lie within this number of spacings of the origin along each axis.
inline constexpr float surface_reach = 5e5f;

struct SurfaceSettings {
  float voxel = 0;          ///< m, edge of a grid cell; 0: half the spacing. Between spacing/8 and 2 spacings.
  int smooth = 2;           ///< strength of the smoothing, 0 (none) to 10; 30 Laplacian steps each
  float support = 4;        ///< reach of a particle's kernel in spacings, 2.5 to 6
  bool keep_field = false;  ///< hand the field out with the mesh, e.g. for write_vdb
};

struct SurfaceResult {
  TriMesh mesh;                      ///< closed, 2-manifold, counter-clockwise seen from outside; with normals
  double volume = 0;                 ///< m^3 enclosed by the mesh
  std::size_t spheres = 0;           ///< drops of 1 to 8 particles, given out as spheres
  std::optional<SparseField> field;  ///< if keep_field
};

/// Wraps the particles. Where liquid touches a wall the mesh lies exactly on the wall's plane.
/// Vertices on the line where the free surface meets a wall carry the free surface's normal: shade
/// triangles whose three vertices lie on one wall flat. The mesh has velocities if the input has.
/// No particles: an empty mesh. The result does not depend on the number of threads. Throws
/// InputError for a setting out of range, RunError for positions or velocities that are not finite.
/// The recipe: kernels of compact support after Yu and Turk, "Reconstructing surfaces of
/// particle-based fluids using anisotropic kernels" (2013); dual marching cubes after Nielson
/// (2004), manifold after Wenger, "Isosurfaces" (2013).
SurfaceResult reconstruct(const SurfaceInput& input, const SurfaceSettings& settings = {});

}  // namespace dreampm
