// Stage 6: takes the grain of the particles out of the mesh without eating its waves.
#pragma once
#include <span>

#include "dreampm/surface/contour.h"

namespace dreampm::surface {

struct SmoothSettings {
  int steps;      ///< Laplacian steps in S
  float largest;  ///< m, no vertex moves further
};

/// Twicing (Tukey): p = S x, x' = p + S (x - p), where S is `steps` Laplacian steps; `bear` is how
/// much of each step a vertex takes, 0..1. Vertices stay on their walls, and those on
/// solids where they are; where the free surface meets one they follow the free surface.
void smooth(QuadMesh& mesh, std::span<const float> bear, const SmoothSettings& settings);

}  // namespace dreampm::surface
