#include "dreampm/pipeline/replace_model.h"

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/base/log.h"
#include "dreampm/geometry/region.h"
#include "dreampm/import/import.h"

namespace dreampm {
namespace {

/// The body's mesh as it will lie: turned and sized, about its center.
struct Lying {
  Vec3d center;
  Box3d reach;     ///< about the center
  double longest;  ///< side before turning
};

Lying lay(const Model& model, const Shape& shape, const MeshShape& form) {
  const Box3d own = bounds_of(model);
  const Vec3d size = own.size();
  const double longest = std::max({size.x, size.y, size.z});
  const double factor = form.longest ? *form.longest / longest : form.scale.value_or(1);
  const Mat3d turn =
      shape.rotate_angle == 0 ? Mat3d::identity() : rotation_about(shape.rotate_axis, shape.rotate_angle);
  Lying out{shape.center.value_or(own.center() * factor), {}, longest * factor};
  for (const auto& t : model.triangles)
    for (const std::uint32_t v : t) out.reach.add(turn * (model.vertices[v] - own.center()) * factor);
  return out;
}

/// The part of its size at which it keeps one spacing away from the walls; 1 if it is inside as it
/// is.
double part_inside(const Lying& lying, const model::Space& space) {
  double part = 1;
  for (int side = 0; side < 6; ++side) {
    if (space.walls[static_cast<std::size_t>(side)].type == WallType::open) continue;
    const int axis = side / 2;
    const double reach = side % 2 ? lying.reach.max[axis] : -lying.reach.min[axis];
    const double room = side % 2 ? space.end()[axis] - lying.center[axis] : lying.center[axis] - space.min[axis];
    if (reach > room) part = std::min(part, (room - space.spacing) / reach);
  }
  return part;
}

}  // namespace

void replace_model(model::Scene& scene, const std::string& model) {
  Shape* only = nullptr;
  int meshes = 0;
  for (model::Body& b : scene.bodies)
    if (std::holds_alternative<MeshShape>(b.shape.form)) only = &b.shape, ++meshes;
  if (meshes != 1)
    fail_input("--model: the scene has {} bodies with a mesh; it replaces the mesh of exactly one", meshes);
  auto& form = std::get<MeshShape>(only->form);
  form.path = model;
  const Lying lying = lay(load_mesh(model), *only, form);
  const double part = part_inside(lying, scene.space);
  if (!(part > 0) || part == 1) return;
  only->center = lying.center;
  form.longest = lying.longest * part;
  form.scale.reset();
  info("{}: {:.4g} m long as the scene asks reaches outside the walls; made {:.4g} m long", model, lying.longest,
       *form.longest);
}

}  // namespace dreampm
