// Rigid bodies in the equation of viscosity: the liquid that sticks to one moves with it, so that
// all of its faces have six velocities together. Where it slips, cells know what flows out of them
// as one moves.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/solver/projection/body_motion.h"
#include "dreampm/solver/projection/body_pressure.h"
#include "dreampm/solver/projection/surface_stress.h"

namespace dreampm {

template <class R>
class ViscousBodies {
 public:
  using Faces = std::array<LargeVector<R>, 3>;

  /// Finds the faces that bodies close and whose liquid they hold, for a step of `density`
  /// [kg/m^3]. `stiffness(axis, face)`: of its stresses; 0 where there are none.
  template <class Stiffness>
  void begin(const World<R>& world, const MacGrid<R>& grid, double density, const Stiffness& stiffness);
  /// Adds the cells along whose surfaces liquid slips; ends the work that `begin` began.
  void add_cells(const BodyPressure<R>& pressed, const SurfaceStress<R>& surfaces);

  // Vectors of the solve, one Six a body.

  /// Sums the forces on faces and the stresses of cells to those on bodies: J f.
  void gather(const Faces& f, const SurfaceStress<R>& surfaces, std::vector<Six>& bodies) const;
  /// Velocities of faces from those of bodies, and the faces that have them: J^T V.
  void scatter(const std::vector<Six>& bodies, Faces& u) const;
  /// The same, added to what is there; and in `free` of open faces what they are then.
  void scatter_more(const std::vector<Six>& bodies, Faces& u, MacGrid<R>& grid) const;
  /// Adds the flow out of cells that the motion of bodies causes.
  void add_flow(const std::vector<Six>& bodies, SurfaceStress<R>& surfaces) const;
  /// M V, M over the mass of a cell of liquid; 0 in locked components.
  void weigh(const std::vector<Six>& velocities, std::vector<Six>& out) const;
  /// Multiplies by the inverse of M and of the stiffness of their faces.
  void precondition(const std::vector<Six>& residual, std::vector<Six>& out) const;
  std::size_t size() const { return bodies_.size(); }
  /// Adds to the twists of the bodies.
  void move(World<R>& world, const std::vector<Six>& change) const;

 private:
  struct Body {
    std::size_t collider;
    SixBySix mass, inverse;
    std::array<bool, 6> locked;
  };
  struct Face {
    std::uint32_t place, body;
    std::uint8_t axis;
    Six column;
  };
  void lock(std::vector<Six>& vectors) const;
  std::vector<Body> bodies_;  ///< as in World::rigid
  std::vector<Face> faces_;
  std::vector<typename BodyPressure<R>::Cell> cells_;
};

template <class R>
template <class Stiffness>
void ViscousBodies<R>::begin(const World<R>& world, const MacGrid<R>& grid, double density,
                             const Stiffness& stiffness) {
  bodies_.clear(), faces_.clear();
  const double cell_mass = density * world.dx * world.dx * world.dx;
  std::vector<std::uint32_t> body_of(world.colliders.size(), ~std::uint32_t{0});
  for (const RigidBody& body : world.rigid) {
    if (grid.holding.colliders[body.collider]) body_of[body.collider] = static_cast<std::uint32_t>(bodies_.size());
    Body& b = bodies_.emplace_back(Body{body.collider, mass_of(body, world.colliders[body.collider]), {}, body.locked});
    for (Six& row : b.mass)
      for (double& m : row) m /= cell_mass;
    b.inverse = b.mass;
  }
  if (bodies_.empty() || grid.gap[0].empty()) return;
  for (const CellRows::Row& row : grid.cells.rows()) {
    const RowPlaces at(row);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l;
        if (grid.owner[a][f] == grid.no_owner || !(grid.gap[a][f] <= R(0))) continue;
        const std::uint32_t body = body_of[grid.owner[a][f]];
        if (body == ~std::uint32_t{0}) continue;
        const auto stiff = static_cast<double>(stiffness(a, at, l));
        if (!(stiff > 0)) continue;
        const auto axis = static_cast<int>(a);
        const Vec3i cell = row.first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
        const Six column =
            along_axis(axis, arm_to(world, world.colliders[bodies_[body].collider], cell, face_middle(axis, false)));
        faces_.push_back({static_cast<std::uint32_t>(f), body, static_cast<std::uint8_t>(a), column});
        for (std::size_t n = 0; n < 6; ++n)
          for (std::size_t m = 0; m < 6; ++m) bodies_[body].inverse[n][m] += stiff * column[n] * column[m];
      }
  }
}

}  // namespace dreampm
