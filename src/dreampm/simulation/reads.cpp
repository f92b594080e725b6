// The read side of a simulation, beside the results of steps.
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/order.h"
#include "dreampm/base/parallel.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/scene/problem.h"
#include "dreampm/scene/sections.h"
#include "dreampm/setup/collider_mesh.h"
#include "dreampm/simulation.h"
#include "dreampm/simulation/simulation_impl.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& one : list) names.push_back(one.name);
  return names;
}

/// Throws InputError for a key that the material has not.
const Param& param_of(const model::Material& material, std::string_view key) {
  if (const Param* p = info_of(material).find(key)) return *p;
  std::vector<std::string> keys;
  for (const Param& p : info_of(material).params) keys.emplace_back(p.key);
  fail_input("material {} ({}) has no parameter {}{}", material.name, material.type, key, scene::suggest(key, keys));
}

struct Attribute {
  std::string_view name, unit;
};
/// The attributes that particles of all materials have.
constexpr std::array<Attribute, 6> common_attributes{
    {{"f", "1"}, {"j", "1"}, {"jp", "1"}, {"density", "kg/m^3"}, {"pressure", "Pa"}, {"velocity_gradient", "1/s"}}};

}  // namespace

void fail_unknown(std::string_view kind, std::string_view name, const std::vector<std::string>& names) {
  fail_input("{} {} is not in the scene; it has {}", kind, name,
             names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")));
}

// ---- what there is

Names Simulation::names() const {
  const model::Scene& scene = impl_->state.scene.model();
  Names all;
  all.materials = names_of(scene.materials), all.bodies = names_of(impl_->state.bodies);
  all.emitters = names_of(scene.emitters), all.sinks = names_of(scene.sinks);
  all.probes = names_of(scene.probes), all.fields = names_of(scene.fields);
  impl_->with_engine([&](auto& engine) {
    const auto& world = engine.world();
    all.colliders = names_of(world.colliders);
    for (const RigidBody& body : world.rigid) all.rigid.push_back(world.colliders[body.collider].name);
    for (std::size_t f = scene.fields.size(); f < world.fields.size(); ++f) all.brushes.push_back(world.fields[f].name);
  });
  return all;
}

std::string Simulation::backend() const {
  return impl_->with_engine([](auto& engine) { return std::string(engine.backend().name()); });
}
std::string Simulation::isa() const {
  return impl_->with_engine([](auto& engine) { return std::string(engine.backend().isa()); });
}
int Simulation::threads() const {
  return impl_->with_engine([](auto&) { return thread_count(); });
}

ParticleCounts Simulation::counts() const {
  return impl_->with_engine([&](auto& engine) {
    const auto& world = engine.world();
    ParticleCounts c;
    c.particles = world.particles();
    c.entered = impl_->state.edits.entered, c.removed = impl_->state.edits.removed;
    for (const Sink& sink : world.sinks) c.drained += sink.taken;
    // The world's own count is of both.
    c.left = world.left - std::min(c.drained, world.left);
    return c;
  });
}

double Simulation::cfl() const { return stepping().cfl; }

Stepping Simulation::stepping() const {
  return impl_->with_engine([](auto& engine) {
    const auto& world = engine.world();
    const StepSettings& s = world.settings;
    Stepping now;
    now.solver = s.solver == SolverKind::projection ? "projection" : "explicit";
    now.cell = world.dx;
    now.cfl = s.cfl, now.dt_max = s.dt_max, now.fixed_dt = s.fixed_dt;
    now.sub_cycles = s.sub_cycles;
    now.viscous_contacts = world.viscous_contacts(), now.viscous_stages = world.viscous_stages;
    return now;
  });
}

// ---- particles

std::vector<std::string> Simulation::attributes(std::string_view material) const {
  const model::Material& m = scene().model().materials[impl_->material(material)];
  std::vector<std::string> names;
  for (const Attribute& a : common_attributes) names.emplace_back(a.name);
  for (std::string& other : other_columns(m.type)) names.push_back(std::move(other));
  return names;
}

AttributeView Simulation::attribute(std::string_view material, std::string_view name) const {
  const std::size_t m = impl_->material(material);
  const std::vector<std::string> known = attributes(material);
  if (std::find(known.begin(), known.end(), name) == known.end())
    fail_input("the particles of material {} have no attribute {}{}", material, name, scene::suggest(name, known));
  const auto common = std::find_if(common_attributes.begin(), common_attributes.end(),
                                   [&](const Attribute& a) { return a.name == name; });
  const std::vector<std::string> columns = columns_of(name);
  const auto made = std::make_shared<std::vector<float>>();
  impl_->with_engine([&](auto& engine) {
    engine.download(MatterFields::particles);
    const auto order = order_of(ParticleSetView(engine.world(), m).ids());
    made->resize(order.size() * columns.size());
    std::vector<float> column;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      column.clear();
      add_column(engine.world(), engine.motion(), m, columns[c], column);
      for (std::size_t i = 0; i < order.size(); ++i) (*made)[i * columns.size() + c] = column[order[i]];
    }
  });
  return {*made, columns.size(), common == common_attributes.end() ? "1" : common->unit, made};
}

