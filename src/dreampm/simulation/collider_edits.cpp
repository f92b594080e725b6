// Edits of a running simulation: colliders and rigid bodies that come and go, and hands that hold
// them.
#include <fmt/ranges.h>

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/rigid.h"
#include "dreampm/simulation.h"
#include "dreampm/simulation/simulation_impl.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// Cells that a surface may be off its collider's pose.
constexpr double most_slack = 0.25;

std::size_t number_of(const model::Scene& scene, std::string_view name) {
  const auto at =
      std::find_if(scene.colliders.begin(), scene.colliders.end(), [&](const auto& c) { return c.name == name; });
  return static_cast<std::size_t>(at - scene.colliders.begin());
}

void refuse_taken(const model::Scene& scene, const std::string& name) {
  const auto taken = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  };
  if (taken(scene.materials) || taken(scene.colliders))
    fail_input("a material or collider of the name {} is there already: give another", name);
}

/// A collider that the world has not yet.
struct Newcomer {
  Collider collider;
  CollisionShape collision;  ///< where rigid bodies are in the world
};

/// Makes the world's colliders those of the scene, in its order: one that the world has not is the
/// newcomer, which else may be null. What goes by their numbers goes along.
template <class R>
void arrange(World<R>& world, const model::Scene& scene, const Newcomer* newcomer) {
  std::vector<Collider> colliders;
  std::vector<CollisionShape> collision;
  std::vector<std::optional<std::size_t>> to(world.colliders.size());
  for (const model::Collider& given : scene.colliders) {
    const auto known = std::find_if(world.colliders.begin(), world.colliders.end(),
                                    [&](const Collider& c) { return c.name == given.name; });
    const auto old = static_cast<std::size_t>(known - world.colliders.begin());
    const bool is_known = known != world.colliders.end();
    if (is_known) to[old] = colliders.size();
    if (!world.collision.empty()) collision.push_back(is_known ? world.collision[old] : newcomer->collision);
    colliders.push_back(is_known ? std::move(*known) : newcomer->collider);
  }
  std::erase_if(world.rigid, [&](const RigidBody& b) { return !to[b.collider]; });
  for (RigidBody& b : world.rigid) b.collider = *to[b.collider];
  std::erase_if(world.sinks, [&](const Sink& s) { return s.collider && !to[*s.collider]; });
  for (Sink& s : world.sinks)
    if (s.collider) s.collider = to[*s.collider];
  world.colliders = std::move(colliders);
  world.collision = world.rigid.empty() ? std::vector<CollisionShape>{} : std::move(collision);
}

/// Throws InputError where matter or, unless it is one itself, a rigid body lies deep in a
/// collider.
template <class R>
void refuse_overlap(const World<R>& world, std::size_t c, const std::string& what) {
  std::vector<Vec3d> points;
  const bool repeats = std::any_of(world.periodic.begin(), world.periodic.end(), [](bool axis) { return axis; });
  const Box3d reach = repeats ? world.domain() : world.colliders[c].bounds();
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    ParticleSetView(world, s).for_each_near(reach, [&](std::size_t, const Vec3d& x) { points.push_back(x); });
  if (const Overlap in = matter_inside(points, world, c); in.depth > shallow_overlap * world.dx)
    fail_input("{}: {} particles lie inside of it, up to {:.3g} m deep: put it elsewhere, or take them out first", what,
               in.particles, in.depth);
  for (std::size_t other = 0; other < world.colliders.size(); ++other) {
    if (other == c || !(world.colliders[c].rigid || world.colliders[other].rigid)) continue;
    const bool is_body = world.colliders[c].rigid;
    if (const auto inside = starts_inside(world, is_body ? c : other, is_body ? other : c))
      fail_input("{}: {}", what, *inside);
  }
}

