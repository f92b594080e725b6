// A Simulation that Python holds.
#pragma once
#include <thread>
#include <utility>
#include <vector>

#include "convert.h"
#include "python_host.h"

namespace dreampm::python {

/// A simulation with its host and the observers that Python gave. Stays where it is: the library
/// points to its host.
class HeldSimulation {
 public:
  HeldSimulation(const Scene& scene, std::string backend, std::string isa, int threads)
      : simulation_(
            host_.run([&] { return Simulation(scene, {std::move(backend), std::move(isa), threads, &host_}); })) {}
  HeldSimulation(const HeldSimulation&) = delete;
  HeldSimulation& operator=(const HeldSimulation&) = delete;

  /// f(simulation) without the GIL. Throws RunError where another thread is in such a call:
  /// observers run in the thread that steps, and may call all but `advance`.
  template <class F>
  auto call(const F& f) {
    const Use use(*this);
    return host_.run([&] { return f(simulation_); });
  }
  /// The same for what takes steps.
  template <class F>
  auto advance(const F& f) {
    const Use use(*this);  // first: another thread is no observer
    if (steps_) throw RunError("a simulation cannot be stepped by its own observers");
    const Steps steps(*this);
    return host_.run([&] { return f(simulation_); });
  }
  /// The same with the GIL, for what takes no time.
  template <class F>
  auto look(const F& f) {
    const Use use(*this);
    return f(std::as_const(simulation_));
  }

  void on_step(nb::callable observer);
  void on_frame(nb::callable observer);

  /// Visits the objects that a type holds, for the garbage collector.
  int traverse(visitproc visit, void* arg) const;
  void clear();

 private:
  /// All of this happens with the GIL, so that no two threads are here at once.
  struct Use {
    explicit Use(HeldSimulation& of) : held(of), outer(of.user_) {
      if (outer != std::thread::id() && outer != std::this_thread::get_id())
        throw RunError("another thread is using the simulation: one thread at a time may");
      held.user_ = std::this_thread::get_id();
    }
    ~Use() { held.user_ = outer; }
    HeldSimulation& held;
    std::thread::id outer;
  };
  struct Steps {
    explicit Steps(HeldSimulation& of) : held(of) { held.steps_ = true; }
    ~Steps() { held.steps_ = false; }
    HeldSimulation& held;
  };

  PythonHost host_;
  std::vector<nb::object> step_observers_, frame_observers_;
  std::thread::id user_{};
  bool steps_ = false;
  Simulation simulation_;
};

/// A named part of a simulation, which it keeps alive.
struct PartOf {
  nb::object simulation;
  HeldSimulation& held() const { return nb::cast<HeldSimulation&>(simulation); }
};

/// The slots by which the garbage collector finds circles through a simulation or a part of it.
extern const PyType_Slot simulation_slots[], part_slots[];

void bind_collider_edits(nb::class_<HeldSimulation>& simulation);  ///< of Simulation
void bind_reads_of(nb::class_<HeldSimulation>& simulation);        ///< the same

}  // namespace dreampm::python
