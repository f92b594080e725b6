#include "dreampm/simulation.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "dreampm/backend/carried_motion.h"
#include "dreampm/backend/registry.h"
#include "dreampm/base/error.h"
#include "dreampm/base/log.h"
#include "dreampm/base/order.h"
#include "dreampm/math/look_color.h"
#include "dreampm/pictures/draw.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pictures/wetted_solids.h"
#include "dreampm/scene/emit.h"
#include "dreampm/simulation/simulation_impl.h"
#include "dreampm/solver/choose_dt.h"
#include "dreampm/state/particle_view.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {

/// Hands what the engine reports to what is attached, then to the functions of a program.
template <class R>
struct Simulation::Impl::Relay final : Observer {
  Relay(Simulation::Impl& owner, Engine<R>& of) : simulation(owner), engine(of) {}
  double next_sample_time() const override { return simulation.step_observers.empty() ? never : always; }
  void on_step(const StepSums& sums) override {
    simulation.forget_views();
    ++simulation.state.frame_steps;
    Received& received = simulation.received;
    received.impulse.resize(sums.grid.colliders.size());
    for (std::size_t c = 0; c < received.impulse.size(); ++c) received.impulse[c] += sums.grid.colliders[c].impulse;
    received.seconds += sums.dt;
    for (const AttachedFiles& files : simulation.attached) files.observer->on_step(sums);
    if (simulation.step_observers.empty()) return;
    const StepReport report = simulation.report(sums);
    // An observer may add another one.
    for (std::size_t i = 0; i < simulation.step_observers.size(); ++i) simulation.step_observers[i](report);
  }
  void on_frame() override {
    const World<R>& world = engine.world();
    const FrameEvent event{world.frame, world.time, std::exchange(simulation.state.frame_steps, 0)};
    for (const AttachedFiles& files : simulation.attached) files.observer->on_frame();
    for (std::size_t i = 0; i < simulation.frame_observers.size(); ++i) simulation.frame_observers[i](event);
  }
  Simulation::Impl& simulation;
  Engine<R>& engine;
};

Simulation::Impl::Impl(const Scene& scene, const SimulationOptions& given)
    : options(given),
      state{scene, {}, {}, {}, 0, {}, 0, false, 0},
      host_(options.host),
      threads_(std::make_unique<ThreadArena>(options.threads)) {
  threads_->run([&] {
    const HostScope scope(host_);
    const model::Scene& description = scene.model();
    InitialState start = assemble(description, scene.file());
    for (const std::string& w : start.warnings) warn("{}", w);
    for (const std::string& n : start.notes) info("{}", n);
    const auto make = [&]<class R>(std::unique_ptr<Backend<R>> backend) {
      auto made = std::make_unique<SceneEngine<R>>(description, scene.file(), std::move(start), std::move(backend));
      Engine<R>& engine = made->engine();
      const ProbeSet<R>& probes = made->probes().set();
      for (std::size_t p = 0; p < probes.size(); ++p) state.probes.push_back({probes.columns(p), {}, {}});
      made->probes().add([this](std::size_t p, double time, const std::vector<double>& row) {
        state.probes[p].time.push_back(time), state.probes[p].rows.push_back(row);
        for (const AttachedFiles& files : attached) files.observer->on_probe_row(p, time, row);
      });
      relay_ = std::make_unique<Relay<R>>(*this, engine);
      engine.add(*relay_);
      made->begin();
      identity = scene::scene_hash(description, scene::Part::simulation);
      for (const model::Probe& p : description.probes)
        identity += fmt::format(" {}", scene::probe_hash(description, p));
      made->probes().sample(true);
      state.bodies = std::move(made->start().bodies);
      state.expected = std::move(made->start().expected);
      made->start() = {};
      scene_ = std::move(made);
    };
    std::visit(make, make_backend(options.backend, options.isa));
    state.next_id = first_free_id();
  });
}

