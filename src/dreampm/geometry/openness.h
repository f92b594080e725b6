// Openness of a mesh: whether it is closed, and how wide its holes are.
#pragma once
#include <cstddef>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Vertices at one place count as one. Edges of more than two triangles are no holes.
struct Openness {
  std::size_t edges = 0;       ///< of the mesh
  std::size_t open_edges = 0;  ///< those with a triangle on one side only
  std::size_t holes = 0;       ///< groups of open edges that hang together
  double widest = 0;           ///< longest side of the bounding box of the widest hole, in the mesh's unit
};

Openness openness(const Model& mesh);
Openness openness(const TriMesh& mesh);

}  // namespace dreampm
