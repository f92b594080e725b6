// Large steps of liquids: particles carry velocity and its gradient, and a pressure on a staggered
// grid keeps their volume (docs/theory/projection.md).
#pragma once
#include "dreampm/solver/projection/body_pressure.h"
#include "dreampm/solver/projection/cut_cells.h"
#include "dreampm/solver/projection/grains.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/multigrid.h"
#include "dreampm/solver/projection/particles.h"
#include "dreampm/solver/projection/pressure.h"
#include "dreampm/solver/projection/solids.h"
#include "dreampm/solver/projection/step_sums.h"
#include "dreampm/solver/projection/viscosity.h"
#include "dreampm/solver/solver.h"
#include "dreampm/state/regroup.h"

namespace dreampm {

/// Velocities belong to the middle of a step, as in leapfrog: gravity acts over the time from the
/// middle of the step before to that of this one, so that a fall is exact.
template <class R>
class Projection final : public Solver<R> {
 public:
  /// `backend`: for the explicit steps of matter beside the liquid, where there is any; must
  /// outlive this. Kernels are of its instruction set.
  explicit Projection(Backend<R>* backend = nullptr)
      : kernels_(projection_kernels<R>(backend ? backend->isa() : "auto")),
        solids_(backend),
        solver_(kernels_.multigrid) {}
  void attach(const World<R>& world, const Motion<R>* motion) override {
    if (motion) solids_.remember(world, *motion);
  }
  void begin(World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) override;
  PassStats insert(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) override;
  StepSums step(World<R>& world, Motion<R>& motion, double next_sample_time, BodyContacts* contacts) override;
  void form_grid(World<R>& world, Motion<R>& motion) override;

  /// Iterations of the last step's solves, for tests and reports.
  int pressure_iterations() const { return pressure_iterations_; }
  int density_iterations() const { return density_iterations_; }
  int viscosity_iterations() const { return viscosity_iterations_; }

 private:
  /// The state that all phases of a step share.
  struct Step {
    double dt, kick;  ///< s: of places, and of velocities
    Vec3d gained;     ///< m/s, by gravity
    double density;   ///< kg/m^3, of the liquid
    double scale;     ///< Pa for each m/s that the pressure takes from a face
    double kinetic;   ///< J, of the liquid when it begins
    bool solids;      ///< true if other matter lies beside the liquid
    BodyContacts* contacts;
  };
  struct Moved {
    MoveStats liquid;
    typename SolidSteps<R>::Kinetic solids;
  };
  // The phases, in their order.
  /// Colliders, bodies and the grid.
  Step start(World<R>& world, BodyContacts* contacts);
  /// Particles to grid, and all forces but the pressure. Returns what fields gave.
  ImpulseSum gather(World<R>& world, const Step& s);
  /// Viscosity and pressure, on faces, bodies and solids. Returns the J that viscosity takes.
  double press(World<R>& world, const Step& s);
  /// Bodies, particles and solids to where they go.
  Moved advance(World<R>& world, const Step& s, StepSums& sums);
  /// The ledger.
  void count(World<R>& world, const Step& s, const FaceSums& faces, const Moved& moved, StepSums& sums);

  void set_up_matrix();
  /// J that it makes of motion.
  double slow_by_viscosity(World<R>& world, double kick);
  /// Takes the pressure of the step before, where there is liquid still, as the first guess of the
  /// solve. `scale`: Pa for each m/s.
  void take_last_pressure(const World<R>& world, double scale);
  void solve_pressure(const World<R>& world, const Leaving& leaving);
  void solve_density(double dx, double dt);
  void move_bodies(World<R>& world, double dt, BodyContacts* contacts);
  void keep_pressure(World<R>& world, double scale, bool far);

  const ProjectionKernels<R>& kernels_;
  MacGrid<R> grid_;
  CutCells<R> cut_;
  BodyPressure<R> bodies_;
  SolidSteps<R> solids_;
  Grains<R> grains_;
  LargeVector<R> lasting_;  ///< of cells: what two steps have of the pressure, where there are solids
  Pushes<R> pushes_;
  Viscosity<R> viscosity_;
  PressureSolver<R> solver_;
  Regroup<R> regroup_;
  GridFields<R> spare_;
  std::vector<Collider> at_start_;  ///< of the step
  std::vector<float> speeds_;
  int pressure_iterations_ = 0, density_iterations_ = 0, viscosity_iterations_ = 0;
};

}  // namespace dreampm
