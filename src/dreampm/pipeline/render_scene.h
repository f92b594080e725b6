// The look of a material in its scene: what render/from_scene.h knows, with the colours that bodies bring.
#pragma once
#include "dreampm/render/from_scene.h"

namespace dreampm {

/// Dielectric or opaque; spheres are opaque. A material whose bodies all have one color takes that.
RenderLook render_look(const SceneDescription& scene, int material);

}  // namespace dreampm
