// Foam as the path tracer draws it.
#pragma once
#include "dreampm/foam/foam.h"
#include "dreampm/model/scene.h"
#include "dreampm/render/render.h"

namespace dreampm {

/// The arrays of a picture's grains, which its object borrows.
struct FoamGrains {
  std::vector<Vec3f> positions, colors, velocities;
  std::vector<float> radii, opacity;
  RenderObject object() const {
    return {RenderGrains{positions, radii, opacity, colors, velocities}, model::Look::opaque({1, 1, 1}), {}};
  }
};

/// What is smaller than a pixel of that picture is as wide as one, and covers its share of it.
/// Foam is in the color of scene.foam, dust in that of the scene's first matter that gives dust.
FoamGrains foam_grains(const model::Scene& scene, const Vec3d& shift, const FoamParticles& foam,
                       const RenderSettings& settings);

}  // namespace dreampm