std::uint32_t Simulation::Impl::first_free_id() const {
  return with_engine([](auto& engine) {
    engine.download(MatterFields::id);
    std::uint32_t next = 0;
    for (std::size_t s = 0; s < engine.world().sets.size(); ++s)
      for (const std::uint32_t id : ParticleSetView(engine.world(), s).ids()) next = std::max(next, id + 1);
    return next;
  });
}

std::size_t Simulation::Impl::material(std::string_view name) const {
  const std::vector<model::Material>& all = state.scene.model().materials;
  const auto at = std::find_if(all.begin(), all.end(), [&](const model::Material& m) { return m.name == name; });
  if (at == all.end()) fail_unknown("material", name, state.scene.materials());
  return static_cast<std::size_t>(at - all.begin());
}

void Simulation::Impl::settle() const {
  // A brush acts on the grid as it is, unless it makes matter too fast for the step to come.
  const double speed = std::exchange(state.brush_speed, 0.0);
  if (!state.edited && speed > 0)
    state.edited = with_engine([&](auto& engine) { return !step_suits(engine.world(), speed); });
  if (!state.edited) return;
  with_engine([&](auto& engine) { engine.form_grid(); });
  state.edited = false;
}

StepReport Simulation::Impl::report(const StepSums& sums) const {
  return with_engine([&](auto& engine) {
    StepReport r;
    r.step = engine.world().step;
    r.time = engine.world().time;
    r.dt = sums.dt;
    r.limiter = name_of(sums.limiter);
    r.viscous_stages = sums.stages;
    r.frame_done = sums.frame_done;
    r.max_speed = sums.grid.max_speed;
    r.j_min = sums.pass.j_min;
    r.j_max = sums.pass.j_max;
    return r;
  });
}

const ParticleFrame& Simulation::Impl::frame() const {
  if (!frame_)
    frame_ = with_engine([&](auto& engine) {
      const auto& description = state.scene.model();
      engine.download(MatterFields::id | MatterFields::position | MatterFields::motion);
      const model::Space& space = description.space;
      return particle_frame(engine.world(), engine.motion(), state.bodies, {"velocity", "source"},
                            file_shift(space.min, space.end(), space.spacing));
    });
  return *frame_;
}

