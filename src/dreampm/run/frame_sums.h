// Sums over the steps of a frame.
#pragma once
#include <cstdint>
#include <optional>

#include "dreampm/run/engine.h"
#include "dreampm/solver/step.h"

namespace dreampm {

/// Sums of a frame's ledger row over its steps; part of a checkpoint that falls within a frame.
struct FrameSums {
  std::uint64_t substeps = 0;
  double dt_min = 1e30, dt_max = 0;
  Limiter limiter = Limiter::frame;
  int stages = 0;        ///< largest number of viscous stages of a step
  ImpulseSum contact;    ///< impulses from walls and colliders on matter
  ImpulseSum body;       ///< impulses from gravity, damping and fields
  ImpulseSum left;       ///< momentum of matter that left
  Entered entered;       ///< matter from emitters
  double left_mass = 0;  ///< kg
  PassEnergy lost;       ///< energies that particles turned into heat; kinetic and kept_kinetic unused
  double transfer = 0;   ///< J, of StepSums
  double damping = 0;    ///< J that damping took
  double rounding = 0;   ///< N s, of StepSums
  double jumps = 0;      ///< N m s by which pushing particles back inside may have changed the angular momentum
  double grid_mass = 0;  ///< kg on the nodes, at the last step
  std::optional<double> swollen;    ///< m^3, of StepSums, at the last step that had it
  std::optional<double> projected;  ///< J, of StepSums
  /// `heaviest`: mass of the heaviest particle [kg].
  void add(const StepSums& step, double heaviest);
};

/// Adds up the steps of the frame at hand. Observers that read the sums are added after it.
template <class R>
class FrameTotals final : public Observer {
 public:
  explicit FrameTotals(const Engine<R>& engine) : engine_(engine) {}
  /// Returns the sums of the present frame; at its end, until the next step, of the frame that
  /// ended.
  const FrameSums& sums() const { return sums_; }
  /// Returns the sums to which a run that goes on from here adds: empty ones at the end of a frame.
  FrameSums carried() const { return ended_ ? FrameSums{} : sums_; }
  /// Particles times steps, in all.
  std::uint64_t particle_steps() const { return particle_steps_; }
  void go_on(const FrameSums& carried, std::uint64_t particle_steps) {
    sums_ = carried, particle_steps_ = particle_steps, ended_ = false;
  }

  void on_step(const StepSums& step) override;

 private:
  const Engine<R>& engine_;
  FrameSums sums_;
  std::uint64_t particle_steps_ = 0;
  bool ended_ = false;
};

}  // namespace dreampm
