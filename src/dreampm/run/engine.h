// The one loop over steps: a world, the backend that steps it, and who watches.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/rigid/bullet_contacts.h"
#include "dreampm/solver/emit.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/solver/solver.h"

namespace dreampm {

/// Sample times [s] that stand for every step, and for the ends of frames alone.
inline constexpr double always = -std::numeric_limits<double>::infinity(),
                        never = std::numeric_limits<double>::infinity();

/// Watches an engine. What a method throws leaves the engine's call after the step is whole.
class Observer {
 public:
  virtual ~Observer() = default;
  /// s: velocities are wanted of steps that end then or later.
  virtual double next_sample_time() const { return never; }
  /// Called after every step.
  virtual void on_step(const StepSums&) {}
  /// Called after on_step of all, where the step ended a frame.
  virtual void on_frame() {}
};

/// Steps a world. R = float: as the cpu backend computes, double: as the reference.
template <class R>
class Engine {
 public:
  Engine(World<R> world, std::unique_ptr<Backend<R>> backend)
      : world_(std::move(world)),
        backend_(std::move(backend)),
        solver_(make_solver(world_, *backend_)),
        contacts_(make_body_contacts(world_)) {}

  World<R>& world() { return world_; }
  const World<R>& world() const { return world_; }
  Backend<R>& backend() { return *backend_; }
  const Backend<R>& backend() const { return *backend_; }

  /// Velocities of the particles, in their order: of the last step that a sample time fell into or
  /// that ended a frame.
  const Motion<R>& motion() const { return motion_; }
  /// Returns the motion for edits, which change it with the particles.
  Motion<R>& motion() { return motion_; }
  /// True if `motion` is of the last step.
  bool motion_is_current() const { return current_; }

  /// Makes what `fields` name current in the arrays of `world` and in `motion`: before they are
  /// read, and before an edit changes them.
  void download(MatterFields fields) { backend_->download(world_, motion_, fields); }
  /// Must be called after an edit that changed what `fields` name there.
  void upload(MatterFields fields) { backend_->upload(world_, motion_, fields); }
  /// Sums over the particles, with the motion at hand.
  Balance balance() { return backend_->balance(world_, motion_); }

  /// Brings the first matter into an empty world.
  void begin(const std::vector<std::vector<ParticleSeed>>& seeds) {
    solver_->begin(world_, seeds);
    download(MatterFields::id);
    motion_ = initial_velocities(world_, seeds);
    upload(MatterFields::motion);
    current_ = true;
  }
  /// Goes on with another world, of a checkpoint or a snapshot, and its motion, if that is known.
  void replace(World<R> world, const Motion<R>* motion) {
    world_ = std::move(world);
    contacts_ = make_body_contacts(world_);
    solver_ = make_solver(world_, *backend_);
    solver_->attach(world_, motion);
    current_ = motion != nullptr;
    if (!motion) return;
    motion_ = *motion;
    upload(MatterFields::motion);
  }
  /// Must be called after an edit that brought colliders into the world or took some out;
  /// `form_grid` comes before the next step.
  void colliders_changed() { contacts_ = make_body_contacts(world_, contacts_.get()); }
  /// Forms the grid anew after an edit of the world, and of `motion` with it. Where it throws,
  /// another edit may still put things right.
  void form_grid() { solver_->form_grid(world_, motion_); }

  /// `observer` must outlive the engine's calls. Called in the order in which they were added.
  void add(Observer& observer) { observers_.push_back(&observer); }

  /// One step, and its observers. Velocities are wanted of it if it ends a frame, or at
  /// `sample_time` [s] or later.
  StepSums step(double sample_time = never) {
    for (const Observer* o : observers_) sample_time = std::min(sample_time, o->next_sample_time());
    current_ = false;
    const Entered entered = world_.emitters.empty() ? Entered{} : emit(world_, *backend_, *solver_, motion_);
    StepSums sums = solver_->step(world_, motion_, sample_time, contacts_.get());
    sums.entered = entered;
    current_ = sums.frame_done || world_.time >= sample_time;
    for (Observer* o : observers_) o->on_step(sums);
    if (sums.frame_done)
      for (Observer* o : observers_) o->on_frame();
    return sums;
  }
  /// Steps until done(); the sums of the last step. `capture(world)`: whether velocities are wanted
  /// of the step to come. Throws Interrupted, before a step, when the host wants to stop.
  template <class Done, class Capture>
  StepSums advance(const Done& done, const Capture& capture) {
    StepSums last;
    while (!done()) {
      if (interrupted())
        throw Interrupted(fmt::format("interrupted at t = {:.6g} s, step {}", world_.time, world_.step));
      last = step(capture(std::as_const(world_)) ? always : never);
    }
    return last;
  }

 private:
  World<R> world_;
  std::unique_ptr<Backend<R>> backend_;
  std::unique_ptr<Solver<R>> solver_;
  std::unique_ptr<BodyContacts> contacts_;  ///< null without rigid bodies
  Motion<R> motion_;
  bool current_ = false;
  std::vector<Observer*> observers_;
};

}  // namespace dreampm
