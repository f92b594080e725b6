#include "dreampm/setup/inflow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/place.h"
#include "dreampm/solver/emission_pattern.h"

namespace dreampm {
namespace {

/// Returns the fault of an emitter whose shape leaves the box at a key of its motion; empty if
/// there is none.
std::string leaves(const World<double>& world, const model::Space& space, const Emitter& emitter) {
  const Box3d own = emitter.shape->bounds();
  const double slack = 1e-6 * world.dx;
  const Vec3d end = space.end();
  for (const PoseKey& key : emitter.path->keys) {
    const Pose pose = emitter.path->pose_at(key.t);
    for (int c = 0; c < 8; ++c) {
      const Vec3d p =
          pose({c & 4 ? own.max.x : own.min.x, c & 2 ? own.max.y : own.min.y, c & 1 ? own.max.z : own.min.z});
      for (int a = 0; a < 3; ++a)
        if (p[a] < space.min[a] - slack || p[a] > end[a] + slack)
          return fmt::format("reaches out of space along {} at t = {:.4g} s: keep it inside", "xyz"[a], key.t);
    }
  }
  return {};
}

/// Returns the fault of a region that reaches out of the box, or into a collider; empty if there is
/// none.
std::string misplaced(const World<double>& world, const model::Space& space, const Region& region) {
  const Box3d box = region.bounds();
  const double slack = 1e-6 * world.dx;
  const Vec3d end = space.end();
  for (int a = 0; a < 3; ++a)
    if (box.min[a] < space.min[a] - slack || box.max[a] > end[a] + slack)
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

void add_inflow(World<double>& world, const model::Scene& scene, const Meshes& meshes, const std::string& file,
                std::vector<std::string>& errors) {
  const double spacing = scene.space.spacing;
  const auto region_of = [&](const Shape& shape, const std::string& what,
                             const std::string& at) -> std::shared_ptr<const Region> {
    try {
      return make_region(shape, spacing, meshes.regions());
    } catch (const InputError& e) {
      errors.push_back(fmt::format("{}: error: {}: {}", at, what, e.what()));
      return nullptr;
    }
  };
  for (const model::Emitter& e : scene.emitters) {
    const std::string what = "emitter " + e.name;
    const auto region = region_of(e.shape, what, place(file, scene, e));
    if (!region) continue;
    if (const std::string wrong = misplaced(world, scene.space, *region); !wrong.empty())
      errors.push_back(fmt::format("{}: error: {} {}", place(file, scene, e), what, wrong));
    Emitter one;
    one.name = e.name, one.shape = region, one.set = index_of(scene.materials, e.material);
    one.along = normalized(e.velocity.value_or(e.direction));
    if (e.velocity) one.speed = {{0, length(*e.velocity)}};
    if (!e.flow.empty()) {
      const double area = EmissionPattern(*region, one.along, spacing).area();
      if (!(area > 0)) {
        errors.push_back(fmt::format("{}: error: {} is thinner than space.spacing {} m: make it larger",
                                     place(file, scene, e), what, spacing));
        continue;
      }
      for (const Key<double>& key : e.flow) one.speed.push_back({key.t, key.value / area});
    }
    one.swirl = e.swirl, one.jitter = e.jitter, one.color = e.color;
    one.start = e.start, one.stop = e.stop.value_or(one.stop);
    one.pool = static_cast<std::uint64_t>(e.pool), one.recycle = e.recycle;
    one.path = motion_path(e.motion, e.shape, spacing, meshes);
    if (one.path)
      if (const std::string wrong = leaves(world, scene.space, one); !wrong.empty())
        errors.push_back(fmt::format("{}: error: {} {}", place(file, scene, e), what, wrong));
    world.emitters.push_back(std::move(one));
  }
  for (const model::Sink& s : scene.sinks)
    if (const auto region = region_of(s.shape, "sink " + s.name, place(file, scene, s))) {
      Sink& sink = world.sinks.emplace_back();
      sink.name = s.name, sink.shape = region;
      sink.path = motion_path(s.motion, s.shape, spacing, meshes);
    }
  for (std::size_t c = 0; c < scene.colliders.size(); ++c)
    if (scene.colliders[c].deletes) world.sinks.push_back({scene.colliders[c].name, nullptr, c});
}

std::uint64_t most_inflow(const World<double>& world, double until) {
  std::uint64_t sum = 0;
  for (const Emitter& e : world.emitters) {
    if (until < e.start) continue;
    const double spacing = world.sets.at(e.set).spacing();
    const double came = EmissionPattern(*e.shape, e.along, spacing).area() * e.moved(std::min(until, e.stop)),
                 volume = region_volume(*e.shape, spacing) + came;
    sum += std::min(e.pool, static_cast<std::uint64_t>(volume / (spacing * spacing * spacing)));
  }
  return sum;
}

}  // namespace dreampm
