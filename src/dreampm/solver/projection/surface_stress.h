// Stress across the surfaces of colliders, in the equation of viscosity: one along which a liquid
// slips holds it across, and does nothing to it along.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "dreampm/solver/projection/cut_cells.h"

namespace dreampm {

/// The stress across surfaces that cut cells. The pressure brings the flow out of such a cell,
///   D = sum of A u + (1 - A) u_s  over its faces, outward,
/// to 0. kappa D^2/2 is added to the functional that velocities minimize: kappa D is the liquid's
/// stress across the surface, and no steady flow is changed. The term acts where liquid slips along
/// a collider, and on rigid bodies: without it the alternation of pressure and viscosity shakes a
/// light body. Where liquid slips, stresses count by the part of a cell that lies outside, and
/// velocities of faces behind the surface continue the flow before it, without divergence:
/// beta (sum of d_a u_a)^2/2.
template <class R>
class SurfaceStress {
 public:
  using Field = LargeVector<R>;
  using Faces = std::array<Field, 3>;

  /// Finds what colliders along which it slips leave of cells, faces and edges.
  void begin(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut);
  /// True if there are such colliders or rigid bodies; else the rest must not be asked for.
  bool any() const { return !cell_.empty(); }
  /// The open parts of a cell, and of cubes of its size around a face and an edge.
  R in_cell(std::size_t c) const { return cell_[c]; }
  R at_face(std::size_t a, std::size_t f) const { return face_[a][f]; }
  R at_edge(std::size_t axis, std::size_t e) const { return edge_[axis][e]; }
  /// The part of a face between the walls that a collider closes along which liquid slips.
  R closed(const MacGrid<R>& grid, std::size_t a, std::size_t f) const {
    const std::uint16_t owner = grid.owner[a][f];
    return owner == grid.no_owner || grid.holding.colliders[owner] ? R(0) : 1 - grid.open[a][f];
  }

  /// Finds kappa and beta of a step whose `diffusion` is s. `counts(axis, face)`: whether the
  /// velocity of a face is known. Uses the depths, and the last pressure.
  template <class Counts>
  void find_stiffness(const World<R>& world, const MacGrid<R>& grid, R diffusion, const Counts& counts);
  /// kappa of a cell; 0 where no such surface is.
  R kappa(std::size_t c) const { return kappa_[c]; }
  /// Returns the resistance of a face by these stresses alone.
  R stiffness(const MacGrid<R>& grid, std::size_t a, const RowPlaces& at, std::size_t l) const {
    const std::size_t f = at.own + l, below = at.low[a] + l;
    const R open = grid.open[a][f];
    return open * open * (kappa_[f] + kappa_[below]) + beta_[f] + beta_[below];
  }
  /// The stresses at velocities u of faces, with those of colliders as the grid has them or, where
  /// `moving` is false, without.
  void find_stress(const MacGrid<R>& grid, const Faces& u, bool moving);
  /// Adds to D of a cell.
  void add_flow(std::size_t c, double flow) { pull_[c] += kappa_[c] * static_cast<R>(flow); }
  /// Once all is added.
  void end_stress(const MacGrid<R>& grid) { grid.wrap(pull_), grid.wrap(swell_); }
  /// Adds minus the gradient of these sums to f.
  void add_force(const MacGrid<R>& grid, Faces& f) const;
  /// kappa D of cells.
  const Field& pull() const { return pull_; }

 private:
  /// True if the last pressure, of a cell or, where the cell is new, of those beside it, was
  /// positive.
  static bool was_pressed(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l) {
    R pressure = grid.impulse[at.own + l];
    if (pressure == R(0))
      for (std::size_t a = 0; a < 3; ++a) pressure += grid.impulse[at.low[a] + l] + grid.impulse[at.high[a] + l];
    return pressure > R(0);
  }
  /// The stiffness kappa and beta over that of a cell, 2 s, where s is large: so high that a
  /// surface gives way by little, and not so high that the solve gets hard.
  static constexpr double stiffness_over_cells = 20;
  /// The least area of a surface in a cell [dx^2]: it is less in a gap that is narrower than a
  /// cell.
  static constexpr double least_area = 0.3;

  std::vector<bool> stiff_;  ///< of World::colliders
  Field cell_;
  Faces face_, edge_;
  Field kappa_, beta_, pull_, swell_;
  /// The rows of the grid with such cells, and those with faces of such.
  std::vector<std::uint32_t> cut_rows_, rows_beside_;
};

template <class R>
template <class Counts>
void SurfaceStress<R>::find_stiffness(const World<R>& world, const MacGrid<R>& grid, R diffusion,
                                      const Counts& counts) {
  // A pressure that acts after little viscosity finds the rest.
  const R stiff = 2 * static_cast<R>(stiffness_over_cells) * diffusion * diffusion / (1 + diffusion);
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row& row, const RowPlaces& at) {
    const auto [first, last] = grid.lanes_within(row);
    for (int lane = first; lane < last; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      const std::size_t c = at.own + l;
      if (!(grid.depth[c] > R(0))) continue;
      R area2 = 0;
      bool cut = false, slips = false, whole = true;
      for (std::size_t a = 0; a < 3; ++a) {
        R across = 0;
        for (const std::size_t f : {c, at.high[a] + l}) {
          whole = whole && counts(a, f);
          const std::uint16_t owner = grid.owner[a][f];
          if (owner == grid.no_owner || !stiff_[owner]) continue;
          const R part = 1 - grid.open[a][f];
          cut = true, slips = slips || !grid.holding.colliders[owner], across += f == c ? part : -part;
          // Liquid that may leave a surface stays only where it was pressed to it.
          if (world.colliders[owner].contact() == WallType::separate) whole = whole && was_pressed(grid, at, l);
        }
        area2 += across * across;
      }
      if (!cut || !whole) continue;
      kappa_[c] = stiff / std::max(std::sqrt(area2), static_cast<R>(least_area));
      if (slips) beta_[c] = stiff * cell_[c];
    }
  });
  grid.wrap(kappa_), grid.wrap(beta_);
  cut_rows_.clear(), rows_beside_.clear();
  const auto rows = grid.cells.rows();
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const RowPlaces at(rows[n]);
    const auto is_cut = [&](std::size_t first) {
      const R* const kappa = kappa_.data() + first;
      return std::any_of(kappa, kappa + row_cells, [](R k) { return k > R(0); });
    };
    const bool cut = is_cut(at.own);
    if (cut) cut_rows_.push_back(static_cast<std::uint32_t>(n));
    if (cut || kappa_[at.low[2]] > R(0) || is_cut(at.low[0]) || is_cut(at.low[1]))
      rows_beside_.push_back(static_cast<std::uint32_t>(n));
  }
}

}  // namespace dreampm
