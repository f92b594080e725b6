// The staggered grid of one step of a projection (marker and cell, Harlow and Welch 1965): liquid
// in cells, velocities on their faces.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/base/large_vector.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/projection/trilinear.h"
#include "dreampm/solver/projection/cell_rows.h"
#include "dreampm/solver/projection/kernels.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// True if the projection moves matter of that type.
inline bool is_projected(std::string_view material) { return material == "newtonian"; }
/// True if the projection moves the particles of a set: others go by explicit steps beside it
/// (solver/projection/solids.h).
template <class R>
bool is_projected(const ParticleSet<R>& set) {
  return is_projected(set.material);
}

/// A set of its liquid, of which all are alike; null where there is none.
template <class R>
const ParticleSet<R>* liquid_of(const World<R>& world) {
  const auto found = std::find_if(world.sets.begin(), world.sets.end(), is_projected<R>);
  return found == world.sets.end() ? nullptr : &*found;
}

/// The walls and colliders that hold liquids: along others they slip.
struct Holding {
  std::array<bool, 6> walls{};  ///< in the order of World::walls
  std::vector<bool> colliders;  ///< in the order of World::colliders
};

/// Arrays over the rows of `cells`. What is of a face belongs to the cell on its high side.
template <class R>
struct MacGrid {
  using Field = LargeVector<R>;

  CellRows cells;
  Vec3i low, high;  ///< node planes of the walls: cells in [low, high) are within; far off where one is open

  Holding holding;

  std::array<LargeVector<FaceSum<R>>, 3> sums;  ///< of faces: what particles gave [m/s, 1]
  std::array<Field, 3> open;                    ///< of faces: the part that is no wall [1]
  /// For each face, the velocity of the solid that closes it [m/s]; empty where all colliders are
  /// at rest.
  std::array<Field, 3> solid;
  /// For each face that colliders close in part, the number of the nearest one, else `no_owner`;
  /// empty without colliders.
  std::array<LargeVector<std::uint16_t>, 3> owner;
  static constexpr std::uint16_t no_owner = 0xffff;
  /// For each face, the distance from its middle to the nearest collider [cells], negative inside;
  /// `far` where none is near. Empty where no collider holds liquids.
  std::array<Field, 3> gap;
  static constexpr R far = R(10);
  std::array<Field, 3> free;       ///< of faces: before the pressure [m/s]
  std::array<Field, 3> velocity;   ///< of faces: after it [m/s]
  std::array<Field, 3> moving;     ///< of faces: that, and what the density asks for [m/s]
  Field room;                      ///< of cells: the part of their kernel outside of colliders; empty: 1
  Field density;                   ///< of cells, over that at rest, of all matter
  Field depth;                     ///< of cells, below the surface [cells]; liquid where above 0
  Field impulse;                   ///< of cells: pressure times the step's kick over rho dx [m/s]
  Field displacement;              ///< of cells: its slope moves particles [cells]
  LargeVector<std::uint8_t> held;  ///< of cells: whether a particle is within
  Field scratch;

  // Matter beside the liquid; empty without.
  std::array<LargeVector<FaceSum<R>>, 3> solid_sums;  ///< of faces: as `sums`, over the mass of a cell of liquid
  std::array<Field, 3> solid_free;                    ///< of faces: as `free`
  Field solid_volume;                                 ///< of cells: its part of `density`
  // Grains; empty without.
  std::array<LargeVector<FaceSum<R>>, 3> grain_sums;  ///< of faces, as `solid_sums`
  Field grain_volume;                                 ///< of cells: their part of `density`, without pores
  /// For each face, the density of the liquid over that of the matter there; empty: 1.
  std::array<Field, 3> lightness;

  R lightness_of(std::size_t axis, std::size_t face) const {
    return lightness[axis].empty() ? R(1) : lightness[axis][face];
  }

