// Edits of a running simulation. The scene that it goes by changes with it, and so do its messages:
// what is asked for is laid over the scene, which is read again.
#include <fmt/ranges.h>

#include <array>

#include "dreampm/backend/carried_motion.h"
#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/scene/emit.h"
#include "dreampm/setup/body_checks.h"
#include "dreampm/setup/colliders.h"
#include "dreampm/setup/projection_checks.h"
#include "dreampm/simulation.h"
#include "dreampm/simulation/simulation_impl.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

/// A body of this name alone in the scene.
SceneDescription with_only(const Scene& scene, const NewBody& body) {
  SceneDescription empty = scene.description();
  empty.bodies.clear();
  empty.start.clear();
  empty.emitters.clear();
  empty.sinks.clear();
  empty.probes.clear();  // they may name bodies
  const std::string text =
      fmt::format("bodies.{}={{material: {}, shape: {}, velocity: {}, spin: {}{}}}", body.name, body.material,
                  body.shape.text(), scene::flow_text(body.velocity), scene::flow_text(body.spin),
                  body.color ? ", color: " + scene::flow_text(*body.color) : "");
  return Scene(std::move(empty), scene.file()).with({text}).description();
}

template <class R>
Vec3d momentum_of(const ParticleSet<R>& set, const typename Motion<R>::Set& motion, std::size_t p) {
  return static_cast<Vec3d>(motion.velocity[p]) * set.mass;
}

}  // namespace

Scene Simulation::Impl::edited_scene(const std::vector<std::string>& set) const {
  Scene with = state.scene.with(set);
  if (const auto refused = projection_refusals(with.description(), with.file()); !refused.empty())
    throw InputError(fmt::format("{}", fmt::join(refused, "\n")));
  return with;
}

