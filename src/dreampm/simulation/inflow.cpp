#include "dreampm/simulation/inflow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/simulation/colliders.h"

namespace dreampm {
namespace {

std::string place(const std::string& file, const scene::Mark& mark) {
  return mark.line > 0 ? fmt::format("{}:{}:{}", file, mark.line, mark.column) : file;
}

/// The area of a region as seen along a direction [m^2], by lines `apart` [m].
double area_along(const Region& region, const Vec3d& along, double apart) {
  const Vec3d across = normalized(cross(along, std::abs(along.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0})),
              over = cross(along, across);
  const Box3d box = region.bounds();
  const double reach = 0.5 * length(box.size());
  const int lines = static_cast<int>(std::ceil(reach / apart));
  std::size_t met = 0;
  for (int i = -lines; i < lines; ++i)
    for (int j = -lines; j < lines; ++j) {
      const Vec3d foot = box.center() + across * ((i + 0.5) * apart) + over * ((j + 0.5) * apart);
      for (double t = -reach; t <= reach; t += 0.25 * apart)
        if (region.distance(foot + along * t) < 0) {
          ++met;
          break;
        }
    }
  return static_cast<double>(met) * apart * apart;
}

/// Whether a region reaches out of the box, or into a collider.
std::string misplaced(const World<double>& world, const scene::Space& space, const Region& region) {
  const Box3d box = region.bounds();
  const double slack = 1e-6 * world.dx;
  for (int a = 0; a < 3; ++a)
    if (box.min[a] < space.min[a] - slack || box.max[a] > space.max[a] + slack)
      return fmt::format("reaches out of space along {}: move it inside", "xyz"[a]);
  constexpr int samples = 24;
  for (const Collider& c : world.colliders)
    for (int n = 0; n < samples * samples * samples; ++n) {
      const Vec3d part{(n / (samples * samples) + 0.5) / samples, (n / samples % samples + 0.5) / samples,
                       (n % samples + 0.5) / samples};
      const Vec3d p = box.min + part * box.size();
      if (region.distance(p) < 0 && c.distance(p) < -shallow_overlap * world.dx)
        return fmt::format("reaches into collider {}: move it out", c.name);
    }
  return {};
}

}  // namespace

void add_inflow(World<double>& world, const SceneDescription& scene, const Meshes& meshes, const std::string& file,
                std::vector<std::string>& errors) {
  const double spacing = scene.space.spacing;
  const auto region_of = [&](const Shape& shape, const std::string& what,
                             const scene::Mark& mark) -> std::shared_ptr<const Region> {
    try {
      return make_region(shape, spacing, meshes.regions());
    } catch (const InputError& e) {
      errors.push_back(fmt::format("{}: error: {}: {}", place(file, mark), what, e.what()));
      return nullptr;
    }
  };
  for (const scene::Emitter& e : scene.emitters) {
    const std::string what = "emitter " + e.name;
    const auto region = region_of(e.shape, what, e.mark);
    if (!region) continue;
    if (const std::string wrong = misplaced(world, scene.space, *region); !wrong.empty())
      errors.push_back(fmt::format("{}: error: {} {}", place(file, e.mark), what, wrong));
    Vec3d velocity = e.velocity.value_or(Vec3d{});
    if (e.flow) {
      const Vec3d along = normalized(e.direction);
      const double area = area_along(*region, along, spacing);
      if (!(area > 0)) {
        errors.push_back(fmt::format("{}: error: {} is thinner than space.spacing {} m: make it larger",
                                     place(file, e.mark), what, spacing));
        continue;
      }
      velocity = along * (*e.flow / area);
    }
    Emitter& one = world.emitters.emplace_back();
    one.name = e.name, one.shape = region, one.set = static_cast<std::size_t>(e.material), one.velocity = velocity;
    one.start = e.start, one.stop = e.stop.value_or(one.stop);
    one.pool = static_cast<std::uint64_t>(e.pool), one.recycle = e.recycle;
  }
  for (const scene::Sink& s : scene.sinks)
    if (const auto region = region_of(s.shape, "sink " + s.name, s.mark)) world.sinks.push_back({s.name, region, 0});
}

}  // namespace dreampm
