#include "dreampm/render/stage.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/srgb.h"

namespace dreampm::trace {
namespace {

float scale_of(const Box3f& basin) { return std::max(basin.size().x, basin.size().z); }

}  // namespace

// Four balls off the corners, two warm and two white.
Lamps lamps_of(const RenderScene& scene) {
  if (scene.stage.place != model::Place::night || scene.stage.floor == model::Floor::none) return Lamps{};
  const Box3f& b = scene.basin;
  const float scale = scale_of(b), off = 0.35f * scale, y = b.min.y + 0.75f * scale, radius = 0.06f * scale;
  const Vec3f warm{430, 260, 120}, white{230, 245, 270};
  return Lamps{{{{b.min.x - off, y, b.min.z - off}, radius, warm},
                {{b.max.x + off, y, b.min.z - off}, radius, white},
                {{b.min.x - off, y, b.max.z + off}, radius, white},
                {{b.max.x + off, y, b.max.z + off}, radius, warm}}};
}

std::optional<Backdrop> backdrop_of(const RenderScene& scene, const Vec3f& eye) {
  if (scene.stage.place != model::Place::studio || scene.stage.floor == model::Floor::none) return std::nullopt;
  return Backdrop(scene.basin, eye);
}

model::Look paper_look() {
  const auto c = srgb_from_linear(static_cast<double>(studio_paper.x));
  return model::Look::opaque({c, c, c});
}

bool has_matte(const RenderScene& scene, const Geometry& geometry) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (geometry.interior(static_cast<int>(i)) == nullptr &&
        !std::holds_alternative<RenderGrains>(scene.objects[i].form))
      return true;
  return false;
}

Box3f clear_bounds(const RenderScene& scene, const Geometry& geometry) {
  Box3f box;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (geometry.interior(static_cast<int>(i)) == nullptr) continue;
    const RenderObject& o = scene.objects[i];
    if (const auto* mesh = std::get_if<const TriMesh*>(&o.form))
      for (const Vec3f& v : (*mesh)->vertices) box.add(v);
    if (const auto* spheres = std::get_if<RenderSpheres>(&o.form))
      for (const Vec3f& p : spheres->positions) {
        const Vec3f reach{spheres->radius, spheres->radius, spheres->radius};
        box.add(p - reach), box.add(p + reach);
      }
  }
  return box;
}

}  // namespace dreampm::trace
