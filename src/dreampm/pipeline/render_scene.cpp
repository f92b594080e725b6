#include "dreampm/pipeline/render_scene.h"

#include <algorithm>
#include <cmath>

namespace dreampm {
namespace {

/// Light scattered inside a thick layer: what its absorption lets through over a few decimetres, none in a clear one.
Vec3f glow_of(const Vec3d& absorption) {
  const double strength = 0.36 * std::min(1.0, std::max({absorption.x, absorption.y, absorption.z}) / 6);
  const auto channel = [&](double a) { return static_cast<float>(strength * std::exp(-0.22 * std::pow(a, 1.38))); };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

float linear(double s) { return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4)); }

/// The color that all bodies of the material have, if they agree.
std::optional<Vec3d> body_color(const SceneDescription& scene, int material) {
  std::optional<Vec3d> color;
  for (const scene::Body& b : scene.bodies) {
    if (b.material != material) continue;
    if (!b.color || (color && !(*color == *b.color))) return std::nullopt;
    color = b.color;
  }
  return color;
}

}  // namespace

Vec3f linear_colour(const Vec3d& srgb) { return {linear(srgb.x), linear(srgb.y), linear(srgb.z)}; }

RenderLook render_look(const SceneDescription& scene, int material) {
  const scene::Look& look = scene.render.looks.at(scene.materials[std::size_t(material)].name);
  if (look.type == scene::LookType::dielectric)
    return DielectricLook{static_cast<float>(look.ior), static_cast<Vec3f>(look.absorption), glow_of(look.absorption)};
  const float roughness = look.type == scene::LookType::opaque ? static_cast<float>(look.roughness) : 1.0f;
  return OpaqueLook{linear_colour(body_color(scene, material).value_or(look.color)), roughness};
}

RenderScene render_scene(const SceneDescription& scene) {
  const scene::Render& r = scene.render;
  RenderScene out;
  out.basin = {static_cast<Vec3f>(scene.space.min), static_cast<Vec3f>(scene.space.max)};
  for (std::size_t w = 0; w < 6; ++w) out.is_wall[w] = scene.space.walls[w].type != scene::WallType::open;
  out.camera = {r.camera.fit_basin,
                static_cast<float>(r.camera.azimuth),
                static_cast<float>(r.camera.elevation),
                static_cast<float>(r.camera.fov),
                static_cast<float>(r.camera.fill),
                static_cast<Vec3f>(r.camera.from),
                static_cast<Vec3f>(r.camera.to)};
  const scene::Sun& sun = r.light.sun;
  out.light = {static_cast<float>(sun.elevation), static_cast<float>(sun.azimuth), static_cast<float>(sun.angle),
               static_cast<float>(sun.strength), r.light.sky == scene::Sky::studio ? SkyKind::studio : SkyKind::clear};
  out.stage = {r.stage.floor == scene::Floor::tiles, r.stage.basin == scene::Basin::glass};
  out.physical = r.physical;
  return out;
}

RenderSettings render_settings(const SceneDescription& scene) {
  RenderSettings s;
  s.width = scene.render.width;
  s.height = scene.render.height;
  s.samples = scene.render.samples;
  s.noise = static_cast<float>(scene.render.noise);
  s.caustics = scene.render.caustics;
  s.seed = scene.seed;
  return s;
}

}  // namespace dreampm