template <class Done, class Capture>
StepSums Simulation::Impl::advance(const Done& done, const Capture& capture) {
  const TakesSteps now(*this);
  return with_engine([&](auto& engine) {
    return engine.advance([&] { return done(engine.world()); },
                          [&](const auto& world) {
                            settle();  // an observer may have edited
                            return capture(world);
                          });
  });
}

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(scene, options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

StepReport Simulation::step() {
  impl_->settle();
  impl_->received = {};
  const Impl::TakesSteps now(*impl_);
  return impl_->report(impl_->with_engine([](auto& engine) { return engine.step(always); }));
}

void Simulation::advance_to(double time) {
  if (!std::isfinite(time)) fail_input("advance_to: a time of {} s: must be a number", time);
  impl_->settle();
  impl_->received = {};
  impl_->advance([&](const auto& world) { return world.time + 1e-9 * world.dt_next >= time; },
                 [&](const auto& world) { return world.time + (1 + 1e-9) * world.dt_next >= time; });
}

void Simulation::advance_frames(int count) {
  if (count < 0) fail_input("advance_frames: {} frames: must be 0 or more", count);
  impl_->settle();
  impl_->received = {};
  const int last = frame() + count;
  impl_->advance([&](const auto& world) { return world.frame >= last; }, [](const auto&) { return false; });
}

StepReport Simulation::advance_steps(int count, ForceMean mean) {
  if (count < 1) fail_input("advance_steps: {} steps: must be 1 or more", count);
  impl_->settle();
  if (mean == ForceMean::of_this_call) impl_->received = {};
  const std::uint64_t last = steps() + static_cast<std::uint64_t>(count);
  return impl_->report(impl_->advance([&](const auto& world) { return world.step >= last; },
                                      [&](const auto& world) { return world.step + 1 == last; }));
}

double Simulation::time() const {
  return impl_->with_engine([](auto& engine) { return engine.world().time; });
}
int Simulation::frame() const {
  return impl_->with_engine([](auto& engine) { return engine.world().frame; });
}
std::uint64_t Simulation::steps() const {
  return impl_->with_engine([](auto& engine) { return engine.world().step; });
}
double Simulation::dt() const {
  impl_->settle();
  return impl_->with_engine([](auto& engine) { return engine.world().dt_next; });
}

void Simulation::on_step(StepObserver observer) { impl_->step_observers.push_back(std::move(observer)); }
void Simulation::on_frame(FrameObserver observer) { impl_->frame_observers.push_back(std::move(observer)); }

const Scene& Simulation::scene() const { return impl_->state.scene; }

std::size_t Simulation::particle_count() const {
  return impl_->with_engine([](auto& engine) { return engine.world().particles(); });
}
std::size_t Simulation::particle_count(std::string_view material) const {
  const std::size_t m = impl_->material(material);
  return impl_->with_engine([&](auto& engine) { return engine.world().sets[m].size(); });
}

std::shared_ptr<const Simulation::Impl::View> Simulation::Impl::view(std::size_t m) const {
  auto made = std::make_shared<View>();
  View& view = *made;
  with_engine([&](auto& engine) {
    engine.download(MatterFields::id | MatterFields::position | MatterFields::motion);
    const ParticleSetView particles(engine.world(), m);
    const auto& motion = engine.motion().sets[m];
    const std::size_t n = particles.size();
    std::vector<Vec3f> position(n);
    particles.for_each([&](std::size_t p, const Vec3d& x) { position[p] = static_cast<Vec3f>(x); });
    view.id.resize(n), view.position.resize(n), view.velocity.resize(n), view.J.resize(n);
    view.color.assign(n, linear_color(state.scene.model().render.looks.at(engine.world().sets[m].name)));
    std::size_t i = 0;
    for (const std::uint32_t p : order_of(particles.ids())) {
      view.id[i] = particles.id(p);
      view.position[i] = position[p];
      view.velocity[i] = static_cast<Vec3f>(motion.velocity[p]);
      view.J[i] = static_cast<float>(motion.volume_ratio[p]);
      ++i;
    }
    const auto paint = [&](std::uint32_t first_id, std::uint32_t count, const std::optional<Vec3d>& color) {
      if (!color) return;
      const auto first = std::lower_bound(view.id.begin(), view.id.end(), first_id),
                 end = std::lower_bound(first, view.id.end(), first_id + count);
      std::fill(view.color.begin() + (first - view.id.begin()), view.color.begin() + (end - view.id.begin()),
                linear_color(*color));
    };
    for (const BodyRange& body : state.bodies) paint(body.first_id, body.count, body.color);
    const auto& world = engine.world();
    for (const Arrival& a : world.arrivals) paint(a.first_id, a.count, world.emitters.at(a.emitter).color);
  });
  return made;
}

ParticleView Simulation::particles(std::string_view material) const {
  const std::size_t m = impl_->material(material);
  std::shared_ptr<const Impl::View>& kept = impl_->views[m];
  if (!kept) kept = impl_->view(m);
  return {kept->id, kept->position, kept->velocity, kept->J, kept->color, kept};
}

Totals Simulation::totals() const {
  return impl_->with_engine([&](auto& engine) {
    const Balance b = engine.balance();
    const EditSums& e = impl_->state.edits;
    Totals t;
    static_cast<ParticleCounts&>(t) = counts();
    t.mass = b.mass, t.momentum = b.momentum;
    t.kinetic = b.kinetic, t.elastic = b.elastic, t.volume = b.volume;
    t.entered_mass = e.entered_mass, t.removed_mass = e.removed_mass;
    t.entered_momentum = e.entered_momentum, t.removed_momentum = e.removed_momentum;
    return t;
  });
}

const ProbeSeries& Simulation::probe(std::string_view name) const {
  const std::vector<model::Probe>& probes = impl_->state.scene.model().probes;
  for (std::size_t p = 0; p < probes.size(); ++p)
    if (probes[p].name == name) return impl_->state.probes[p];
  fail_unknown("probe", name, names().probes);
}

std::uint64_t Simulation::hash() const {
  impl_->settle();
  return impl_->with_engine([](auto& engine) {
    engine.download(MatterFields::all);
    return state_hash(engine.world());
  });
}

Snapshot Simulation::snapshot() const {
  impl_->settle();
  Snapshot s;
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    engine.download(MatterFields::all);
    s.data_ = std::make_shared<const Snapshot::Data>(Snapshot::Data{
        impl_->state, impl_->identity, std::string(engine.backend().name()), engine.world(),
        carries_motion(engine.world()) ? Motion<R>{} : engine.motion(), impl_->probe_set<R>().memories()});
  });
  return s;
}