/// Goes on with a scene that has one collider or rigid body more.
void put_in(Simulation::Impl& impl, const Scene& next, std::string_view name, const std::string& what) {
  const model::Scene& scene = next.model();
  const std::size_t c = number_of(scene, name);
  const model::Collider& given = scene.colliders.at(c);
  impl.with_engine([&]<class R>(Engine<R>& engine) {
    const Meshes files(Meshes::Say::keep);
    engine.download(MatterFields::all);
    World<R>& world = engine.world();
    // Calls that read files come first: they may throw.
    Newcomer newcomer{make_collider(given, scene, world.time, files), {}};
    std::vector<CollisionShape> of_all;  // where it is the first rigid body
    if (!world.collision.empty())
      newcomer.collision = collision_shape(given, scene.space);
    else if (given.rigid)
      for (const model::Collider& one : scene.colliders) of_all.push_back(collision_shape(one, scene.space));
    arrange(world, scene, &newcomer);
    try {
      if (given.rigid) {
        if (world.collision.empty()) world.collision = std::move(of_all);
        std::vector<std::string> errors;
        make_rigid(world, c, given, scene.space, errors);
        if (!errors.empty()) throw InputError(fmt::format("{}: {}", what, fmt::join(errors, "\n")));
        std::sort(world.rigid.begin(), world.rigid.end(),
                  [](const RigidBody& a, const RigidBody& b) { return a.collider < b.collider; });
      }
      refuse_overlap(world, c, what);
      if (given.deletes) world.sinks.push_back({given.name, nullptr, c});
    } catch (...) {
      arrange(world, impl.state.scene.model(), nullptr);  // as it was
      throw;
    }
    engine.colliders_changed();
  });
  impl.state.scene = next;
  impl.received = {};
  impl.state.edited = true;
}

/// Goes on without a collider.
void take_out(Simulation::Impl& impl, std::string_view name) {
  // Checked for what else goes by its name.
  const Scene next = impl.edited([&](model::Scene& bare) {
    std::erase_if(bare.colliders, [&](const model::Collider& c) { return c.name == name; });
    bare.render.looks.erase(std::string(name));
    for (model::Body& body : bare.bodies) std::erase(body.cut, name);  // they are as they were at the start
  });
  impl.with_engine([&]<class R>(Engine<R>& engine) {
    engine.download(MatterFields::all);
    arrange(engine.world(), next.model(), nullptr);
    engine.colliders_changed();
  });
  impl.state.scene = next;
  impl.received = {};
  impl.state.edited = true;
}

}  // namespace

void Simulation::attach(std::string_view rigid, const SpringAnchor& anchor) {
  if (!is_finite(anchor.at) || !is_finite(anchor.to) || !(anchor.stiffness > 0) || !(anchor.damping >= 0) ||
      !std::isfinite(anchor.stiffness + anchor.damping))
    fail_input("hold: at and to must be finite, stiffness above 0 and damping at least 0");
  impl_->with_engine([&](auto& engine) {
    impl_->rigid_body(engine.world(), rigid).hold = Hold{anchor.at, {anchor.to, anchor.stiffness, anchor.damping}};
  });
}

void Simulation::detach(std::string_view rigid) {
  impl_->with_engine([&](auto& engine) { impl_->rigid_body(engine.world(), rigid).hold.reset(); });
}

void Simulation::detach() {
  impl_->with_engine([](auto& engine) {
    for (RigidBody& body : engine.world().rigid) body.hold.reset();
  });
}

void Simulation::set_surface_tolerance(std::string_view collider, double cells) {
  if (!(cells > 0 && cells <= most_slack))
    fail_input("set_surface_tolerance: {}: must be above 0 to {} cells", cells, most_slack);
  impl_->with_engine([&](auto& engine) { impl_->collider(engine.world(), collider).slack = cells; });
}

void Simulation::add(const model::Collider& collider, const std::optional<model::Look>& look) {
  refuse_taken(scene().model(), collider.name);
  if (collider.pin || collider.holds)
    fail_input("{} holds the matter that a scene begins with: give it with the scene, or set a brush", collider.name);
  const Scene next = impl_->edited([&](model::Scene& scene) {
    // The order of colliders in a scene file: colliders, rigid bodies, pins.
    const auto kind = [](const model::Collider& c) { return c.pin ? 2 : c.rigid ? 1 : 0; };
    const auto before = std::find_if(scene.colliders.begin(), scene.colliders.end(),
                                     [&](const model::Collider& c) { return kind(c) > kind(collider); });
    scene.colliders.insert(before, collider);
    if (look) scene.render.looks[collider.name] = *look;
  });
  put_in(*impl_, next, collider.name, (collider.rigid ? "rigid body " : "collider ") + collider.name);
}

void Simulation::remove_collider(std::string_view name) {
  impl_->with_engine([&](auto& engine) { impl_->collider(engine.world(), name); });
  const model::Scene& scene = this->scene().model();
  if (const model::Collider& c = scene.colliders.at(number_of(scene, name)); c.pin || c.deletes)
    fail_input("remove_collider: {} is a {}, which stays", name, c.pin ? "pin" : "sink");
  take_out(*impl_, name);
}

}  // namespace dreampm
