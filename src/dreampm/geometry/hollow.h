// A hollow as liquid finds it: which of its cells can be reached through the mouth, and what a
// cloud of particles fills of them.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "dreampm/geometry/container.h"

namespace dreampm {

/// A hollow on a grid of cells. Half cells are looked at, so that walls may lie anywhere. Made by
/// hollow_cells.
struct HollowCells {
  std::shared_ptr<const Region> region;  ///< the hollow
  double dx = 0;                         ///< m, side of a cell
  Vec3d low;                             ///< m, the grid's lowest corner
  Vec3i count;                           ///< cells along each axis
  /// m^3 of each cell that can be reached and lie below the spill level; x runs fastest
  std::vector<float> capacity;
  std::vector<std::uint8_t> open;  ///< by cell: whether it lies at the mouth or at the spill level
  Vec3d up{0, 1, 0};
  double spill = 0;      ///< m along `up`: liquid above runs over the rim
  double volume = 0;     ///< m^3 of all of the hollow
  double reachable = 0;  ///< m^3, the sum of `capacity`

  std::size_t index(const Vec3i& c) const {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(count.x) *
               (static_cast<std::size_t>(c.y) + static_cast<std::size_t>(count.y) * static_cast<std::size_t>(c.z));
  }
};

/// Cells of `dx` [m]. What can be reached is what a ball of two cells sweeps that comes in by the
/// mouth, and what lies within a cell of that. `up` is the unit vector against gravity. `blocking`:
/// other solids that stand in the hollow. Throws InputError for more than 2^26 cells.
HollowCells hollow_cells(const PlacedHollow& hollow, double dx, const Vec3d& up,
                         std::span<const std::shared_ptr<const Region>> blocking = {});

/// Empty cells that liquid has closed in.
struct Pocket {
  Vec3d at;           ///< m, their middle
  double volume = 0;  ///< m^3
};

struct Fill {
  double filled = 0;            ///< m^3 of the cells that are filled
  double leaked = 0;            ///< m^3 of liquid below the spill level, more than half a cell outside of the hollow
  std::vector<Pocket> pockets;  ///< the largest first
};

/// `points` [m] are the particles of all liquids, of `volume` [m^3] each. A cell is filled where
/// they hold half of its capacity or more. One that a wall cuts, which particles may miss, goes by
/// the cells around it too. A pocket is a set of cells that are not filled, joined by
/// faces, none of them open, of at least four cells' volume: less is chance.
Fill fill_of(const HollowCells& hollow, std::span<const Vec3d> points, double volume);

}  // namespace dreampm
