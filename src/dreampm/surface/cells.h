// Stage 1: points sorted into cubic cells, found by hash, so that far drops cost nothing.
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "dreampm/surface/lattice.h"

namespace dreampm::surface {

struct CellGrid {
  /// Sorts points into cells of edge `size`: by cell (z, y, x), within a cell by index.
  CellGrid(std::span<const Vec3f> points, float cell_size);

  float size;
  std::vector<Vec3i> cells;              ///< occupied cells, ordered by z, y, x
  std::vector<std::uint32_t> first;      ///< cell i holds order[first[i]] .. order[first[i + 1] - 1]
  std::vector<std::uint32_t> order;      ///< indices of points
  LatticeMap index;                      ///< cell -> its place in `cells`
  LatticeMap rows;                       ///< (0, y, z) -> number of the row of cells along x there
  std::vector<std::uint32_t> row_first;  ///< row i holds cells[row_first[i]] .. cells[row_first[i + 1] - 1]

  std::uint32_t count(std::size_t cell) const { return first[cell + 1] - first[cell]; }
};

/// Calls visit(i) for each occupied cell that the box from `lo` to `hi` touches, in order z, y, x.
template <class Visit>
void for_cells(const CellGrid& grid, const Vec3f& lo, const Vec3f& hi, const Visit& visit) {
  const Vec3i a = lattice_cell(lo, grid.size), b = lattice_cell(hi, grid.size);
  for (int z = a.z; z <= b.z; ++z)
    for (int y = a.y; y <= b.y; ++y)
      for (int x = a.x; x <= b.x; ++x)
        if (const std::int32_t c = grid.index.find({x, y, z}); c != LatticeMap::kAbsent)
          visit(static_cast<std::size_t>(c));
}

/// Calls visit(first, end) for the occupied cells first .. end - 1 of each row along x of the box
/// from cell `lo` to cell `hi`, in order z, y: what they hold lies together in `order`.
template <class Visit>
void for_rows(const CellGrid& grid, const Vec3i& lo, const Vec3i& hi, const Visit& visit) {
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y) {
      const std::int32_t r = grid.rows.find({0, y, z});
      if (r == LatticeMap::kAbsent) continue;
      const Vec3i *const row = grid.cells.data() + grid.row_first[static_cast<std::size_t>(r)],
                         *const row_end = grid.cells.data() + grid.row_first[static_cast<std::size_t>(r) + 1];
      const Vec3i* const begin = std::lower_bound(row, row_end, lo.x, [](const Vec3i& c, int x) { return c.x < x; });
      const Vec3i* end = begin;
      while (end != row_end && end->x <= hi.x) ++end;
      if (end != begin)
        visit(static_cast<std::size_t>(begin - grid.cells.data()), static_cast<std::size_t>(end - grid.cells.data()));
    }
}

/// The same for the rows that a ball touches, as far as it reaches into each.
template <class Visit>
void for_rows_of_ball(const CellGrid& grid, const Vec3f& middle, float radius, const Visit& visit) {
  const Vec3f r{radius, radius, radius};
  const Vec3i lo = lattice_cell(middle - r, grid.size), hi = lattice_cell(middle + r, grid.size);
  // A point may lie that far outside of its cell, by rounding.
  const float slack =
      1e-3f * grid.size + 1e-6f * std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
  const auto off = [&](int axis, int cell) {
    const float low = static_cast<float>(cell) * grid.size - slack, high = low + grid.size + 2 * slack;
    return std::max({0.0f, low - middle[axis], middle[axis] - high});
  };
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y) {
      const float oz = off(2, z), oy = off(1, y), left = radius * radius - oz * oz - oy * oy;
      if (left < 0) continue;
      const float reach = std::sqrt(left) + slack;
      const int from = std::max(lo.x, static_cast<int>(std::floor((middle.x - reach) / grid.size))),
                to = std::min(hi.x, static_cast<int>(std::floor((middle.x + reach) / grid.size)));
      for_rows(grid, {from, y, z}, {to, y, z}, visit);
    }
}

/// Per cell: does every cell within +-2 of it hold at least two points? Liquid there is far from
/// any surface.
std::vector<std::uint8_t> deep_cells(const CellGrid& grid);

}  // namespace dreampm::surface
