// Viscosity of a step of the projection: backward Euler, by the whole stress, so that a liquid may
// be as viscous as it wants and turns freely (Batty and Bridson 2008).
#pragma once
#include <array>

#include "dreampm/solver/projection/surface_stress.h"
#include "dreampm/solver/projection/viscous_bodies.h"

namespace dreampm {

/// The iterations and the residual of a solve.
struct ViscousSolve {
  int iterations = 0;
  double residual = 0;  ///< over the first one
  double heat = 0;      ///< J/(kg/m^3 dx^3): over the mass of a cell, what it makes of motion
};

/// The velocities u of faces minimise
///   1/2 sum_f m_f (u_f - u*_f)^2 + s sum_c M_c sum_a (d_a u_a)^2
///     + s/2 sum_e M_e (d_a u_b + d_b u_a)^2,   s = nu kick/dx^2,
/// over faces f, cells c and edges e, with the liquid that they hold, m and M, and differences d of
/// neighbors. Free surfaces need no case: where there is no liquid there is no term. Faces of a
/// rigid body that holds the liquid move as one, with the body's mass; where liquid slips along
/// colliders, see SurfaceStress.
template <class R>
class Viscosity {
 public:
  /// `bodies`: the cells beside them are found. `diffusion`: s; `density` in kg/m^3. Changes
  /// `grid.free` of faces that particles reach, and the twists of rigid bodies.
  ViscousSolve solve(World<R>& world, MacGrid<R>& grid, const CutCells<R>& cut, const BodyPressure<R>& bodies,
                     double diffusion, double density);

  /// Leaves viscosity out of this step.
  void leave_out() { acts_ = false; }
  /// True if the last step had viscosity. The results, over the mass of a cell of liquid [m/s]:
  bool acts() const { return acts_; }
  /// what the liquid gives to a face whose velocity is given; 0 of others,
  R given_to(std::size_t axis, std::size_t face) const {
    return mass_[axis][face] > R(0) ? R(0) : product_[axis][face];
  }
  /// the shear of an edge, that of both its components,
  R shear(std::size_t axis, std::size_t edge) const { return twist_[axis][edge]; }
  /// and the stress across the surfaces in a cell along which it slips, as a tension.
  R pull(std::size_t cell) const { return acts_ && surfaces_.any() ? surfaces_.pull()[cell] : R(0); }

 private:
  using Faces = std::array<LargeVector<R>, 3>;
  void weigh(const World<R>& world, MacGrid<R>& grid, double diffusion);
  /// Returns the resistance of a face by viscous stresses alone.
  R stiffness(const MacGrid<R>& grid, std::size_t axis, const RowPlaces& at, std::size_t lane) const;
  /// f = -gradient of the sums of stresses at u and, of bodies, at what they are faster;
  /// `moving` as in SurfaceStress. `on_bodies`: what they get.
  void force(const MacGrid<R>& grid, const Faces& u, const std::vector<Six>& bodies, bool moving, Faces& f,
             std::vector<Six>& on_bodies);

  LargeVector<R> liquid_;  ///< of cells: the part that liquid fills
  Faces mass_;             ///< m; 0 of faces whose velocity is given
  Faces inverse_;          ///< of the diagonal; 0 there
  Faces velocity_, residual_, direction_, product_;
  Faces normal_;        ///< 2 s M of cells, along each axis
  Faces shear_;         ///< s M of edges: [a] of those along axis a, on the low sides of a cell
  Faces pull_, twist_;  ///< stresses: d_a u_a of cells, and of edges
  SurfaceStress<R> surfaces_;
  ViscousBodies<R> bodies_;
  bool acts_ = false;
  std::vector<Six> body_velocity_, body_residual_, body_direction_, body_product_, body_steps_;
  std::vector<double> parts_;
};

}  // namespace dreampm
