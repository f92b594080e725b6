// The parts of a Simulation. For the files of this module alone.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/host.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/ply.h"
#include "dreampm/run/scene_engine.h"
#include "dreampm/setup/assemble.h"
#include "dreampm/simulation.h"

namespace dreampm {

/// The totals of matter that edits brought in and took out.
struct EditSums {
  std::uint64_t entered = 0, removed = 0;     ///< particles
  double entered_mass = 0, removed_mass = 0;  ///< kg
  Vec3d entered_momentum{}, removed_momentum{};
};

/// The state of a Simulation beside its world.
struct SimulationState {
  Scene scene;  ///< with all edits so far
  std::vector<BodyRange> bodies;
  std::vector<model::Body> added;  ///< bodies that the scene has not
  ExpectedSpeed expected;
  std::uint32_t next_id = 0;
  EditSums edits;
  std::uint64_t frame_steps = 0;         ///< in the frame at hand
  bool edited = false;                   ///< since the grid was formed
  double brush_speed = 0;                ///< m/s, of the fastest brush since the step to come was chosen; 0: of none
  std::vector<ProbeSeries> probes = {};  ///< in the order of the scene
};

struct Snapshot::Data {
  SimulationState state;
  std::string identity;  ///< of the simulation's scene
  std::string backend;
  std::variant<World<float>, World<double>> world;
  std::variant<Motion<float>, Motion<double>> motion;
  ProbeMemories probes;
};

/// Says which names there are instead.
[[noreturn]] void fail_unknown(std::string_view kind, std::string_view name, const std::vector<std::string>& names);

/// Writes files of a simulation.
class AttachedObserver : public Observer {
 public:
  /// A row of a probe of the scene, by its number.
  virtual void on_probe_row(std::size_t, double /*time*/, const std::vector<double>& /*row*/) {}
};

struct Simulation::Impl {
  Impl(const Scene& scene, const SimulationOptions& given);

  /// Calls f(engine) with the engine of the precision at hand, on this simulation's threads, its
  /// host the current one.
  template <class F>
  auto with_engine(const F& f) const {
    using Result = std::invoke_result_t<F, Engine<float>&>;
    const auto run = [&](const auto& body) {
      threads_->run([&] {
        const HostScope scope(host_);
        std::visit([&](const auto& scene) { body(scene->engine()); }, scene_);
      });
    };
    if constexpr (std::is_void_v<Result>) {
      run(f);
    } else {
      Result result{};
      run([&](auto& engine) { result = f(engine); });
      return result;
    }
  }

  /// The scene as it is with a change of its model. Throws InputError for what `check` refuses, and
  /// for what its solver cannot do.
  template <class Change>
  Scene edited(const Change& change) const {
    model::Scene next = state.scene.model();
    change(next);
    return checked(std::move(next));
  }
  Scene checked(model::Scene next) const;
  /// Above those of all particles.
  std::uint32_t first_free_id() const;
  /// The number of a material of the scene. Throws InputError.
  std::size_t material(std::string_view name) const;
  /// Throws InputError for a name that the world has not.
  template <class World>
  static auto& collider(World& world, std::string_view name) {
    for (auto& c : world.colliders)
      if (c.name == name) return c;
    std::vector<std::string> names;
    for (const Collider& c : world.colliders) names.push_back(c.name);
    fail_unknown("collider", name, names);
  }
  template <class World>
  static auto& rigid_body(World& world, std::string_view name) {
    for (auto& body : world.rigid)
      if (world.colliders[body.collider].name == name) return body;
    std::vector<std::string> names;
    for (const RigidBody& body : world.rigid) names.push_back(world.colliders[body.collider].name);
    fail_unknown("rigid body", name, names);
  }
  /// Brings in particles of material m, whose ids count from 0, and counts them; the id of the
  /// first. `what` names them in messages.
  std::uint32_t insert(std::size_t m, std::vector<ParticleSeed> seeds, const std::string& what);
  /// Forms the grid anew if there were edits since.
  void settle() const;
  /// Steps until done(engine), with velocities of the step for which capture(world) holds; the sums
  /// of the last step.
  template <class Done, class Capture>
  StepSums advance(const Done& done, const Capture& capture);
  StepReport report(const StepSums& sums) const;
  /// All particles, in the order of their ids, with velocities.
  const ParticleFrame& frame() const;

  /// N s: what colliders gave to matter since the last call that advances began, and in
  /// what time [s].
  struct Received {
    std::vector<Vec3d> impulse;
    double seconds = 0;
  };
  Received received;

  /// Hands on what the engine reports.
  template <class R>
  struct Relay;
  template <class R>
  ProbeSet<R>& probe_set() const {
    return std::get<std::unique_ptr<SceneEngine<R>>>(scene_)->probes().set();
  }

  /// Implements Simulation::save.
  void save(const std::filesystem::path& file) const;
  void save_moment(const std::filesystem::path& file) const;

  /// Makes an observer at the moment at hand; `goes_on`: its files are there, up to a later moment.
  using OpenObserver = std::function<std::unique_ptr<AttachedObserver>(Impl&, bool goes_on)>;
  struct AttachedFiles {
    OpenObserver open;
    std::unique_ptr<AttachedObserver> observer;
  };
  std::vector<AttachedFiles> attached;
  void attach(OpenObserver open);
  /// Must be called after the world was replaced by that of another moment.
  void reopen_attached();
  /// Goes on with the files of another simulation.
  void take_attached(const Impl& from);

  SimulationOptions options;
  mutable SimulationState state;
  std::string identity;
  std::vector<StepObserver> step_observers;
  std::vector<FrameObserver> frame_observers;
  int under_way = 0;  ///< calls that take steps
  struct TakesSteps {
    explicit TakesSteps(Impl& of) : impl(of) { ++impl.under_way; }
    ~TakesSteps() { --impl.under_way; }
    Impl& impl;
  };

  /// The particles of a material.
  struct View {
    std::vector<std::uint32_t> id;
    std::vector<Vec3f> position, velocity, color;
    std::vector<float> J;
  };
  /// The particles of material m as they are now.
  std::shared_ptr<const View> view(std::size_t m) const;
  /// The last views asked for, by material; empty after a step or an edit.
  mutable std::map<std::size_t, std::shared_ptr<const View>> views;
  mutable std::optional<ParticleFrame> frame_;

  void forget_views() { views.clear(), frame_.reset(); }

 private:
  Host* host_;
  std::unique_ptr<ThreadArena> threads_;
  std::variant<std::unique_ptr<SceneEngine<float>>, std::unique_ptr<SceneEngine<double>>> scene_;
  std::unique_ptr<Observer> relay_;
};

/// The way of this module's files, and of tests, to what a Simulation is made of.
struct SimulationAccess {
  static Simulation::Impl& impl(Simulation& simulation) { return *simulation.impl_; }
  static const Simulation::Impl& impl(const Simulation& simulation) { return *simulation.impl_; }
};

}  // namespace dreampm
