#include "dreampm/render/from_scene.h"

#include <algorithm>

namespace dreampm {

RenderScene render_scene(const model::Scene& scene, const Vec3d& shift) {
  RenderScene out;
  out.basin = {static_cast<Vec3f>(scene.space.min - shift), static_cast<Vec3f>(scene.space.end() - shift)};
  for (std::size_t w = 0; w < 6; ++w) out.is_wall[w] = scene.space.walls[w].type != WallType::open;
  out.camera = scene.render.camera;
  out.camera.from -= shift, out.camera.to -= shift;
  if (out.camera.focus_point) *out.camera.focus_point -= shift;
  out.frame_time = 1 / scene.time.fps;
  out.light = scene.render.light;
  out.stage = scene.render.stage;
  out.physical = scene.render.physical;
  return out;
}

RenderSettings render_settings(const model::Scene& scene) {
  RenderSettings s;
  s.width = scene.render.width, s.height = scene.render.height;
  s.samples = scene.render.samples;
  s.min_samples = std::min(s.min_samples, s.samples);
  s.noise = static_cast<float>(scene.render.noise);
  s.caustics = scene.render.caustics;
  s.seed = scene.seed;
  s.denoise = scene.render.denoise;
  s.surfaces = scene.render.format == model::PictureFormat::exr;
  return s;
}

}  // namespace dreampm
