#include "dreampm/render/from_scene.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/srgb.h"

namespace dreampm {
namespace {

/// Light scattered inside a thick layer: what its absorption lets through over a few decimeters,
/// none in a clear one.
Vec3f glow_of(const Vec3d& absorption) {
  const double strength = 0.36 * std::min(1.0, std::max({absorption.x, absorption.y, absorption.z}) / 6);
  const auto channel = [&](double a) { return static_cast<float>(strength * std::exp(-0.22 * std::pow(a, 1.38))); };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

}  // namespace

Vec3f light_through(const Vec3d& absorption) {
  const auto channel = [](double a) { return static_cast<float>(std::exp(-0.1 * a)); };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

RenderLook render_look(const model::Look& look) {
  if (look.type == model::LookType::dielectric)
    return DielectricLook{static_cast<float>(look.ior), static_cast<Vec3f>(look.absorption), glow_of(look.absorption)};
  const Vec3f color = linear_color(look.color);
  const auto roughness = static_cast<float>(look.roughness);
  switch (look.type) {
    case model::LookType::wood:
      return WoodLook{color, roughness, static_cast<float>(look.ring.value_or(0))};
    case model::LookType::metal:
      return MetalLook{color, roughness};
    case model::LookType::plastic:
      return PlasticLook{color, roughness};
    case model::LookType::opaque:
      return OpaqueLook{color, roughness};
    default:
      return OpaqueLook{color, 1};
  }
}

RenderScene render_scene(const model::Scene& scene, const Vec3d& shift) {
  RenderScene out;
  out.basin = {static_cast<Vec3f>(scene.space.min - shift), static_cast<Vec3f>(scene.space.end() - shift)};
  for (std::size_t w = 0; w < 6; ++w) out.is_wall[w] = scene.space.walls[w].type != WallType::open;
  const model::Camera& camera = scene.render.camera;
  out.camera.fit_basin = camera.fit_basin;
  out.camera.azimuth = static_cast<float>(camera.azimuth);
  out.camera.elevation = static_cast<float>(camera.elevation);
  out.camera.fov = static_cast<float>(camera.fov);
  out.camera.fill = static_cast<float>(camera.fill);
  out.camera.from = static_cast<Vec3f>(camera.from - shift);
  out.camera.to = static_cast<Vec3f>(camera.to - shift);
  const model::Sun& sun = scene.render.light.sun;
  out.light.sun_elevation = static_cast<float>(sun.elevation);
  out.light.sun_azimuth = static_cast<float>(sun.azimuth);
  out.light.sun_angle = static_cast<float>(sun.angle);
  out.light.sun_strength = static_cast<float>(sun.strength);
  out.light.sky = scene.render.light.sky;
  out.stage.floor_tiles = scene.render.stage.floor == model::Floor::tiles;
  out.stage.basin_glass = scene.render.stage.basin == model::Basin::glass;
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
  return s;
}

}  // namespace dreampm
