// Stage 5: field -> closed quad mesh, by dual marching cubes.
#pragma once
#include <array>
#include <vector>

#include "dreampm/surface/solids.h"
#include "dreampm/surface/sparse_field.h"
#include "dreampm/surface/walls.h"

namespace dreampm::surface {

/// A closed 2-manifold of quads, before smoothing.
struct QuadMesh {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 4>> quads;  ///< counter-clockwise seen from outside
  std::vector<Vec3i> inner;                         ///< per quad: the grid point on its inner side
  /// Per vertex: bit s if it lies on wall s, exactly; kSolid if it lies on a solid; kFree if not on
  /// these only.
  std::vector<std::uint8_t> touches;
  static constexpr std::uint8_t kFree = 64, kSolid = 128;
  std::vector<Vec3f> solid_normals;  ///< per vertex, of the solid that it lies on; empty without solids

  /// True on a wall or a solid.
  bool on_wall(std::size_t v) const { return (touches[v] & ~kFree) != 0; }
  bool pure_wall(std::size_t v) const { return on_wall(v) && (touches[v] & kFree) == 0; }
};

/// What the liquid meets.
struct Bounds {
  Walls walls{};
  Solids solids{};
  SolidBand band{};  ///< of the field that is contoured
};

/// Inside corners join on ambiguous faces. Where that would give two sheets one edge, a corner of
/// the field is raised a little above iso first; so `field` may change. Throws RunError if the
/// field ends abruptly.
QuadMesh contour(SparseField& field, const Bounds& bounds);

}  // namespace dreampm::surface
