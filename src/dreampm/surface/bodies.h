// Connected bodies of liquid: which part of the mesh wraps which particles.
#pragma once
#include <span>
#include <vector>

#include "dreampm/surface/contour.h"

namespace dreampm::surface {

struct Bodies {
  static constexpr std::int32_t kNone = -1;
  std::size_t count = 0;
  std::vector<std::int32_t> of_vertex;    ///< a body for each vertex; a bubble's vertices belong to the body around it
  std::vector<std::int32_t> of_particle;  ///< or kNone: the field does not reach the surface's value there
  std::vector<std::uint32_t> particles;   ///< per body
  std::vector<std::uint8_t> on_wall;      ///< per body: 1 if it touches a wall
};

/// Bodies are numbered in the order of their first vertex; a body without vertices has none.
/// `points` are the particles to count; each belongs to the body of the nearest inside grid point
/// within two voxels, if any. More than `most_in_32_bits` grid points and vertices are numbered in
/// 64 bits, which takes twice the memory.
Bodies find_bodies(const SparseField& field, const QuadMesh& mesh, std::span<const Vec3f> points,
                   std::size_t most_in_32_bits = 0xffffffff);

}  // namespace dreampm::surface
