#include "dreampm/setup/rigid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/rigid/exact_forms.h"
#include "dreampm/setup/collider_mesh.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/place.h"
#include "dreampm/state/block_bounds.h"

namespace dreampm {
namespace {

/// Cells along the longest side of a shape over which its mass is added up.
constexpr int cells_along = 48;
/// A distance changes by no more than this from meter to meter; those from meshes are interpolated.
constexpr double steepest = 1.2;

/// Volume [m^3], center [m] and inertia over density [m^5] of a region: added up over cells, of
/// which one that the surface cuts counts by its distance.
struct MassSums {
  double volume = 0;
  Vec3d center{};
  Mat3d inertia{};
};
MassSums mass_sums(const Region& region) {
  const Box3d box = region.bounds();
  const Vec3d size = box.size();
  const double cell = std::max({size.x, size.y, size.z}) / cells_along;
  int n[3];
  Vec3d step;
  for (int a = 0; a < 3; ++a) {
    n[a] = std::max(4, static_cast<int>(std::ceil(size[a] / cell - 1e-9)));
    step[a] = size[a] / n[a];
  }
  const double width = std::cbrt(step.x * step.y * step.z);
  // About the middle: far from the origin squares would lose the digits that matter.
  const Vec3d middle = box.center();
  MassSums sums;
  Vec3d first{};
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  // second moments
  const auto middle_of = [&](double i, double j, double k) { return box.min + Vec3d{i, j, k} * step; };
  // The width of a group of cells: where no surface comes near, one distance stands for the group.
  constexpr int group = 4;
  const double far = width + 0.5 * group * length(step) * steepest;
  const auto whole_part = [&](int i, int j, int k) -> std::optional<double> {
    const double distance = region.distance(middle_of(i + 0.5 * group, j + 0.5 * group, k + 0.5 * group));
    if (std::abs(distance) < far) return std::nullopt;
    return distance < 0 ? 1.0 : 0.0;
  };
  std::vector<std::optional<double>> whole;  // by group along y and z
  const int across = (n[2] + group - 1) / group;
  for (int i = 0; i < n[0]; ++i) {
    if (i % group == 0) {
      whole.clear();
      for (int j = 0; j < n[1]; j += group)
        for (int k = 0; k < n[2]; k += group) whole.push_back(whole_part(i, j, k));
    }
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k) {
        const Vec3d p = middle_of(i + 0.5, j + 0.5, k + 0.5);
        const std::optional<double>& known = whole[static_cast<std::size_t>(j / group * across + k / group)];
        const double inside = known ? *known : std::clamp(0.5 - region.distance(p) / width, 0.0, 1.0);
        const double part = inside * step.x * step.y * step.z;
        if (part == 0) continue;
        sums.volume += part;
        const Vec3d way = p - middle;
        first += way * part;
        xy += way.x * way.y * part, xz += way.x * way.z * part, yz += way.y * way.z * part;
        // With those of the cell itself.
        xx = xx + way.x * way.x * part + step.x * step.x * (part / 12);
        yy = yy + way.y * way.y * part + step.y * step.y * (part / 12);
        zz = zz + way.z * way.z * part + step.z * step.z * (part / 12);
      }
  }
  if (!(sums.volume > 0)) return sums;
  const Vec3d off = first / sums.volume;
  sums.center = middle + off;
  const Mat3d second{{xx, xy, xz, xy, yy, yz, xz, yz, zz}};
  const Mat3d about = second - outer(off, off) * sums.volume;
  sums.inertia = Mat3d::identity() * trace(about) - about;
  return sums;
}

/// Returns the depth of a body in another collider [m], by samples over its bounds.
double depth_in(const Collider& body, const Collider& other) {
  constexpr int samples = 20;
  const Box3d box = body.bounds();
  if (!meet(box, other.bounds())) return 0;
  double depth = 0;
  for (int n = 0; n < samples * samples * samples; ++n) {
    const Vec3d part{(n / (samples * samples) + 0.5) / samples, (n / samples % samples + 0.5) / samples,
                     (n % samples + 0.5) / samples};
    const Vec3d p = box.min + part * box.size();
    depth = std::max(depth, std::min(-body.distance(p), -other.distance(p)));
  }
  return depth;
}

}  // namespace

