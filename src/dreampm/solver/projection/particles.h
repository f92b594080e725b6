// Particles and the staggered grid: what particles give to it, and what they take from it and where
// they go.
#pragma once
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/solver/projection/cut_cells.h"
#include "dreampm/solver/projection/kernels.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Adds momentum and weight of all particles to the faces, and the volume they take at rest to the
/// density of cells. The same bits for any number of threads.
template <class R>
void particles_to_grid(const World<R>& world, const ProjectionKernels<R>& kernels, MacGrid<R>& grid);

/// Statistics of the particles' motion in a step.
struct MoveStats {
  double fastest = 0;  ///< m/s
  double usual = 0;    ///< m/s, that all but 0.1 % keep
  double kinetic = 0;  ///< J, with the affine part
  bool finite = true;
  bool far = false;  ///< true if any went more than a block
};

/// m/s, of all particles as they are.
template <class R>
FlowSpeeds flow_speeds(const World<R>& world);

/// Gives particles the velocity of the grid and its slope, and moves them by `dt` [s] through the
/// velocities `moving`, by Ralston's third-order Runge-Kutta method whose first slope is the
/// particle's own velocity (Ralston 1962). A particle that no known velocity is around keeps its
/// own and falls by `kick` [m/s]. Colliders put particles out. `scratch`: memory to work in.
template <class R>
MoveStats grid_to_particles(World<R>& world, const ProjectionKernels<R>& kernels, const MacGrid<R>& grid,
                            const CutCells<R>& cut, double dt, const Vec3d& kick, std::vector<float>& scratch);

}  // namespace dreampm
