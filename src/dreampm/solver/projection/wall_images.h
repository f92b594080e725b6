// Cells behind walls, and those before them whose images they are.
#pragma once
#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {

/// Calls body(behind, before, count, wall) for cells behind the walls of an axis: where `count` of
/// them begin in an array, and those before the wall, whose number is `wall`.
template <class R, class Body>
void for_images(const MacGrid<R>& grid, int axis, const Body& body) {
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  parallel_ranges(rows.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const CellRows::Row& row = rows[n];
      const RowPlaces at(row);
      const auto s = static_cast<std::size_t>(axis);
      if (axis < 2) {
        const std::int32_t c = row.first[axis];
        if (c != grid.low[axis] && c != grid.high[axis] - 1) continue;
        // One that is both has an image behind each.
        if (c == grid.low[axis]) body(at.low[s], at.own, row_cells, 2 * s);
        if (c == grid.high[axis] - 1) body(at.high[s], at.own, row_cells, 2 * s + 1);
      } else {
        const int low = grid.low.z - row.first.z, high = grid.high.z - 1 - row.first.z;
        if (low >= 0 && low < row_cells)
          body(at.own + static_cast<std::size_t>(low) - 1, at.own + static_cast<std::size_t>(low), 1, 2 * s);
        if (high >= 0 && high < row_cells)
          body(at.own + static_cast<std::size_t>(high) + 1, at.own + static_cast<std::size_t>(high), 1, 2 * s + 1);
      }
    }
  });
}

/// Mirrors velocities of faces along walls to the faces behind them, with the opposite sign where
/// `turned` says so of the wall, so that they are 0 on it; axis by axis, so that edges and corners
/// follow. Particles at a wall read behind it.
template <class R>
void mirror_along_walls(const MacGrid<R>& grid, std::array<LargeVector<R>, 3>& faces,
                        const std::array<bool, 6>& turned = {}) {
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t a = 0; a < 3; ++a) {
      if (static_cast<int>(a) == axis) continue;
      R* const v = faces[a].data();
      for_images(grid, axis, [&](std::size_t behind, std::size_t before, int count, std::size_t wall) {
        if (behind < 2 * row_cells) return;  // no row there
        const R turn = turned[wall] ? R(-1) : R(1);
        for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) v[behind + n] = turn * v[before + n];
      });
    }
  for (auto& f : faces) grid.wrap(f);
}

}  // namespace dreampm
