// Edits of a running simulation. The scene that it goes by changes with it: a copy of the model is
// changed and checked, and the difference goes to the world. No text is made, and no file is read.
#include <fmt/ranges.h>

#include <array>

#include "dreampm/backend/carried_motion.h"
#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/scene/check.h"
#include "dreampm/setup/body_checks.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/projection_checks.h"
#include "dreampm/simulation.h"
#include "dreampm/simulation/scene_access.h"
#include "dreampm/simulation/simulation_impl.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// The scene with a body in place of those that it has, checked and with no other way for matter to
/// come in.
model::Scene with_only(const Scene& scene, const model::Body& body) {
  model::Scene alone = scene.model();
  alone.bodies = {body};
  alone.start.clear(), alone.emitters.clear(), alone.sinks.clear();
  alone.probes.clear();  // they may name bodies
  return Scene(std::move(alone), scene.file()).model();
}

/// Gives a parameter a value, or one of the keys of its transfer. One that is another way to say
/// the same is forgotten.
void set_value(model::Material& material, std::string_view key, double value) {
  const MaterialInfo& info = info_of(material);
  const Param* p = info.find(key);
  if (!p) return (is_transfer_key(key) ? material.transfer_values : material.values).set(key, value);
  for (const Param& other : info.params)
    if (other.excludes == key || other.key == p->excludes) material.values.erase(other.key);
  material.values.set(key, value);
}

template <class R>
Vec3d momentum_of(const ParticleSet<R>& set, const typename Motion<R>::Set& motion, std::size_t p) {
  return static_cast<Vec3d>(motion.velocity[p]) * set.mass;
}

/// Gives a set velocities of its own, or takes them away, as its transfer now wants it.
template <class R>
void set_own_velocity(ParticleSet<R>& set, const typename Motion<R>::Set& motion) {
  for (std::size_t a = 0; a < 3; ++a) {
    set.own_velocity[a].resize(set.has_own_velocity() ? set.size() : 0);
    for (std::size_t p = 0; p < set.own_velocity[a].size(); ++p)
      set.own_velocity[a][p] = motion.velocity[p][static_cast<int>(a)];
  }
}

}  // namespace

Scene Simulation::Impl::checked(model::Scene next) const {
  Scene scene(std::move(next), state.scene.file());
  if (const auto refused = refused_parts(scene); !refused.empty())
    throw InputError(fmt::format("{}", fmt::join(refused, "\n")));
  return scene;
}

void Simulation::set_cfl(double cfl) {
  impl_->state.scene = impl_->edited([&](model::Scene& next) { next.time.cfl = cfl; });
  impl_->with_engine([&](auto& engine) { engine.world().settings.cfl = cfl; });
  impl_->state.edited = true;
}

std::uint32_t Simulation::Impl::insert(std::size_t m, std::vector<ParticleSeed> seeds, const std::string& what) {
  const std::uint32_t first = with_engine([&]<class R>(Engine<R>& engine) {
    World<R>& world = engine.world();
    // Emitters give ids too.
    std::uint32_t& next_id = world.emitters.empty() ? state.next_id : world.next_id;
    const std::uint32_t id = next_id;
    const std::size_t room = std::numeric_limits<std::uint32_t>::max() - id;
    if (seeds.size() > room) fail_run("{}: ids for {} particles are left", what, room);
    for (ParticleSeed& seed : seeds) seed.id += id;
    engine.download(MatterFields::all);
    if (carries_motion(world)) {
      dreampm::insert<R>(world, m, seeds);
      take_carried_motion(world, engine.motion());
    } else {
      MotionById<R> motion(world, engine.motion());
      motion.add(m, seeds);
      dreampm::insert<R>(world, m, seeds);
      engine.motion() = motion.ordered(world);
    }
    engine.upload(MatterFields::all);
    const double mass = world.sets[m].mass;
    EditSums& sums = state.edits;
    sums.entered += seeds.size();
    sums.entered_mass += mass * static_cast<double>(seeds.size());
    for (const ParticleSeed& seed : seeds) sums.entered_momentum += seed.velocity * mass;
    next_id += static_cast<std::uint32_t>(seeds.size());
    return id;
  });
  forget_views();
  state.edited = true;
  return first;
}

