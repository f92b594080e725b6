#include "dreampm/render/stage.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/srgb.h"
#include "dreampm/render/floor.h"

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

std::optional<TriMesh> backdrop(const RenderScene& scene, const Vec3f& eye) {
  if (scene.stage.place != model::Place::studio || scene.stage.floor == model::Floor::none) return std::nullopt;
  const Box3f& b = scene.basin;
  const float scale = scale_of(b);
  Vec3f back = b.center() - eye;
  back.y = 0;
  back = length(back) > 1e-6f * scale ? normalized(back) : Vec3f{0, 0, -1};
  const Vec3f side{-back.z, 0, back.x}, foot{b.center().x, b.min.y, b.center().z};
  const float begin = 1.5f * scale, bend = 1.2f * scale, high = 6 * scale, wide = 9 * scale;
  constexpr int steps = 32;
  TriMesh mesh;
  const auto add = [&](float behind, float above) {
    for (const float w : {-wide, wide}) mesh.vertices.push_back(foot + back * behind + side * w + Vec3f{0, above, 0});
  };
  for (int i = 0; i <= steps; ++i) {
    const float a = 1.5707963f * static_cast<float>(i) / steps;
    add(begin + bend * std::sin(a), bend * (1 - std::cos(a)));
  }
  add(begin + bend, high);
  for (std::uint32_t i = 0; i <= steps; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  return mesh;
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
