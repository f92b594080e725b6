// The points near one cell, copied together in lanes.
#pragma once
#include <vector>

#include "dreampm/surface/cells.h"
#include "dreampm/surface/wide.h"

namespace dreampm::surface {

/// Points of all cells within +-reach of a cell. Filled up to whole lanes with points infinitely
/// far away.
class Neighborhood {
 public:
  /// `place(i)` is the position of the grid's i-th point in cell order.
  template <class Place>
  void gather(const CellGrid& grid, const Vec3i& center, int reach, const Place& place) {
    x.clear(), y.clear(), z.clear(), who.clear();
    for (int dz = -reach; dz <= reach; ++dz)
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const std::int32_t c = grid.index.find(center + Vec3i{dx, dy, dz});
          if (c == LatticeMap::kAbsent) continue;
          const auto cell = static_cast<std::size_t>(c);
          for (std::uint32_t k = grid.first[cell]; k < grid.first[cell + 1]; ++k) add(place(k), k);
        }
    while (x.size() % kLanes != 0) add({kFar, kFar, kFar}, 0);
  }
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> who;  ///< place in cell order

 private:
  static constexpr float kFar = 1e15f;  // its square is still a finite float
  void add(const Vec3f& p, std::uint32_t k) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z), who.push_back(k); }
};

}  // namespace dreampm::surface
