#include "dreampm/pictures/foam_grains.h"

#include <array>
#include <numbers>

#include "dreampm/math/camera_view.h"
#include "dreampm/math/srgb.h"
#include "dreampm/scene/foam.h"

namespace dreampm {
namespace {

/// What a drop or a bubble hides, in the order of FoamType: they let light through, the more the
/// less they differ from what is around them.
constexpr std::array<float, 4> hides{0.7f, 0.9f, 0.2f, 1.0f};
constexpr float least_radius = 1e-3f;  ///< of a pixel: smaller grains are left out

Vec3f dust_color(const model::Scene& scene) {
  for (const int m : scene::foaming_materials(scene)) {
    const model::Material& material = scene.materials[static_cast<std::size_t>(m)];
    if (scene::foam_kind(material) == scene::FoamKind::dust)
      return linear_color(scene.render.looks.at(material.name).color);
  }
  return linear_color(scene.foam->color);
}

}  // namespace

FoamGrains foam_grains(const model::Scene& scene, const Vec3d& shift, const FoamParticles& foam,
                       const RenderSettings& settings) {
  const Box3d box{scene.space.min, scene.space.end()};
  const CameraView view = camera_view(scene.render.camera, box, static_cast<double>(settings.width) / settings.height);
  const Vec3f eye = static_cast<Vec3f>(view.eye - shift);
  const auto half_pixel = static_cast<float>(std::tan(view.fov * std::numbers::pi / 360) / settings.height);
  const Vec3f white = linear_color(scene.foam->color), dust = dust_color(scene);
  FoamGrains out;
  for (std::size_t i = 0; i < foam.size(); ++i) {
    const float r = foam.radius[i], pixel = half_pixel * length(foam.position[i] - eye);
    if (r <= least_radius * pixel) continue;
    const float wide = std::max(r, pixel);
    out.positions.push_back(foam.position[i]);
    if (!foam.velocity.empty()) out.velocities.push_back(foam.velocity[i]);
    out.radii.push_back(wide);
    out.opacity.push_back(hides[static_cast<std::size_t>(foam.type[i])] * (r / wide) * (r / wide));
    out.colors.push_back(foam.type[i] == FoamType::dust ? dust : white);
  }
  return out;
}

}  // namespace dreampm
