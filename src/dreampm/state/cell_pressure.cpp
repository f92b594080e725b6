#include "dreampm/state/cell_pressure.h"

#include <algorithm>
#include <cmath>

namespace dreampm {

template <class R>
double CellPressure<R>::of_cell(const Vec3i& cell) const {
  const std::int32_t block = world_.grid.blocks.find(world_.wrapped(block_of(cell)));
  const std::size_t at = static_cast<std::size_t>(std::max(block, 0)) * block_nodes +
                         static_cast<std::size_t>(node_index(cell.x & 3, cell.y & 3, cell.z & 3));
  return block == BlockList::none || at >= world_.cell_pressure.size() ? 0
                                                                       : static_cast<double>(world_.cell_pressure[at]);
}

template <class R>
double CellPressure<R>::from(const Vec3i& cell, double own, const Vec3d& way) const {
  double value = own;
  for (int a = 0; a < 3; ++a) {
    Vec3i low = cell, high = cell;
    low[a] -= 1, high[a] += 1;
    const double below = of_cell(low), above = of_cell(high);
    // One side's slope where the other side has no liquid, so that the slope ends with the liquid.
    const double slope = below == 0 ? (above == 0 ? 0 : above - own) : above == 0 ? own - below : (above - below) / 2;
    value += slope * way[a];
  }
  return value;
}

template <class R>
double CellPressure<R>::at(const Vec3d& position) const {
  const Vec3d cells = (position - world_.origin) / world_.dx - Vec3d{0.5, 0.5, 0.5};
  Vec3i first;
  Vec3d way;
  for (int a = 0; a < 3; ++a) {
    const double whole = std::floor(cells[a]);
    first[a] = world_.low[a] + static_cast<std::int32_t>(whole), way[a] = cells[a] - whole;
  }
  double pressure[8], weight[8], sum = 0, liquid = 0, least = 0;
  for (int n = 0; n < 8; ++n) {
    const Vec3i corner{n >> 2, n >> 1 & 1, n & 1};
    pressure[n] = of_cell(first + corner);
    weight[n] = 1;
    for (int a = 0; a < 3; ++a) weight[n] *= corner[a] ? way[a] : 1 - way[a];
    if (pressure[n] != 0) liquid += weight[n];
    sum += weight[n] * pressure[n], least = std::min(least, pressure[n]);
  }
  if (!(liquid > 0)) return 0;
  if (std::none_of(pressure, pressure + 8, [](double p) { return p == 0; })) return sum;
  sum = 0;
  for (int n = 0; n < 8; ++n) {
    if (pressure[n] == 0) continue;
    const Vec3i corner{n >> 2, n >> 1 & 1, n & 1};
    sum += weight[n] * from(first + corner, pressure[n], way - static_cast<Vec3d>(corner));
  }
  return std::max(sum / liquid, least);
}

template class CellPressure<float>;
template class CellPressure<double>;

}  // namespace dreampm