void Simulation::visit(std::string_view material, const ParticleFields& fields,
                       const std::function<void(const ParticleBatch&)>& see) const {
  const std::size_t m = impl_->material(material);
  const auto if_wanted = [](bool wanted, MatterFields one) { return wanted ? one : MatterFields::none; };
  impl_->with_engine([&](auto& engine) {
    engine.download(if_wanted(fields.position, MatterFields::position) |
                    if_wanted(fields.velocity, MatterFields::motion) | if_wanted(fields.id, MatterFields::id));
    const ParticleSetView particles(engine.world(), m);
    constexpr std::size_t most = 512;  // whose arrays stay in the first cache
    std::array<Vec3d, most> position, velocity;
    ParticleBatch batch;
    const auto give = [&](std::size_t count) {
      batch.count = count;
      if (fields.position) batch.position = {position.data(), count};
      if (fields.velocity) {
        const auto& own = engine.motion().sets[m].velocity;
        for (std::size_t i = 0; i < count; ++i) velocity[i] = static_cast<Vec3d>(own[batch.first + i]);
        batch.velocity = {velocity.data(), count};
      }
      if (fields.id) batch.id = particles.ids().subspan(batch.first, count);
      see(batch);
      batch.first += count;
    };
    if (fields.position) {
      std::size_t count = 0;
      particles.for_each([&](std::size_t, const Vec3d& x) {
        position[count] = x;
        if (++count == most) give(std::exchange(count, 0));
      });
      if (count > 0) give(count);
    } else {
      while (batch.first < particles.size()) give(std::min(most, particles.size() - batch.first));
    }
  });
}

DeviceParticles Simulation::device_particles(std::string_view material, const ParticleFields& fields) const {
  const std::size_t m = impl_->material(material);
  return impl_->with_engine([&](auto& engine) -> DeviceParticles {
    if (engine.world().settings.solver == SolverKind::projection)
      fail_input(
          "device_particles: time.solver is projection, which computes in the host's memory: `particles` has its "
          "arrays "
          "there");
    if (fields.velocity && !engine.motion_is_current())
      fail_run("device_particles: velocities are not known, for the steps before were interrupted: take one more step");
    const auto made = engine.backend().device_particles(engine.world(), engine.motion(), m, fields);
    if (!made)
      fail_input(
          "backend {} keeps particles in the host's memory: `particles` has its arrays there; "
          "backend "
          "cuda has arrays on a GPU",
          engine.backend().name());
    return *made;
  });
}

std::uint32_t Simulation::next_id() const {
  return impl_->with_engine(
      [&](auto& engine) { return engine.world().emitters.empty() ? impl_->state.next_id : engine.world().next_id; });
}

BodyState Simulation::body(std::string_view name) const {
  const SimulationState& state = impl_->state;
  const auto range =
      std::find_if(state.bodies.begin(), state.bodies.end(), [&](const BodyRange& b) { return b.name == name; });
  if (range == state.bodies.end()) fail_unknown("body", name, names_of(state.bodies));
  const model::Scene& scene = state.scene.model();
  BodyState body{{}, range->first_id, range->count, range->color};
  for (const std::vector<model::Body>* list : {&scene.bodies, &state.added})
    for (const model::Body& b : *list)
      if (b.name == name) body.material = b.material;
  return body;
}

// ---- materials

double Simulation::parameter(std::string_view material, std::string_view key) const {
  const model::Material& m = scene().model().materials[impl_->material(material)];
  return m.values[param_of(m, key).key];
}

std::vector<Parameter> Simulation::parameters(std::string_view material) const {
  const model::Material& m = scene().model().materials[impl_->material(material)];
  std::vector<Parameter> all;
  for (const Param& p : info_of(m).params) {
    Parameter& one = all.emplace_back(Parameter{p.key, p.unit, m.values[p.key], p.min, p.max, p.help, p.log, {}, {}});
    for (const Word& word : p.words) one.words.emplace_back(word.name, word.value);
    one.words_only = p.words_only;
  }
  return all;
}

MaterialState Simulation::material(std::string_view name, std::span<const ParameterValue> with) const {
  const std::size_t m = impl_->material(name);
  const model::Material& own = scene().model().materials[m];
  MaterialState state{own.type, info_of(own).liquid};
  const auto take = [&](const auto& set) {
    state.particle_mass = set.mass, state.particle_volume = set.rest_volume;
    const MaterialFacts facts = facts_of(info_of(own), set.values);
    state.sound_speed = facts.sound_speed, state.kinematic_viscosity = facts.kinematic_viscosity;
    state.poissons_ratio = facts.poissons_ratio;
  };
  if (with.empty()) {
    impl_->with_engine([&](auto& engine) { take(engine.world().sets[m]); });
    return state;
  }
  model::Material other = own;
  for (const ParameterValue& v : with) other.values.set(param_of(own, v.key).key, v.value);
  ParticleSet<double> set;
  set.rest_volume = std::pow(scene().spacing(), 3);
  std::vector<std::string> notes;
  use_material(set, std::move(other), World<double>{}, impl_->state.expected, notes);  // cells change nothing of it
  take(set);
  return state;
}

