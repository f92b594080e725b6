#include "dreampm/surface/cells.h"

#include <algorithm>
#include <numeric>

#include "dreampm/base/parallel.h"

namespace dreampm::surface {

CellGrid::CellGrid(std::span<const Vec3f> points, float cell_size) : size(cell_size) {
  const std::size_t n = points.size();
  std::vector<std::int32_t> cell(n);
  // Number the occupied cells as they appear, put the numbers in order, then count and place:
  // linear in the points.
  std::vector<std::uint64_t> keys;
  std::vector<std::uint64_t> key(n);
  parallel_for(n, 8192, [&](std::size_t i) { key[i] = LatticeMap::key(lattice_cell(points[i], size)); });
  LatticeMap seen(n / 8);
  for (std::size_t i = 0; i < n; ++i) {
    cell[i] = seen.insert(LatticeMap::place(key[i]), static_cast<std::int32_t>(keys.size()));
    if (static_cast<std::size_t>(cell[i]) == keys.size()) keys.push_back(key[i]);
  }
  std::vector<std::uint32_t> by_place(keys.size()), rank(keys.size());
  std::iota(by_place.begin(), by_place.end(), 0u);
  std::sort(by_place.begin(), by_place.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  cells.resize(keys.size());
  index = LatticeMap(keys.size());
  for (std::size_t r = 0; r < keys.size(); ++r) {
    rank[by_place[r]] = static_cast<std::uint32_t>(r);
    cells[r] = LatticeMap::place(keys[by_place[r]]);
    index.insert(cells[r], static_cast<std::int32_t>(r));
  }
  for (std::size_t r = 0; r < cells.size(); ++r) {
    if (r > 0 && cells[r].y == cells[r - 1].y && cells[r].z == cells[r - 1].z) continue;
    rows.insert({0, cells[r].y, cells[r].z}, static_cast<std::int32_t>(row_first.size()));
    row_first.push_back(static_cast<std::uint32_t>(r));
  }
  row_first.push_back(static_cast<std::uint32_t>(cells.size()));
  first.assign(keys.size() + 1, 0);
  for (std::size_t i = 0; i < n; ++i) ++first[rank[static_cast<std::size_t>(cell[i])] + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  order.resize(n);
  std::vector<std::uint32_t> at(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < n; ++i)
    order[at[rank[static_cast<std::size_t>(cell[i])]]++] = static_cast<std::uint32_t>(i);
}

std::vector<std::uint8_t> deep_cells(const CellGrid& grid) {
  const std::size_t n = grid.cells.size();
  std::vector<std::uint8_t> now(n), next(n);
  for (std::size_t i = 0; i < n; ++i) now[i] = grid.count(i) >= 2;
  for (int axis = 0; axis < 3; ++axis) {  // "all of a cube" is "all of a line", three times
    parallel_for(n, 1024, [&](std::size_t i) {
      next[i] = now[i];
      for (int d = -2; d <= 2 && next[i]; ++d) {
        Vec3i at = grid.cells[i];
        at[axis] += d;
        const std::int32_t j = grid.index.find(at);
        next[i] = j != LatticeMap::kAbsent && now[static_cast<std::size_t>(j)];
      }
    });
    now.swap(next);
  }
  return now;
}

}  // namespace dreampm::surface
