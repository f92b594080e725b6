// What a scene says of light, camera and looks, in the renderer's terms.
#pragma once
#include "dreampm/render/render.h"
#include "dreampm/scene/description.h"

namespace dreampm {

/// Linear reflectance of an sRGB colour, 0 to 1.
Vec3f linear_colour(const Vec3d& srgb);
/// Dielectric or opaque; spheres are opaque. A material whose bodies all have one color takes that.
RenderLook render_look(const SceneDescription& scene, int material);
/// Basin, camera, light and stage, without objects.
RenderScene render_scene(const SceneDescription& scene);
/// Of a whole picture of the scene.
RenderSettings render_settings(const SceneDescription& scene);

}  // namespace dreampm