  const RowKernels<R>* kernels = &projection_kernels<R>("auto").rows;
  /// Returns those rows of the grid, as kernels see them.
  GridRows<R> as_rows(std::span<const CellRows::Row> rows) {
    GridRows<R> grid{rows.data(), low, high, {}, {}, {}, {}, depth.data(), impulse.data(), {}, {}, {}};
    for (std::size_t a = 0; a < 3; ++a) {
      grid.sums[a] = sums[a].data(), grid.open[a] = open[a].data();
      grid.solid[a] = solid[a].empty() ? nullptr : solid[a].data();
      grid.lightness[a] = lightness[a].empty() ? nullptr : lightness[a].data();
      grid.free[a] = free[a].data(), grid.velocity[a] = velocity[a].data(), grid.moving[a] = moving[a].data();
    }
    return grid;
  }
  /// Calls body(kernels, its fields, begin, end) for pieces of rows.
  template <class Body>
  void with_kernels(std::span<const CellRows::Row> rows, const Body& body) {
    const GridRows<R> grid = as_rows(rows);
    parallel_ranges(rows.size(), 64, [&](std::size_t begin, std::size_t end) { body(*kernels, grid, begin, end); });
  }

  /// Lays it over the grid blocks of a world, and empties it.
  void lay(const World<R>& world);

  /// CellRows::wrap, of one that may be empty.
  template <class T>
  void wrap(LargeVector<T>& field) const {
    if (!field.empty()) cells.wrap(field.data());
  }

  /// True if a cell is liquid, and so are all cells to which its open faces lead.
  bool is_deep(const RowPlaces& at, std::size_t lane) const {
    bool deep = depth[at.own + lane] > R(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t above = at.high[a] + lane;
      deep = deep && (depth[at.low[a] + lane] > R(0) || !(open[a][at.own + lane] > R(0)));
      deep = deep && (depth[above] > R(0) || !(open[a][above] > R(0)));
    }
    return deep;
  }
  bool within(int axis, std::int32_t cell) const { return cell >= low[axis] && cell < high[axis]; }
  /// True if the middle of a face lies in a collider that holds liquids.
  bool is_in_holder(std::size_t axis, std::size_t face) const {
    return !gap[axis].empty() && gap[axis][face] <= R(0) && is_held(axis, face);
  }
  /// True if a collider holds the matter at a face that it closes.
  bool is_held(std::size_t axis, std::size_t face) const {
    const std::uint16_t number = owner[axis].empty() ? no_owner : owner[axis][face];
    return number != no_owner && holding.colliders[number];
  }
  /// The closed wall on whose plane the low faces of cells at `cell` along an axis lie: its number;
  /// -1 where there is none.
  int wall_at(int axis, std::int32_t cell) const {
    return cell == low[axis] ? 2 * axis : cell == high[axis] ? 2 * axis + 1 : -1;
  }
  /// Calls body(lane, wall) for the cells of a row whose low faces of an axis lie on a closed wall.
  template <class Body>
  void for_on_walls(int axis, const CellRows::Row& row, const Body& body) const {
    if (axis < 2) {
      const int wall = wall_at(axis, row.first[axis]);
      for (int lane = 0; wall >= 0 && lane < row_cells; ++lane) body(lane, wall);
    } else {
      const int low_lane = low.z - row.first.z, high_lane = high.z - row.first.z;
      if (low_lane >= 0 && low_lane < row_cells) body(low_lane, 4);
      if (high_lane >= 0 && high_lane < row_cells) body(high_lane, 5);
    }
  }
  /// Returns the numbers [first, second) of the cells of a row between the walls; none where the
  /// row itself is outside of them.
  std::array<int, 2> lanes_within(const CellRows::Row& row) const {
    if (!within(0, row.first.x) || !within(1, row.first.y)) return {0, 0};
    return {std::clamp(low.z - row.first.z, 0, row_cells), std::clamp(high.z - row.first.z, 0, row_cells)};
  }
};

/// Returns the vector from the low corner of a cell to the middle of its low or high face of an
/// axis [cells].
inline Vec3d face_middle(int axis, bool high) {
  Vec3d middle{0.5, 0.5, 0.5};
  middle[axis] = high ? 1 : 0;
  return middle;
}

/// Calls body(row, places) for all rows, in parallel.
template <class Body>
void for_all_rows(std::span<const CellRows::Row> rows, const Body& body) {
  parallel_ranges(rows.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) body(rows[n], RowPlaces(rows[n]));
  });
}

}  // namespace dreampm