void Simulation::set_parameter(std::string_view material, std::string_view key, double value) {
  const std::size_t m = impl_->material(material);
  if (!std::isfinite(value))
    fail_input("set_parameter: materials.{}.{} is {}: must be a finite number", material, key, value);
  impl_->state.scene = impl_->edited([&](model::Scene& next) { set_value(next.materials[m], key, value); });
  std::vector<std::string> notes;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    ParticleSet<R>& set = engine.world().sets[m];
    const bool kept = set.has_own_velocity();
    if (is_transfer_key(key)) engine.download(MatterFields::all);
    use_material(set, scene().model().materials[m], engine.world(), impl_->state.expected, notes);
    if (set.has_own_velocity() == kept) return;
    set_own_velocity(set, engine.motion().sets[m]);
    engine.upload(MatterFields::state);
  });
  impl_->state.edited = true;
}

void Simulation::set_gravity(const Vec3d& gravity) {
  impl_->state.scene = impl_->edited([&](model::Scene& next) {
    next.gravity = gravity;
    next.gravity_keys.clear();
  });
  impl_->with_engine([&](auto& engine) {
    engine.world().gravity = gravity;
    engine.world().gravity_keys.clear();
    // Neither the grid of explicit steps nor the length of the next one depends on it.
    if (engine.world().settings.solver == SolverKind::projection) impl_->state.edited = true;
  });
}

void Simulation::set_wall(Side side, const Wall& wall) {
  const std::size_t s = index(side);
  if (scene().model().space.periodic.at(s / 2))
    fail_input("set_wall: space.walls.{} is on the periodic axis {}: there is no wall", side_names[s], "xyz"[s / 2]);
  impl_->state.scene = impl_->edited([&](model::Scene& next) { next.space.walls[s] = wall; });
  impl_->with_engine([&](auto& engine) { engine.world().walls[s] = wall; });
  impl_->state.edited = true;
}

void Simulation::set_motion(std::string_view collider, const Twist& motion) {
  if (!is_finite(motion.velocity) || !is_finite(motion.spin) || !is_finite(motion.center))
    fail_input("set_motion: collider {}: velocity, spin and center must be finite numbers", collider);
  impl_->with_engine([&](auto& engine) {
    Collider& c = impl_->collider(engine.world(), collider);
    c.twist = motion;
    c.path.reset();
  });
  impl_->state.edited = true;
}

void Simulation::set_brush(std::string_view name, const VelocityBrush& stroke) {
  if (!is_finite(stroke.point) || !is_finite(stroke.velocity) || !(stroke.radius > 0) || !(stroke.rate >= 0) ||
      !std::isfinite(stroke.radius + stroke.rate))
    fail_input("set_brush: point and velocity must be finite, radius above 0 and rate at least 0");
  for (const model::ForceField& f : scene().model().fields)
    if (f.name == name) fail_input("set_brush: the scene has a field of the name {}: give another", name);
  impl_->with_engine([&](auto& engine) {
    std::vector<ForceField>& fields = engine.world().fields;
    const Brush brush{stroke.point, stroke.radius, stroke.velocity, stroke.rate};
    const auto known = std::find_if(fields.begin(), fields.end(), [&](const ForceField& f) { return f.name == name; });
    if (known == fields.end())
      fields.push_back({std::string(name), brush, std::nullopt});
    else
      known->field = brush;
  });
  impl_->state.brush_speed = std::max(impl_->state.brush_speed, length(stroke.velocity));
}

