// Turns faces alike that share an edge.
#pragma once
#include <cstddef>
#include <string>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// The result of a look at the directions of a mesh's faces. Vertices at one place count as one.
struct Alike {
  std::size_t parts = 0;          ///< groups of faces that hang together by edges of two faces
  std::size_t turned = 0;         ///< faces that were turned
  std::size_t without_sides = 0;  ///< parts that cannot be turned alike, as a Moebius strip: left as they were
  std::size_t crowded_edges = 0;  ///< edges of more than two faces, not as many one way as the other
};

/// Turns the faces of every part in which neighbors differ: outward, by the sign of the part's
/// volume; a part that may be the wall of a hollow, lying within the bounds of another, keeps the
/// direction that most of its area has. Parts whose faces agree stay as they are.
Alike turn_alike(Model& model);

/// turn_alike, with a warning on the model for each thing that was found.
void turn_alike_with_warnings(Model& model, const std::string& name);

}  // namespace dreampm
