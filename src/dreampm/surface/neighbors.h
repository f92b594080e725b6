// The points near one cell, copied together in lanes.
#pragma once
#include <cstring>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/cells.h"
#include "dreampm/surface/wide.h"

namespace dreampm::surface {

/// Places in the order of a grid's cells, so that those of a row of cells lie together.
struct SortedPlaces {
  /// `place(i)` is the position of point i.
  template <class Place>
  SortedPlaces(const CellGrid& grid, const Place& place)
      : x(grid.order.size()), y(grid.order.size()), z(grid.order.size()) {
    parallel_for(grid.order.size(), 8192, [&](std::size_t k) {
      const Vec3f& p = place(grid.order[k]);
      x[k] = p.x, y[k] = p.y, z[k] = p.z;
    });
  }
  std::vector<float> x, y, z;
};

/// Points of all cells within +-reach of a cell. Filled up to whole lanes with points infinitely
/// far away.
class Neighborhood {
 public:
  void gather(const CellGrid& grid, const SortedPlaces& places, const Vec3i& center, int reach) {
    const Vec3i r{reach, reach, reach};
    runs_.clear();
    std::size_t n = 0;
    for_rows(grid, center - r, center + r, [&](std::size_t first, std::size_t end) {
      const std::uint32_t from = grid.first[first], count = grid.first[end] - from;
      runs_.push_back({from, count});
      n += count;
    });
    const std::size_t full = (n + kLanes - 1) / kLanes * kLanes;
    x.resize(full), y.resize(full), z.resize(full);
    std::size_t at = 0;
    for (const Run& run : runs_) {
      const std::size_t bytes = run.count * sizeof(float);
      std::memcpy(&x[at], &places.x[run.from], bytes);
      std::memcpy(&y[at], &places.y[run.from], bytes);
      std::memcpy(&z[at], &places.z[run.from], bytes);
      at += run.count;
    }
    for (; at < full; ++at) x[at] = y[at] = z[at] = kFar;
  }
  /// Calls visit(i, k) for each of them: its place here and in the order of the grid.
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::size_t at = 0;
    for (const Run& run : runs_)
      for (std::uint32_t k = 0; k < run.count; ++k) visit(at++, run.from + k);
  }
  std::vector<float> x, y, z;

 private:
  static constexpr float kFar = 1e15f;  // its square is still a finite float
  struct Run {
    std::uint32_t from, count;
  };
  std::vector<Run> runs_;
};

}  // namespace dreampm::surface