// ---- gravity, walls, colliders, brushes

Vec3d Simulation::gravity() const {
  return impl_->with_engine([](auto& engine) { return engine.world().gravity_at(engine.world().time); });
}

Wall Simulation::wall(Side side) const {
  return impl_->with_engine([&](auto& engine) { return engine.world().walls.at(index(side)); });
}

struct ColliderShape::Data {
  Collider collider;
  double mass;
};

const std::string& ColliderShape::name() const { return data_->collider.name; }
double ColliderShape::mass() const { return data_->mass; }
bool ColliderShape::is_rigid() const { return data_->collider.rigid; }
double ColliderShape::distance(const Vec3d& point) const { return data_->collider.distance(point); }
Vec3d ColliderShape::normal(const Vec3d& point) const { return data_->collider.normal(point); }
Vec3d ColliderShape::velocity(const Vec3d& point) const { return data_->collider.velocity(point); }
Box3d ColliderShape::bounds() const { return data_->collider.bounds(); }
Box3d ColliderShape::own_bounds() const { return data_->collider.shape->bounds(); }

namespace {

/// Null of a collider that is no rigid body.
template <class World>
const RigidBody* body_of(const World& world, const Collider& c) {
  const auto number = static_cast<std::size_t>(&c - world.colliders.data());
  const auto body =
      std::find_if(world.rigid.begin(), world.rigid.end(), [&](const RigidBody& b) { return b.collider == number; });
  return body == world.rigid.end() ? nullptr : &*body;
}
template <class World>
double mass_of(const World& world, const Collider& c) {
  const RigidBody* body = body_of(world, c);
  return body ? body->mass : 0;
}

}  // namespace

ColliderState Simulation::collider(std::string_view name) const {
  return impl_->with_engine([&](auto& engine) {
    const auto& world = engine.world();
    const Collider& c = impl_->collider(world, name);
    ColliderState state{c.pose, c.twist, mass_of(world, c)};
    if (const RigidBody* body = body_of(world, c)) state.restitution = body->restitution;
    const auto number = static_cast<std::size_t>(&c - world.colliders.data());
    const Impl::Received& received = impl_->received;
    if (number < received.impulse.size() && received.seconds > 0)
      state.force = received.impulse[number] / -received.seconds;
    state.type = c.contact(), state.friction = c.friction, state.surface_tolerance = c.slack;
    state.is_rigid = c.rigid, state.moves = c.moves(), state.deforms = c.changing != nullptr;
    return state;
  });
}

ColliderShape Simulation::collider_shape(std::string_view name) const {
  return impl_->with_engine([&](auto& engine) {
    const auto& world = engine.world();
    const Collider& c = impl_->collider(world, name);
    ColliderShape shape;
    shape.data_ = std::make_shared<const ColliderShape::Data>(ColliderShape::Data{c, mass_of(world, c)});
    return shape;
  });
}

std::vector<ColliderShape> Simulation::collider_shapes() const {
  return impl_->with_engine([&](auto& engine) {
    const auto& world = engine.world();
    std::vector<ColliderShape> all(world.colliders.size());
    for (std::size_t c = 0; c < all.size(); ++c)
      all[c].data_ = std::make_shared<const ColliderShape::Data>(
          ColliderShape::Data{world.colliders[c], mass_of(world, world.colliders[c])});
    return all;
  });
}

TriMesh Simulation::collider_mesh(std::string_view name) const {
  const model::Scene& scene = impl_->state.scene.model();
  const auto c = std::find_if(scene.colliders.begin(), scene.colliders.end(),
                              [&](const model::Collider& one) { return one.name == name; });
  if (c == scene.colliders.end()) fail_unknown("collider", name, names_of(scene.colliders));
  return dreampm::collider_mesh(c->shape, 0.5 * scene.space.dx(), {scene.space.min, scene.space.end()}, {},
                                c->thickness);
}

std::optional<SpringAnchor> Simulation::anchor(std::string_view rigid) const {
  return impl_->with_engine([&](auto& engine) -> std::optional<SpringAnchor> {
    const std::optional<Hold>& hold = impl_->rigid_body(engine.world(), rigid).hold;
    if (!hold) return std::nullopt;
    return SpringAnchor{hold->at, hold->spring.to, hold->spring.stiffness, hold->spring.damping};
  });
}

std::optional<VelocityBrush> Simulation::brush(std::string_view name) const {
  return impl_->with_engine([&](auto& engine) -> std::optional<VelocityBrush> {
    const std::vector<ForceField>& fields = engine.world().fields;
    for (std::size_t f = scene().model().fields.size(); f < fields.size(); ++f)
      if (const Brush* b = std::get_if<Brush>(&fields[f].field); b && fields[f].name == name)
        return VelocityBrush{b->point, b->radius, b->velocity, b->rate};
    return std::nullopt;
  });
}

}  // namespace dreampm
