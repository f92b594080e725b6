// Rigid bodies in the pressure equation: their velocities are unknowns of it, so that a body is
// stable however light it is (Batty, Bertails and Bridson 2007, section 5).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/solver/projection/body_motion.h"
#include "dreampm/solver/projection/cut_cells.h"
#include "dreampm/solver/projection/multigrid.h"

namespace dreampm {

/// The pressure on rigid bodies, as a term of the matrix. With q the impulse of cells and V the
/// velocities of the bodies, A q = b(V) and V = V* + M^-1 rho dx^3 J q. b is linear, and b(V) =
/// b(V*) - J^T (V - V*). So J^T M^-1 rho dx^3 J is added to the matrix. J q is the sum over the
/// faces of A' (q_low - q_high) times the face's velocity per velocity of the body, A' the part of
/// the face that the body closes.
template <class R>
class BodyPressure final : public AddedOperator<R> {
 public:
  /// Begins the solves of a step of `density` [kg/m^3] with the bodies as they stand.
  void begin(const World<R>& world, double density);
  bool any() const { return !bodies_.empty(); }
  /// Finds the cells of liquid beside bodies; once the depths are known.
  void find_cells(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut);
  /// Cells know the pressure of their centers, and by gravity, which gave `gained` [m/s], it grows
  /// within them. Adds to the bodies' twists what that gives: by the divergence theorem, the
  /// pressure over a cell's part of a surface is that over the closed parts of its faces less its
  /// slope times what is filled. So still water pushes nothing aside and lifts by its weight.
  void press_on_surfaces(World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut, const Vec3d& gained);
  double add(const LargeVector<R>& x, R scale, LargeVector<R>& y) override;
  /// Adds to the bodies' twists what the pressure gives them, `times` so much.
  void move_bodies(World<R>& world, const LargeVector<R>& impulse, double times);

  /// A cell at a face that a body, by its place in World::rigid, closes, and what the face adds to
  /// the cell's column of J.
  struct Cell {
    std::uint32_t place, body;
    Six column;
  };
  std::span<const Cell> cells() const { return cells_; }

 private:
  struct Body {
    std::size_t collider;
    SixBySix response;  ///< M^-1 rho dx^3
    Six sum, gain;
  };
  /// The velocity of what it closes of a face for each component of a body's twist, times the part.
  Six column(const World<R>& world, std::uint32_t body, const typename CutCells<R>::ClosedFace& face);
  /// Computes for each body its sum J x, and the velocity that it gains by it.
  void sum_columns(const LargeVector<R>& x);
  /// Adds to the bodies' twists what they gain, `times` so much.
  void gain(World<R>& world, double times);

  std::vector<Body> bodies_;
  std::vector<std::uint32_t> body_of_;  ///< of each collider; none where it is no rigid body
  std::vector<Cell> cells_;
  std::vector<std::vector<Cell>> pieces_;
};

}  // namespace dreampm