void Simulation::remove_brush(std::string_view name) {
  impl_->with_engine([&](auto& engine) {
    std::vector<ForceField>& fields = engine.world().fields;
    const auto own = fields.begin() + static_cast<std::ptrdiff_t>(scene().model().fields.size());
    const auto brush = std::find_if(own, fields.end(), [&](const ForceField& f) { return f.name == name; });
    if (brush == fields.end()) return;
    fields.erase(brush);
  });
}

void Simulation::add_material(const model::Material& material, const std::optional<model::Look>& look) {
  const std::vector<std::string> names = scene().materials();
  if (std::find(names.begin(), names.end(), material.name) != names.end())
    fail_input("add_material: the scene has a material {} already", material.name);
  const Scene with = impl_->edited([&](model::Scene& next) {
    next.materials.push_back(material);
    if (look) next.render.looks[material.name] = *look;
  });
  std::vector<std::string> notes;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    engine.download(MatterFields::all);
    World<R>& world = engine.world();
    ParticleSet<R>& set = world.sets.emplace_back();
    const double spacing = scene().spacing();
    set.rest_volume = spacing * spacing * spacing;
    use_material(set, with.model().materials.back(), world, impl_->state.expected, notes);
    engine.motion().sets.emplace_back();
    insert<R>(world, world.sets.size() - 1, {});
    engine.replace(World<R>(world), &std::as_const(engine).motion());  // to backends a world of other sets is another
  });
  impl_->state.scene = with;
  impl_->forget_views();
  impl_->state.edited = true;
}

std::size_t Simulation::convert(std::string_view from, std::string_view to) {
  const std::size_t old = impl_->material(from), now = impl_->material(to);
  if (old == now) return 0;
  model::Scene scene = this->scene().model();
  for (model::Emitter& e : scene.emitters)
    if (e.material == from) e.material = to;
  const std::size_t count = impl_->with_engine([&]<class R>(Engine<R>& engine) {
    World<R>& world = engine.world();
    engine.download(MatterFields::all);
    typename Motion<R>::Set& motion = engine.motion().sets[old];
    std::vector<ParticleSeed> seeds(world.sets[old].size());
    const ParticleSetView particles(world, old);
    EditSums& sums = impl_->state.edits;
    particles.for_each([&](std::size_t p, const Vec3d& x) {
      seeds[p] = {particles.id(p), x, static_cast<Vec3d>(motion.velocity[p]), static_cast<Mat3d>(motion.gradient[p])};
      sums.removed_mass += world.sets[old].mass, sums.entered_mass += world.sets[now].mass;
      sums.removed_momentum += momentum_of(world.sets[old], motion, p);
      sums.entered_momentum += seeds[p].velocity * world.sets[now].mass;
    });
    sums.removed += seeds.size(), sums.entered += seeds.size();
    erase(world, old, std::vector<bool>(seeds.size(), false));
    motion = {};
    MotionById<R> by_id(world, engine.motion());
    by_id.add(now, seeds);
    dreampm::insert<R>(world, now, seeds);
    engine.motion() = by_id.ordered(world);
    for (Emitter& e : world.emitters)
      if (e.set == old) e.set = now;
    engine.upload(MatterFields::all);
    return seeds.size();
  });
  impl_->state.scene = SceneAccess::make(std::move(scene), this->scene().file());
  impl_->forget_views();
  impl_->state.edited = true;
  return count;
}

void Simulation::reset_state(std::string_view material) {
  const std::size_t m = impl_->material(material);
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    engine.download(MatterFields::state | MatterFields::motion);
    put_to_rest(engine.world().sets[m]);
    typename Motion<R>::Set& motion = engine.motion().sets[m];
    std::fill(motion.gradient.begin(), motion.gradient.end(), Mat3<R>{});
    std::fill(motion.energy.begin(), motion.energy.end(), R(0));
    std::fill(motion.volume_ratio.begin(), motion.volume_ratio.end(), R(1));
    engine.upload(MatterFields::state | MatterFields::motion);
  });
  impl_->forget_views();
  impl_->state.edited = true;
}

