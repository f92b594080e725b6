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

RenderLook render_look(const SceneDescription& scene, int material) {
  const scene::Look& look = scene.render.looks.at(scene.materials[std::size_t(material)].name);
  if (look.type == scene::LookType::dielectric)
    return DielectricLook{static_cast<float>(look.ior), static_cast<Vec3f>(look.absorption), glow_of(look.absorption)};
  const float roughness = look.type == scene::LookType::opaque ? static_cast<float>(look.roughness) : 1.0f;
  return OpaqueLook{linear_colour(body_color(scene, material).value_or(look.color)), roughness};
}

}  // namespace dreampm
