// What a scene's `render` and `space` sections mean for a picture.
#pragma once
#include "dreampm/model/scene.h"
#include "dreampm/render/render.h"

namespace dreampm {

/// Basin, walls, camera, light and stage; objects are left to the caller. `shift` [m]: where places
/// in the picture count from.
RenderScene render_scene(const model::Scene& scene, const Vec3d& shift = {});
/// Size, samples, noise, caustics, seed.
RenderSettings render_settings(const model::Scene& scene);
/// As the look's type says; spheres are opaque, without a coat. Colors become linear. A dielectric
/// glows as its absorption asks; a clear one does not.
RenderLook render_look(const model::Look& look);
/// Linear: what a tenth of a meter of clear matter lets through, its color where it cannot be drawn
/// as clear. `absorption` [1/m].
Vec3f light_through(const Vec3d& absorption);

}  // namespace dreampm