void Simulation::add(const model::Body& body) {
  for (const BodyRange& b : impl_->state.bodies)
    if (b.name == body.name) fail_input("a body of the name {} is there already: give another", body.name);
  const std::size_t m = impl_->material(body.material);
  const model::Scene alone = with_only(scene(), body);
  const InitialState matter =
      impl_->with_engine([&](auto& engine) { return assemble(alone, scene().file(), engine.world().colliders); });
  const std::uint32_t first = impl_->insert(m, matter.seeds.at(m), fmt::format("body {}", body.name));
  const auto count = static_cast<std::uint32_t>(matter.seeds.at(m).size());
  impl_->state.bodies.push_back({body.name, first, count, alone.bodies.at(0).color, time()});
  impl_->state.added.push_back(alone.bodies.at(0));
}

void Simulation::add_particles(std::string_view material, std::span<const Vec3d> positions, const Vec3d& velocity) {
  if (!is_finite(velocity)) fail_input("add_particles: the velocity must be finite numbers");
  std::vector<NewParticle> particles;
  particles.reserve(positions.size());
  for (const Vec3d& p : positions) particles.push_back({p, velocity});
  add_particles(material, particles);
}

void Simulation::add_particles(std::string_view material, std::span<const NewParticle> particles) {
  const std::size_t m = impl_->material(material);
  const model::Space& space = scene().model().space;
  std::vector<ParticleSeed> seeds;
  std::vector<Vec3d> positions;
  seeds.reserve(particles.size()), positions.reserve(particles.size());
  for (const NewParticle& one : particles) {
    const auto& [p, v, gradient] = one;
    if (!is_finite(v) || !std::all_of(gradient.begin(), gradient.end(), [](const Vec3d& g) { return is_finite(g); }))
      fail_input("add_particles: velocities and their gradients must be finite numbers");
    if (!is_finite(p) || max(min(p, space.end()), space.min) != p)
      fail_input("add_particles: a particle at ({:.4g}, {:.4g}, {:.4g}) m is outside of the walls", p.x, p.y, p.z);
    Mat3d c;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) c(a, b) = gradient[static_cast<std::size_t>(a)][b];
    seeds.push_back({static_cast<std::uint32_t>(seeds.size()), p, v, c});
    positions.push_back(p);
  }
  if (seeds.empty()) return;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    const World<R>& world = engine.world();
    for (std::size_t c = 0; c < world.colliders.size(); ++c)
      if (const Overlap in = matter_inside(positions, world, c);
          !world.colliders[c].holds && in.depth > shallow_overlap * world.dx)
        fail_input(
            "add_particles: {} of {} particles lie inside of collider {}, up to {:.3g} m deep: put them elsewhere",
            in.particles, positions.size(), world.colliders[c].name, in.depth);
  });
  impl_->insert(m, std::move(seeds), "add_particles");
}

std::size_t Simulation::remove(const Shape& shape) {
  scene::check_shape(shape, "remove");
  std::size_t taken = 0;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    const Meshes files(Meshes::Say::keep);
    const auto region = make_region(shape, scene().spacing(), files.regions());
    World<R>& world = engine.world();
    engine.download(MatterFields::all);
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      ParticleSet<R>& set = world.sets[s];
      typename Motion<R>::Set& motion = engine.motion().sets[s];
      std::vector<bool> keep(set.size(), true);
      typename Motion<R>::Set kept;
      ParticleSetView(world, s).for_each([&](std::size_t p, const Vec3d& x) {
        keep[p] = !(region->distance(x) < 0);
        if (keep[p]) return append(kept, motion, p);
        impl_->state.edits.removed_mass += set.mass;
        impl_->state.edits.removed_momentum += momentum_of(set, motion, p);
      });
      motion = std::move(kept);
      taken += erase(world, s, keep);
    }
    engine.upload(MatterFields::all);
  });
  impl_->state.edits.removed += taken;
  if (taken > 0) impl_->forget_views(), impl_->state.edited = true;
  return taken;
}

}  // namespace dreampm
