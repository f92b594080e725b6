// Edits of a running simulation: colliders and rigid bodies that come and go, and hands that hold
// them.
#include <fmt/ranges.h>

#include <algorithm>

#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/scene/emit.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/rigid.h"
#include "dreampm/simulation.h"
#include "dreampm/simulation/simulation_impl.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// Cells that a surface may be off its collider's pose.
constexpr double most_slack = 0.25;

std::size_t number_of(const SceneDescription& scene, std::string_view name) {
  const auto at =
      std::find_if(scene.colliders.begin(), scene.colliders.end(), [&](const auto& c) { return c.name == name; });
  return static_cast<std::size_t>(at - scene.colliders.begin());
}

void refuse_taken(const SceneDescription& scene, const std::string& name, std::string_view who) {
  const auto taken = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  };
  if (taken(scene.materials) || taken(scene.colliders))
    fail_input("{}: a material or collider of the name {} is there already: give another", who, name);
}

/// Makes the world's colliders those of the scene, in its order: one that the world has not is
/// `fresh`. What goes by their numbers goes along.
template <class R>
void arrange(World<R>& world, const SceneDescription& scene, const std::optional<Collider>& fresh) {
  std::vector<Collider> colliders;
  std::vector<CollisionShape> collision;
  std::vector<std::optional<std::size_t>> to(world.colliders.size());
  for (const scene::Collider& given : scene.colliders) {
    const auto known = std::find_if(world.colliders.begin(), world.colliders.end(),
                                    [&](const Collider& c) { return c.name == given.name; });
    const auto old = static_cast<std::size_t>(known - world.colliders.begin());
    const bool is_known = known != world.colliders.end();
    if (is_known) to[old] = colliders.size();
    if (!world.collision.empty())
      collision.push_back(is_known ? world.collision[old] : collision_shape(given, scene.space));
    colliders.push_back(is_known ? std::move(*known) : *fresh);
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
  points.reserve(world.particles());
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    ParticleSetView(world, s).for_each([&](std::size_t, const Vec3d& x) { points.push_back(x); });
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
void put_in(Simulation::Impl& impl, const Scene& next, std::string_view name, const std::string& what,
            double slack = Collider::settle_distance) {
  const SceneDescription& scene = next.description();
  const std::size_t c = number_of(scene, name);
  const scene::Collider& given = scene.colliders.at(c);
  impl.with_engine([&]<class R>(Engine<R>& engine) {
    const Meshes files(Meshes::Say::keep);
    engine.download(MatterFields::all);
    // Where something throws, nothing has changed.
    World<R> world = engine.world();
    Collider fresh{given.name, collider_region(given, scene.space, files), given.type, given.friction, given.sticky,
                   given.holds};
    fresh.slack = slack;
    arrange(world, scene, fresh);
    if (given.rigid) {
      if (world.collision.empty())
        for (const scene::Collider& one : scene.colliders) world.collision.push_back(collision_shape(one, scene.space));
      std::vector<std::string> errors;
      make_rigid(world, c, given, scene.space, errors);
      if (!errors.empty()) throw InputError(fmt::format("{}: {}", what, fmt::join(errors, "\n")));
      std::sort(world.rigid.begin(), world.rigid.end(),
                [](const RigidBody& a, const RigidBody& b) { return a.collider < b.collider; });
    }
    refuse_overlap(world, c, what);
    engine.replace(std::move(world), &std::as_const(engine).motion());
  });
  impl.state.scene = next;
  impl.received = {};
  impl.state.edited = true;
}

/// Goes on without a collider.
void take_out(Simulation::Impl& impl, std::string_view name) {
  SceneDescription bare = impl.state.scene.description();
  std::erase_if(bare.colliders, [&](const scene::Collider& c) { return c.name == name; });
  bare.render.looks.erase(std::string(name));
  for (scene::Body& body : bare.bodies) std::erase(body.cut, name);  // they are as they were at the start
  // Read again, for what else goes by its name.
  const Scene next = Scene(std::move(bare), impl.state.scene.file()).with({});
  impl.with_engine([&]<class R>(Engine<R>& engine) {
    engine.download(MatterFields::all);
    World<R> world = engine.world();
    arrange(world, next.description(), std::nullopt);
    engine.replace(std::move(world), &std::as_const(engine).motion());
  });
  impl.state.scene = next;
  impl.received = {};
  impl.state.edited = true;
}

}  // namespace

void Simulation::add_rigid(const NewRigid& body) {
  refuse_taken(scene().description(), body.name, "add_rigid");
  std::vector<std::string> over{fmt::format(
      "rigid.{}={{shape: {}, density: {}, velocity: {}, spin: {}, friction: {}, restitution: {}{}}}", body.name,
      body.shape.text(), body.density, scene::flow_text(body.velocity), scene::flow_text(body.spin), body.friction,
      body.restitution, body.position ? ", position: " + scene::flow_text(*body.position) : "")};
  if (!body.look.empty()) over.push_back(fmt::format("render.looks.{}={}", body.name, body.look));
  put_in(*impl_, impl_->edited_scene(over), body.name, "rigid body " + body.name);
}

void Simulation::remove_rigid(std::string_view name) {
  impl_->with_engine([&](auto& engine) { impl_->rigid_body(engine.world(), name); });
  take_out(*impl_, name);
}

void Simulation::hold(std::string_view rigid, const Grip& grip) {
  if (!is_finite(grip.at) || !is_finite(grip.to) || !(grip.stiffness > 0) || !(grip.damping >= 0) ||
      !std::isfinite(grip.stiffness + grip.damping))
    fail_input("hold: at and to must be finite, stiffness above 0 and damping at least 0");
  impl_->with_engine([&](auto& engine) {
    impl_->rigid_body(engine.world(), rigid).hold = Hold{grip.at, {grip.to, grip.stiffness, grip.damping}};
  });
}

void Simulation::let_go(std::string_view rigid) {
  impl_->with_engine([&](auto& engine) { impl_->rigid_body(engine.world(), rigid).hold.reset(); });
}

void Simulation::let_go() {
  impl_->with_engine([](auto& engine) {
    for (RigidBody& body : engine.world().rigid) body.hold.reset();
  });
}

void Simulation::set_slack(std::string_view collider, double slack) {
  if (!(slack > 0 && slack <= most_slack))
    fail_input("set_slack: slack is {}: must be above 0 to {} cells", slack, most_slack);
  impl_->with_engine([&](auto& engine) { impl_->collider(engine.world(), collider).slack = slack; });
}

void Simulation::add_collider(const NewCollider& collider) {
  if (!(collider.slack > 0 && collider.slack <= most_slack))
    fail_input("add_collider: slack is {}: must be above 0 to {} cells", collider.slack, most_slack);
  refuse_taken(scene().description(), collider.name, "add_collider");
  // Those that are without friction may not say that they have none.
  const std::string friction = collider.friction != 0 ? fmt::format(", friction: {}", collider.friction) : "";
  std::vector<std::string> over{fmt::format("colliders.{}={{shape: {}, type: {}{}}}", collider.name,
                                            collider.shape.text(), collider.type, friction)};
  if (!collider.look.empty()) over.push_back(fmt::format("render.looks.{}={}", collider.name, collider.look));
  put_in(*impl_, impl_->edited_scene(over), collider.name, "collider " + collider.name, collider.slack);
}

void Simulation::remove_collider(std::string_view name) {
  impl_->with_engine([&](auto& engine) {
    const Collider& c = impl_->collider(engine.world(), name);
    if (c.rigid) fail_input("remove_collider: {} is a rigid body: use remove_rigid", name);
  });
  const SceneDescription& scene = this->scene().description();
  if (const scene::Collider& c = scene.colliders.at(number_of(scene, name)); c.pin || c.deletes)
    fail_input("remove_collider: {} is a {}, which stays", name, c.pin ? "pin" : "sink");
  take_out(*impl_, name);
}

}  // namespace dreampm