void Simulation::set_cfl(double cfl) {
  impl_->state.scene = impl_->edited_scene({fmt::format("time.cfl={}", cfl)});
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

SceneShape SceneShape::box(const Vec3d& min, const Vec3d& max) {
  return SceneShape(fmt::format("{{box: {{min: {}, max: {}}}}}", scene::flow_text(min), scene::flow_text(max)));
}
SceneShape SceneShape::sphere(const Vec3d& center, double radius) {
  return SceneShape(fmt::format("{{sphere: {{radius: {}}}, center: {}}}", radius, scene::flow_text(center)));
}
SceneShape SceneShape::cylinder(const Vec3d& center, double radius, double height) {
  return SceneShape(
      fmt::format("{{cylinder: {{radius: {}, height: {}}}, center: {}}}", radius, height, scene::flow_text(center)));
}
SceneShape SceneShape::yaml(std::string text) { return SceneShape(std::move(text)); }

void Simulation::set_parameter(std::string_view material, std::string_view key, double value) {
  const std::size_t m = impl_->material(material);
  // What a scene file says in words alone is said in them, and so is a word's number out of range.
  std::string text = fmt::format("{}", value);
  if (const Param* p = scene().description().materials[m].info->find(key))
    for (const Word& word : p->words)
      if (word.value == value && (p->words_only || value < p->min || value > p->max)) text = word.name;
  impl_->state.scene = impl_->edited_scene({fmt::format("materials.{}.{}={}", material, key, text)});
  std::vector<std::string> notes;
  impl_->with_engine([&](auto& engine) {
    use_material(engine.world().sets[m], scene().description().materials[m], engine.world(), impl_->state.expected,
                 notes);
  });
  impl_->state.edited = true;
}

void Simulation::set_gravity(const Vec3d& gravity) {
  impl_->state.scene = impl_->edited_scene({"gravity=" + scene::flow_text(gravity)});
  impl_->with_engine([&](auto& engine) {
    engine.world().gravity = gravity;
    engine.world().gravity_keys.clear();
    // Neither the grid of explicit steps nor the length of the next one depends on it.
    if (engine.world().settings.solver == SolverKind::projection) impl_->state.edited = true;
  });
}

void Simulation::set_wall(Side side, std::string_view type, double friction) {
  const auto s = static_cast<std::size_t>(side);
  // Those that are without friction may not say that they have none.
  const bool says_friction = friction != 0 || type == "separate" || type == "slip";
  impl_->state.scene = impl_->edited_scene({fmt::format("space.walls.{}={{type: {}{}}}", scene::wall_names.at(s), type,
                                                        says_friction ? fmt::format(", friction: {}", friction) : "")});
  const scene::Wall& wall = scene().description().space.walls[s];
  impl_->with_engine([&](auto& engine) { engine.world().walls[s] = {wall.type, wall.friction, wall.skin_friction}; });
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

void Simulation::set_brush(std::string_view name, const Stroke& stroke) {
  if (!is_finite(stroke.point) || !is_finite(stroke.velocity) || !(stroke.radius > 0) || !(stroke.rate >= 0) ||
      !std::isfinite(stroke.radius + stroke.rate))
    fail_input("set_brush: point and velocity must be finite, radius above 0 and rate at least 0");
  for (const ForceField& f : scene().description().fields)
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

void Simulation::lift_brush(std::string_view name) {
  impl_->with_engine([&](auto& engine) {
    std::vector<ForceField>& fields = engine.world().fields;
    const auto own = fields.begin() + static_cast<std::ptrdiff_t>(scene().description().fields.size());
    const auto brush = std::find_if(own, fields.end(), [&](const ForceField& f) { return f.name == name; });
    if (brush == fields.end()) return;
    fields.erase(brush);
  });
}

void Simulation::add_material(const std::string& name, const std::string& text, const std::string& look) {
  const std::vector<std::string> names = scene().materials();
  if (std::find(names.begin(), names.end(), name) != names.end())
    fail_input("add_material: the scene has a material {} already", name);
  std::vector<std::string> over{fmt::format("materials.{}={}", name, text)};
  if (!look.empty()) over.push_back(fmt::format("render.looks.{}={}", name, look));
  const Scene with = impl_->edited_scene(over);
  if (with.materials().back() != name) fail_run("material {} is not the last of its scene", name);
  std::vector<std::string> notes;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    engine.download(MatterFields::all);
    World<R>& world = engine.world();
    ParticleSet<R>& set = world.sets.emplace_back();
    const double spacing = scene().spacing();
    set.rest_volume = spacing * spacing * spacing;
    use_material(set, with.description().materials.back(), world, impl_->state.expected, notes);
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
  SceneDescription scene = this->scene().description();
  for (scene::Emitter& e : scene.emitters)
    if (e.material == static_cast<int>(old)) e.material = static_cast<int>(now);
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
  impl_->state.scene = Scene(std::move(scene), this->scene().file());
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

void Simulation::add(const NewBody& body) {
  for (const BodyRange& b : impl_->state.bodies)
    if (b.name == body.name) fail_input("a body of the name {} is there already: give another", body.name);
  const std::size_t m = impl_->material(body.material);
  const SceneDescription alone = with_only(scene(), body);
  const InitialState matter =
      impl_->with_engine([&](auto& engine) { return assemble(alone, scene().file(), engine.world().colliders); });
  const std::uint32_t first = impl_->insert(m, matter.seeds.at(m), fmt::format("body {}", body.name));
  const auto count = static_cast<std::uint32_t>(matter.seeds.at(m).size());
  impl_->state.bodies.push_back({body.name, first, count, alone.bodies.at(0).color});
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
  const scene::Space& space = scene().description().space;
  std::vector<ParticleSeed> seeds;
  std::vector<Vec3d> positions;
  seeds.reserve(particles.size()), positions.reserve(particles.size());
  for (const NewParticle& one : particles) {
    const auto& [p, v, gradient] = one;
    if (!is_finite(v) || !std::all_of(gradient.begin(), gradient.end(), [](const Vec3d& g) { return is_finite(g); }))
      fail_input("add_particles: velocities and their gradients must be finite numbers");
    if (!is_finite(p) || max(min(p, space.max), space.min) != p)
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

std::size_t Simulation::remove(const SceneShape& shape) {
  // A shape is checked as that of a collider is, which may lie anywhere.
  SceneDescription bare = scene().description();
  for (const scene::Collider& c : bare.colliders) bare.render.looks.erase(c.name);
  bare.colliders.clear();
  for (scene::Body& body : bare.bodies) body.cut.clear();
  bare.probes.clear();  // they may name colliders, as a cut may
  bare.render.cut.reset();
  const SceneDescription with = Scene(std::move(bare), scene().file())
                                    .with({fmt::format("colliders.removed={{shape: {}}}", shape.text())})
                                    .description();
  std::size_t taken = 0;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    const Meshes files(Meshes::Say::keep);
    const auto region = make_region(with.colliders.at(0).shape, with.space.spacing, files.regions());
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
