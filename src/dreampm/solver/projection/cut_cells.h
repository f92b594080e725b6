// Cells that colliders cut: how much of their faces and of their surroundings is open (Batty,
// Bertails and Bridson 2007).
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "dreampm/contact/collider_view.h"
#include "dreampm/math/vec_hash.h"
#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {

/// Returns the hydrostatic change of a cell's pressure over a cell's width, in the units of
/// MacGrid::impulse: by gravity, which gave `gained` [m/s]. Films are too thin for all of that.
inline Vec3d pressure_slope(double depth, const Vec3d& gained) {
  return depth > 0 ? gained * std::min(1.0, 2 * depth) : Vec3d{};
}

/// The colliders of a world as the cells of its grid see them. What is known of a block is kept
/// until a collider near it stands elsewhere.
template <class R>
class CutCells {
 public:
  /// Once the grid of a step is laid, and colliders are where they stand at its end: finds the open
  /// parts and the velocities of the rest, and writes them to the grid.
  void cut(const World<R>& world, MacGrid<R>& grid);
  /// Once rigid bodies have other velocities: writes those of the faces that colliders close in
  /// part.
  void find_velocities(const World<R>& world, MacGrid<R>& grid) const;
  /// Takes the colliders as they stand now, for Collisions; forgets what it knows of blocks near
  /// those that moved.
  void see(const World<R>& world);
  /// True if there are colliders.
  bool any() const { return !placed_.empty(); }

  /// The low face of a cell along an axis, of which a collider closes a part.
  struct ClosedFace {
    Vec3i cell;
    int axis;
    std::size_t place;  ///< in the arrays of the grid
    double closed;      ///< the part, also of faces on walls
    std::uint16_t owner;
    Vec3d middle;  ///< of what is closed, from the low corner of the cell [cells]
    /// The way there from the center of the cell on its high or low side [cells].
    Vec3d way(bool high) const {
      Vec3d from_center = middle - Vec3d{0.5, 0.5, 0.5};
      from_center[axis] += high ? 0 : 1;
      return from_center;
    }
  };
  /// Calls body(ClosedFace) for those of a block, after `cut`.
  template <class Body>
  void for_closed(const MacGrid<R>& grid, const Vec3i& block, const Body& body) const {
    for_cells(grid, block, [&](const Block& cut, std::size_t n, std::size_t place) {
      const Vec3i cell = node_offset(static_cast<int>(n));
      for (std::size_t a = 0; a < 3; ++a) {
        if (cut.owner[a][n] == grid.no_owner) continue;
        body(ClosedFace{block * block_width + cell, static_cast<int>(a), place, static_cast<double>(1 - cut.open[a][n]),
                        cut.owner[a][n], middle_of_closed(cut, a, n)});
      }
    });
  }

  /// A cell of which colliders fill a part.
  struct FilledCell {
    Vec3i cell;
    std::size_t place;
    double filled;
    std::uint16_t owner;
    Vec3d middle;  ///< of what is filled, from the low corner of the cell [cells]
  };
  /// Calls body(FilledCell) for those of a block, after `cut`.
  template <class Body>
  void for_filled(const MacGrid<R>& grid, const Vec3i& block, const Body& body) const {
    for_cells(grid, block, [&](const Block& cut, std::size_t n, std::size_t place) {
      if (cut.filler[n] == grid.no_owner) return;
      body(FilledCell{block * block_width + node_offset(static_cast<int>(n)), place, static_cast<double>(cut.filled[n]),
                      cut.filler[n], static_cast<Vec3d>(cut.filled_middle[n])});
    });
  }

  /// The part of a cell that colliders fill, and of cubes of that size around the middles of its
  /// low face of an axis and of its edge along an axis on its low sides.
  struct FilledParts {
    std::size_t place;
    R cell;
    std::array<R, 3> face, edge;
    std::uint16_t owner;  ///< the collider nearest to the cell; none where nothing fills it
  };
  /// Calls body(FilledParts) for the cells of a block near colliders, after `cut`.
  template <class Body>
  void for_parts(const MacGrid<R>& grid, const Vec3i& block, const Body& body) const {
    for_cells(grid, block, [&](const Block& cut, std::size_t n, std::size_t place) {
      FilledParts parts{place, cut.filled[n], {}, {}, cut.filler[n]};
      for (std::size_t a = 0; a < 3; ++a)
        parts.face[a] = cut.filled_at_face[a][n], parts.edge[a] = cut.filled_at_edge[a][n];
      body(parts);
    });
  }

  /// Moves the particles of one block of particles along colliders instead of into them.
  class Collisions {
   public:
    /// `dt`: of the step [s].
    Collisions(const World<R>& world, const CutCells& cells, const Vec3i& block, double dt);
    /// True if a collider is near at all.
    bool is_needed() const { return view_.has_value(); }
    /// The surface that a particle came to last.
    struct Surface {
      Vec3d normal;     ///< outward; 0 where it came to none
      Vec3d velocity;   ///< of the collider there [m/s]
      double part = 1;  ///< of its way that it went: little between two surfaces
    };
    /// Takes a particle from `from` to `x`, along the surfaces that it comes to: it goes through no
    /// wall of a cell. Places in cells from the node `first`.
    Surface operator()(const Vec3i& first, const Vec3<R>& from, Vec3<R>& x) const;

   private:
    /// Puts a place [cells from the block's first node] to which a particle came from `from` out of
    /// the collider that it is in. In a gap too narrow for that, where the way out leads through
    /// the solid or into another side, the particle stays at `from`.
    void put_out(const Vec3d& from, Vec3d& at, Surface& met) const;

    Vec3d block_;  ///< its first node
    double way_;   ///< cells for each m/s
    std::optional<ColliderView> view_;
  };

 private:
  /// Data of the 64 cells of a block that a collider cuts or fills.
  struct Block {
    std::array<std::array<R, block_nodes>, 3> open;  ///< of the low faces
    /// The middle of what is not, along the two axes after the face's own, from 0 to 1.
    std::array<std::array<R, block_nodes>, 3> along, up;
    std::array<R, block_nodes> room;                ///< as MacGrid::room
    std::array<std::array<R, block_nodes>, 3> gap;  ///< as MacGrid::gap
    /// The owner, as MacGrid::owner.
    std::array<std::array<std::uint16_t, block_nodes>, 3> owner;
    /// For each cell: the part that colliders fill, its middle from the cell's low corner, and the
    /// number of the nearest collider where they fill any.
    std::array<R, block_nodes> filled;
    std::array<Vec3<R>, block_nodes> filled_middle;
    std::array<std::uint16_t, block_nodes> filler;
    std::array<std::array<R, block_nodes>, 3> filled_at_face, filled_at_edge;  ///< as FilledParts
  };
  /// Calls body(what is known of the block, n, place) for the cells of a block near colliders.
  template <class Body>
  void for_cells(const MacGrid<R>& grid, const Vec3i& block, const Body& body) const {
    const auto found = blocks_.find(block);
    if (found == blocks_.end() || !found->second) return;
    grid.cells.for_block(block, [&](std::size_t n, std::size_t place) { body(*found->second, n, place); });
  }
  /// Returns the vector from the low corner of a cell to the middle of the closed part of its low
  /// face [cells].
  static Vec3d middle_of_closed(const Block& cut, std::size_t axis, std::size_t n);
  /// Null where no collider is.
  std::unique_ptr<Block> cut_block(const World<R>& world, const Vec3i& block) const;

  std::vector<PlacedCollider> placed_;
  std::unordered_map<Vec3i, std::unique_ptr<Block>, Vec3iHash> blocks_;
};

}  // namespace dreampm
