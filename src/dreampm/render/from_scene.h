// What a scene's `render` and `space` sections mean for a picture.
#pragma once
#include "dreampm/model/scene.h"
#include "dreampm/render/render.h"

namespace dreampm {

/// Basin, walls, camera, light and stage; objects are left to the caller. `shift` [m]: where places
/// in the picture count from.
RenderScene render_scene(const model::Scene& scene, const Vec3d& shift = {});
/// Size, samples, noise, caustics, seed, denoiser; an EXR file wants the first surfaces.
RenderSettings render_settings(const model::Scene& scene);

}  // namespace dreampm
