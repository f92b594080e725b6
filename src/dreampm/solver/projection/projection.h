// Large steps of liquids: particles carry velocity and its gradient, and a pressure on a staggered
// grid keeps their volume (docs/theory/projection.md).
#pragma once
#include "dreampm/solver/projection/body_pressure.h"
#include "dreampm/solver/projection/cut_cells.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/multigrid.h"
#include "dreampm/solver/projection/particles.h"
#include "dreampm/solver/projection/solids.h"
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
  void attach(const World<R>&) override {}
  void begin(World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) override;
  PassStats insert(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) override;
  StepSums step(World<R>& world, Motion<R>& motion, double next_sample_time, BodyContacts* contacts) override;
  void form_grid(World<R>& world, Motion<R>& motion) override;

  /// Iterations of the last step's solves, for tests and reports.
  int pressure_iterations() const { return pressure_iterations_; }
  int density_iterations() const { return density_iterations_; }
  int viscosity_iterations() const { return viscosity_iterations_; }

 private:
  void set_up_matrix();
  /// J that it makes of motion.
  double slow_by_viscosity(World<R>& world, double kick);
  /// That of the step before, where there is liquid still, from which the solve begins. `scale`: Pa
  /// for each m/s.
  void take_last_pressure(const World<R>& world, double scale);
  void solve_pressure(const World<R>& world);
  void solve_density(double dx, double dt);
  /// `at_start`: the colliders as they stood when the step began.
  void move_bodies(World<R>& world, std::vector<Collider>& at_start, double dt, BodyContacts* contacts);
  void keep_pressure(World<R>& world, double scale, bool far);

  const ProjectionKernels<R>& kernels_;
  MacGrid<R> grid_;
  CutCells<R> cut_;
  BodyPressure<R> bodies_;
  SolidSteps<R> solids_;
  Viscosity<R> viscosity_;
  PressureSolver<R> solver_;
  Regroup<R> regroup_;
  GridFields<R> spare_;
  std::vector<float> speeds_;
  int pressure_iterations_ = 0, density_iterations_ = 0, viscosity_iterations_ = 0;
};

}  // namespace dreampm
