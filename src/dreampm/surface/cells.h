// Stage 1: points sorted into cubic cells, found by hash, so that far drops cost nothing.
#pragma once
#include <span>
#include <vector>

#include "dreampm/surface/lattice.h"

namespace dreampm::surface {

struct CellGrid {
  /// Sorts points into cells of edge `size`: by cell (z, y, x), within a cell by index.
  CellGrid(std::span<const Vec3f> points, float cell_size);

  float size;
  std::vector<Vec3i> cells;          ///< occupied cells, ordered by z, y, x
  std::vector<std::uint32_t> first;  ///< cell i holds order[first[i]] .. order[first[i + 1] - 1]
  std::vector<std::uint32_t> order;  ///< indices of points
  LatticeMap index;                  ///< cell -> its place in `cells`

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
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        const std::int32_t c = grid.index.find({x, y, z});
        if (c == LatticeMap::kAbsent) continue;
        const auto begin = static_cast<std::size_t>(c);
        std::size_t end = begin + 1;
        while (end < grid.cells.size() && grid.cells[end].z == z && grid.cells[end].y == y && grid.cells[end].x <= hi.x)
          ++end;
        visit(begin, end);
        break;
      }
}

/// Per cell: does every cell within +-2 of it hold at least two points? Liquid there is far from
/// any surface.
std::vector<std::uint8_t> deep_cells(const CellGrid& grid);

}  // namespace dreampm::surface
