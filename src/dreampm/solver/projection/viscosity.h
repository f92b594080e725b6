// Viscosity of a step of the projection: backward Euler, by the whole stress, so that a liquid may
// be as viscous as it wants and turns freely (Batty and Bridson 2008).
#pragma once
#include <array>

#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {

/// What a solve took.
struct ViscousSolve {
  int iterations = 0;
  double residual = 0;  ///< over the first one
  double heat = 0;      ///< J/(kg/m^3 dx^3): over the mass of a cell, what it makes of motion
};

/// The velocities u of faces minimise
///   1/2 sum_f m_f (u_f - u*_f)^2 + s sum_c M_c sum_a (d_a u_a)^2
///     + s/2 sum_e M_e (d_a u_b + d_b u_a)^2,   s = nu kick/dx^2,
/// over faces f, cells c and edges e, with the liquid that they hold, m and M, and differences d of
/// neighbors. Free surfaces need no case: where there is no liquid there is no term.
template <class R>
class Viscosity {
 public:
  /// `diffusion`: s. Changes `grid.free` of faces that particles reach.
  ViscousSolve solve(MacGrid<R>& grid, double diffusion);

 private:
  using Faces = std::array<LargeVector<R>, 3>;
  void weigh(const MacGrid<R>& grid, double diffusion);
  /// f = -gradient of the two sums of stresses at u.
  void force(const MacGrid<R>& grid, const Faces& u, Faces& f);

  Faces mass_;     ///< m; 0 of faces whose velocity is given
  Faces inverse_;  ///< of the diagonal; 0 there
  Faces velocity_, residual_, direction_, product_;
  LargeVector<R> normal_;  ///< 2 s M of cells
  Faces shear_;            ///< s M of edges: [a] of those along axis a, on the low sides of a cell
  Faces pull_, twist_;     ///< stresses: d_a u_a of cells, and of edges
  std::vector<double> parts_;
};

}  // namespace dreampm
