// Liquid particles -> a closed, manifold triangle mesh of the water surface.
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/math/vec.h"
#include "dreampm/pose.h"
#include "dreampm/surface/sparse_field.h"

namespace dreampm {

class Region;

/// A collider or a rigid body that the liquid wets, as it stands.
struct WettedSolid {
  std::shared_ptr<const Region> region;  ///< as its scene gives it
  Pose pose{};                           ///< m
};

/// The particles to be wrapped. Every particle stands for a volume spacing^3.
struct SurfaceInput {
  std::span<const Vec3f> positions{};   ///< m
  std::span<const Vec3f> velocities{};  ///< m/s, one a particle, or empty
  /// The share of its volume that each particle has left, 0 to 1, as small drops on walls and
  /// solids show it (surface/resting_drops.h); empty: all.
  std::span<const float> remaining{};
  float spacing = 0;                  ///< h, m
  Box3f walls{};                      ///< m; only the sides marked in is_wall count
  std::array<bool, 6> is_wall{};      ///< x_min, x_max, y_min, y_max, z_min, z_max: a wall that the liquid wets
  std::vector<WettedSolid> solids{};  ///< distances exact within `solid_reach` spacings
  Vec3d origin{};                     ///< m, in the axes of the solids: where positions and walls count from
};

/// Liquid nearer than that to a solid, in spacings, is as it would be amid liquid.
inline constexpr float solid_reach = 3;

/// Particles must lie within this number of spacings of the origin along each axis.
inline constexpr float surface_reach = 5e5f;

struct SurfaceSettings {
  float voxel = 0;          ///< m, edge of a grid cell; 0: half the spacing. Between spacing/8 and 2 spacings.
  int smooth = 2;           ///< strength of the smoothing, 0 (none) to 10; 30 Laplacian steps each
  float overlap = 0;        ///< spacings that the mesh reaches into the walls and solids that it touches, 0 to 1
  float support = 4;        ///< reach of a particle's kernel in spacings, 2.5 to 6
  bool keep_field = false;  ///< hand the field out with the mesh, e.g. for write_vdb
  std::function<void(std::string_view stage)> ended{};  ///< called as a stage of the recipe ends
};

struct SurfaceResult {
  TriMesh mesh;       ///< closed, 2-manifold, counter-clockwise seen from outside; with normals
  double volume = 0;  ///< m^3 of liquid: what the mesh encloses outside of walls and solids
  /// Drops of 1 to 8 particles, given out as spheres; on walls and solids as flat caps.
  std::size_t small_drops = 0;
  std::optional<SparseField> field;  ///< if keep_field
};

/// Wraps the particles. Where liquid touches a wall or a solid the mesh lies on it, or reaches
/// `overlap` into it, half as far at most as a thin solid is thick: then no film of air is left
/// between the two, and no faces of them lie in one plane. Without overlap it lies exactly on a
/// wall's plane.
/// Vertices on the line where the free surface meets a wall carry the free surface's normal: shade
/// triangles whose three vertices lie on one wall flat. The mesh has velocities if the input has.
/// No particles: an empty mesh. The result does not depend on the number of threads. Throws
/// InputError for a setting out of range, RunError for positions or velocities that are not finite.
/// The recipe: kernels of compact support after Yu and Turk, "Reconstructing surfaces of
/// particle-based fluids using anisotropic kernels" (2013); dual marching cubes after Nielson
/// (2004), manifold after Wenger, "Isosurfaces" (2013).
SurfaceResult reconstruct(const SurfaceInput& input, const SurfaceSettings& settings = {});

}  // namespace dreampm
