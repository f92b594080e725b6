// The accounting of a step: its changes of mass, momentum and energy, added up beside the step and
// never read by it.
#pragma once
#include <cstdint>
#include <optional>

#include "dreampm/backend/backend.h"
#include "dreampm/solver/emit.h"

namespace dreampm {

/// The sums of one step, of which the rows of the ledger are made.
struct StepSums {
  double dt = 0;  ///< s, taken
  Limiter limiter = Limiter::user;
  int stages = 0;  ///< of viscosity; 0: explicit
  GridStats grid;
  PassStats pass;
  ImpulseSum body;       ///< what matter received from gravity, damping and fields; work: of fields, and of a
                         ///< gravity that changes on what is potential energy
  ImpulseSum left;       ///< what left through open walls took along, without its energy
  double left_mass = 0;  ///< kg
  Entered entered;       ///< what emitters gave before the step
  double transfer = 0;   ///< J of kinetic energy that the grid did not give to the particles; of sets that keep
                         ///< velocities also what the particles did not give to the grid. 0 where some left
  /// m^3: volume that liquids take beyond that at rest; only of steps that relax the volume of
  /// liquids, and of a projection, where it may be below 0.
  std::optional<double> swollen;
  std::optional<double> projected;  ///< J of kinetic energy that a projection's pressure took
  double rounding = 0;              ///< N s that rounding may have lost or gained, apart from that of stresses
  bool frame_done = false;          ///< world.frame was increased: time is the new frame's
};

/// Units in the last place of all that moves by which the sums of a step may be off: gather, move,
/// law, scatter and grid each round, but to both sides.
inline constexpr double roundings = 1;

/// Makes the sums of one step: it is handed the result of each phase right after it, in their
/// order.
template <class R>
class StepAccounting {
 public:
  /// Begins the accounting of the step of world.dt_next. `frame_done`: true if it ends the frame.
  /// World and backend have to outlive this object.
  StepAccounting(const World<R>& world, Backend<R>& backend, bool frame_done);

  /// Takes the result of grid_update: forces on all matter alike, and a bound of the rounding of
  /// the sums.
  void grid_updated(const GridStats& grid);
  /// Takes the heat of the stages of viscosity [J].
  void sub_cycled(double heat);
  /// Must be called before a sort: notes the momentum on the grid where matter may leave.
  void before_sort();
  /// Takes the result of g2p2g, while the world's clock and `kept_kinetic_energy` are still those
  /// before the step, and returns the sums of the whole step. `grid`: as grid_update and the stages
  /// left it.
  StepSums transferred(GridStats grid, const PassStats& pass);

 private:
  struct BeforeSort {
    ImpulseSum on_grid;     ///< momentum of the nodes
    std::uint64_t left;     ///< World::left
    std::uint64_t taken;    ///< particles that sinks took so far
    ImpulseSum took_along;  ///< momentum of these, in `impulse` and `angular`
  };
  void add_what_left();

  const World<R>& world_;
  Backend<R>& backend_;
  double mass_;      ///< kg, before the step
  double heat_ = 0;  ///< J, of the stages of viscosity
  std::optional<BeforeSort> before_sort_;
  StepSums sums_;
};

}  // namespace dreampm
