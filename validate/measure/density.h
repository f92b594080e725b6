// How dense a liquid lies inside, and how evenly its particles.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "dreampm/physics/transfer.h"
#include "validate/measure/pairs.h"
#include "validate/measure/particles.h"

namespace dreampm::validate {

/// The mean density inside set `set` over its rest density: of the cells whose 26 neighbors within
/// the walls all hold half of a full cell or more. 0 if there is no such cell.
template <class R>
double interior_density(const World<R>& w, std::size_t set = 0) {
  const Vec3i n = w.high - w.low;
  const auto index = [&](int i, int j, int k) { return static_cast<std::size_t>((i * n.y + j) * n.z + k); };
  std::vector<double> full(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) *
                           static_cast<std::size_t>(n.z));
  const double part = w.sets.at(set).rest_volume / (w.dx * w.dx * w.dx);
  each_particle(w, [&](std::size_t s, std::size_t, const Vec3d& at) {
    const Vec3d c = (at - w.origin) / w.dx;
    if (s == set && c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < n.x && c.y < n.y && c.z < n.z)
      full[index(static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z))] += part;
  });
  double sum = 0;
  int cells = 0;
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        double least = 1e30;
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, n.x - 1); ++a)
          for (int b = std::max(j - 1, 0); b <= std::min(j + 1, n.y - 1); ++b)
            for (int c = std::max(k - 1, 0); c <= std::min(k + 1, n.z - 1); ++c)
              least = std::min(least, full[index(a, b, c)]);
        if (least >= 0.5) sum += full[index(i, j, k)], ++cells;
      }
  return cells ? sum / cells : 0;
}

/// Returns the content of rows of nodes over that of full ones: the rows of height `first` to
/// `last` over the floor, each over the whole width of the domain. It is read off the grid: sheets
/// of particles that cross from box to box change nothing.
template <class R>
std::vector<double> node_rows(const World<R>& w, int first, int last) {
  std::vector<double> rows(static_cast<std::size_t>(last - first + 1), 0);
  const Vec3i n = w.high - w.low;
  each_particle(w, [&](std::size_t set, std::size_t, const Vec3d& at) {
    const Vec3d cells = (at - w.origin) / w.dx;
    const double part = w.sets[set].rest_volume / (w.dx * w.dx * w.dx) / (n.x * n.z);
    const Stencil<double> stencil = make_stencil(cells - Vec3d{0.5, 0.5, 0.5});
    for (int j = 0; j < 3; ++j)
      if (const int row = stencil.node(1) + j; row >= first && row <= last)
        rows[static_cast<std::size_t>(row - first)] += part * stencil.w[1][j];
  });
  return rows;
}

/// The largest distance from 1.
inline double farthest_off(const std::vector<double>& ratios) {
  double worst = 0;
  for (const double r : ratios) worst = std::max(worst, std::abs(r - 1));
  return worst;
}

/// The part of all particles that have a neighbor nearer than `distance` [m].
template <class R>
double clumped(const World<R>& w, double distance) {
  const auto x = positions_by_id(w);
  std::vector<char> near(x.size(), 0);
  each_pair_within(x, distance, [&](std::size_t p, std::size_t q) { near[p] = near[q] = 1; });
  return static_cast<double>(std::count(near.begin(), near.end(), 1)) / static_cast<double>(x.size());
}

}  // namespace dreampm::validate
