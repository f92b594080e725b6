// Stage 5: field -> closed quad mesh, by dual marching cubes.
#pragma once
#include <array>
#include <vector>

#include "dreampm/surface/sparse_field.h"
#include "dreampm/surface/walls.h"

namespace dreampm::surface {

/// A closed 2-manifold of quads, before smoothing.
struct QuadMesh {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::uint32_t, 4>> quads;  ///< counter-clockwise seen from outside
  std::vector<Vec3i> inner;                         ///< per quad: the grid point on its inner side
  std::vector<std::uint8_t> touches;  ///< per vertex: bit s if it lies on wall s, exactly; kFree if not on walls only
  static constexpr std::uint8_t kFree = 64;

  bool on_wall(std::size_t v) const { return (touches[v] & 63) != 0; }
  bool pure_wall(std::size_t v) const { return on_wall(v) && (touches[v] & kFree) == 0; }
};

/// Inside corners join on ambiguous faces. Where that would give two sheets one edge, a corner of
/// the field is raised a little above iso first; so `field` may change. Throws RunError if the
/// field ends abruptly.
QuadMesh contour(SparseField& field, const Walls& walls);

}  // namespace dreampm::surface