CollisionShape collision_shape(const model::Collider& given, const model::Space& space) {
  CollisionShape shape{given.shape, nullptr, !given.pin};
  if (given.sequence) return shape;  // met by the distances of the collider
  if (given.thickness || !has_exact_form(given.shape)) {
    const Box3d room{space.min, space.end()};
    shape.mesh =
        std::make_shared<const TriMesh>(collider_mesh(given.shape, 0.5 * space.dx(), room, space.min, given.thickness));
    shape.shape.form = MeshShape{};
  }
  return shape;
}

template <class R>
void make_rigid(World<R>& world, std::size_t c, const model::Collider& given, const model::Space& space,
                std::vector<std::string>& errors) {
  Collider& collider = world.colliders[c];
  const MassSums sums = mass_sums(*collider.shape);
  if (!(sums.volume > 0)) {
    errors.push_back(fmt::format("rigid body {} has no volume", given.name));
    return;
  }
  const Vec3d end = space.end();
  for (int side = 0; side < 6; ++side) {
    if (space.walls[static_cast<std::size_t>(side)].type == WallType::open) continue;
    const int axis = side / 2;
    const Box3d box = collider.bounds();
    const double beyond = side % 2 ? box.max[axis] - end[axis] : space.min[axis] - box.min[axis];
    if (beyond > shallow_overlap * world.dx)
      errors.push_back(fmt::format("rigid body {} reaches {:.4g} m outside the wall {}: move it inside", given.name,
                                   beyond, side_names[static_cast<std::size_t>(side)]));
  }
  const double density = given.rigid->density ? *given.rigid->density : *given.rigid->mass / sums.volume;
  RigidBody body{
      c, density * sums.volume, sums.center, sums.inertia * density, given.rigid->restitution, given.rigid->locked};
  body.spring = given.rigid->spring;
  world.rigid.push_back(std::move(body));
  collider.rigid = true;
  collider.twist = {given.rigid->velocity, given.rigid->spin, sums.center};
}
template void make_rigid(World<float>&, std::size_t, const model::Collider&, const model::Space&,
                         std::vector<std::string>&);
template void make_rigid(World<double>&, std::size_t, const model::Collider&, const model::Space&,
                         std::vector<std::string>&);

template <class R>
std::optional<std::string> starts_inside(const World<R>& world, std::size_t body, std::size_t other) {
  if (!world.collision[other].obstacle) return std::nullopt;
  const double depth = depth_in(world.colliders[body], world.colliders[other]);
  if (!(depth > shallow_overlap * world.dx)) return std::nullopt;
  return fmt::format("rigid body {} starts {:.3g} m inside of {}: move it out", world.colliders[body].name, depth,
                     world.colliders[other].name);
}
template std::optional<std::string> starts_inside(const World<float>&, std::size_t, std::size_t);
template std::optional<std::string> starts_inside(const World<double>&, std::size_t, std::size_t);

void add_rigid(World<double>& world, const model::Scene& scene, const std::string& file,
               std::vector<std::string>& errors) {
  const auto any = std::any_of(scene.colliders.begin(), scene.colliders.end(), [](const auto& c) { return c.rigid; });
  if (!any) return;
  const auto report = [&](std::size_t c, const std::string& what) {
    errors.push_back(fmt::format("{}: error: {}", place(file, scene, scene.colliders[c]), what));
  };
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    const model::Collider& given = scene.colliders[c];
    try {
      world.collision.push_back(collision_shape(given, scene.space));
    } catch (const InputError& e) {
      report(c, e.what());
      world.collision.emplace_back();
    }
    if (!given.rigid) continue;
    std::vector<std::string> own;
    make_rigid(world, c, given, scene.space, own);
    for (const std::string& e : own) report(c, e);
  }
  if (!errors.empty()) return;
  for (const RigidBody& body : world.rigid)
    for (std::size_t c = 0; c < world.colliders.size(); ++c) {
      if (c == body.collider || (world.colliders[c].rigid && c < body.collider)) continue;
      if (const auto inside = starts_inside(world, body.collider, c)) report(body.collider, *inside);
    }
}

}  // namespace dreampm