void Simulation::restore(const Snapshot& snapshot) {
  if (snapshot.empty() || snapshot.data_->identity != impl_->identity)
    fail_input("the snapshot is of another scene: restore it to a simulation of the same");
  impl_->with_engine([&]<class R>(Engine<R>& engine) {
    const std::string_view backend = engine.backend().name();
    if (!std::holds_alternative<World<R>>(snapshot.data_->world))
      fail_input(
          "the snapshot is of the backend {}, which does not compute in the precision of {}, the backend of this "
          "simulation",
          snapshot.data_->backend, backend);
    World<R> world = std::get<World<R>>(snapshot.data_->world);
    if (snapshot.data_->backend != backend) world.scatter_bounds = {};  // nobody kept them
    if (carries_motion(world)) {
      Motion<R> carried;
      take_carried_motion(world, carried);
      engine.replace(std::move(world), &carried);
    } else {
      engine.replace(std::move(world), &std::get<Motion<R>>(snapshot.data_->motion));
    }
    impl_->probe_set<R>().resume(snapshot.data_->probes, engine.world().time);
  });
  impl_->state = snapshot.data_->state;
  impl_->received = {};
  impl_->forget_views();
  impl_->reopen_attached();
}

double Snapshot::time() const {
  return empty() ? 0 : std::visit([](const auto& world) { return world.time; }, data_->world);
}

std::uint64_t Snapshot::bytes() const {
  if (empty()) return 0;
  return std::visit(
      []<class R>(const World<R>& world) {
        std::uint64_t numbers = 0;
        for (std::size_t s = 0; s < world.sets.size(); ++s) {
          const ParticleSetView particles(world, s);
          // Velocity and gradient are on the particles, or beside them with energy and J; ids.
          numbers += particles.size() * (particles.columns() + 3 + (world.sets[s].carries_motion ? 12 : 14) + 1);
        }
        numbers += world.cell_pressure.size();
        visit_nodes(world.grid, [&](const auto&, const auto& nodes) { numbers += 4 * nodes.size(); });
        return numbers * sizeof(R);
      },
      data_->world);
}

TriMesh Simulation::surface(std::string_view material, const SurfaceOptions& options) const {
  const std::size_t m = impl_->material(material);
  const ParticleFrame& frame = impl_->frame();
  const model::Scene& description = scene().model();
  const MaterialParticles particles = particles_of(description, static_cast<int>(m), frame);
  SurfaceSettings settings = surface_settings(description);
  settings.keep_field = false;
  settings.voxel = static_cast<float>(options.voxel * description.space.dx());
  settings.smooth = options.smooth;
  settings.overlap = static_cast<float>(options.overlap);
  TriMesh mesh = impl_->with_engine([&](const auto& engine) {
    auto solids = wetted_solids(engine.world().colliders);
    return reconstruct(surface_input(description, particles, frame.shift, std::move(solids)), settings).mesh;
  });
  for (Vec3f& v : mesh.vertices) v += static_cast<Vec3f>(frame.shift);
  return mesh;
}

}  // namespace dreampm
