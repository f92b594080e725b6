// The volume that a liquid takes, from where its particles lie.
#pragma once
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::validate {

/// The volume [m^3] of a liquid on a flat floor of the box `low` to `high` [m], Y up: in each
/// column of about `width` [m] twice the mean height of its particles over the floor is the height
/// that they fill evenly. Exact for a surface that is flat, or bends over longer distances than a
/// column is wide. A column without particles holds nothing. Throws std::invalid_argument for a
/// particle outside of the box's sides.
inline double volume_by_columns(const std::vector<Vec3d>& positions, const Vec3d& low, const Vec3d& high,
                                double width) {
  const auto count = [&](int a) { return std::max(1, static_cast<int>(std::lround((high[a] - low[a]) / width))); };
  const int nx = count(0), nz = count(2);
  const auto place = [&](const Vec3d& p, int a, int n) {
    const double share = (p[a] - low[a]) / (high[a] - low[a]);
    if (!(share >= 0 && share <= 1)) throw std::invalid_argument("a particle outside of the columns");
    return std::min(n - 1, static_cast<int>(share * n));
  };
  struct Column {
    double sum = 0;
    int particles = 0;
  };
  std::vector<Column> columns(static_cast<std::size_t>(nx * nz));
  for (const Vec3d& p : positions) {
    Column& c = columns[static_cast<std::size_t>(place(p, 0, nx) * nz + place(p, 2, nz))];
    c.sum += p.y - low.y, ++c.particles;
  }
  double height = 0;
  for (const Column& c : columns)
    if (c.particles) height += 2 * c.sum / c.particles;
  return height * (high.x - low.x) * (high.z - low.z) / (nx * nz);
}

}  // namespace dreampm::validate
