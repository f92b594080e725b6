// Particles near each other: pairs, and the pieces that they make up.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "dreampm/base/hash.h"
#include "dreampm/math/vec.h"

namespace dreampm::validate {

/// Calls body(p, q), p < q, for every two points nearer to each other than `distance` [m].
template <class Body>
void each_pair_within(const std::vector<Vec3d>& x, double distance, const Body& body) {
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
  const auto cell = [&](const Vec3d& p, int a) { return static_cast<std::int64_t>(std::floor(p[a] / distance)); };
  const auto key = [](std::int64_t i, std::int64_t j, std::int64_t k) {
    return mix64(mix64(mix64(static_cast<std::uint64_t>(i)) ^ static_cast<std::uint64_t>(j)) ^
                 static_cast<std::uint64_t>(k));
  };
  // A cell holds only points before p: of each pair the later one finds the other.
  for (std::size_t p = 0; p < x.size(); ++p) {
    const std::int64_t at[3] = {cell(x[p], 0), cell(x[p], 1), cell(x[p], 2)};
    for (int n = 0; n < 27; ++n) {
      const auto there = cells.find(key(at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1));
      if (there == cells.end()) continue;
      for (const std::size_t q : there->second)
        if (length2(x[q] - x[p]) < distance * distance) body(q, p);
    }
    cells[key(at[0], at[1], at[2])].push_back(p);
  }
}

/// Returns the numbers of points of the pieces, the largest first: two points nearer than
/// `distance` [m] are of one piece.
inline std::vector<std::size_t> pieces(const std::vector<Vec3d>& x, double distance) {
  std::vector<std::size_t> next(x.size());  // towards the piece's first point
  std::iota(next.begin(), next.end(), std::size_t{0});
  const auto first = [&](std::size_t p) {
    for (; next[p] != p; p = next[p]) next[p] = next[next[p]];
    return p;
  };
  each_pair_within(x, distance, [&](std::size_t p, std::size_t q) { next[first(q)] = first(p); });
  std::vector<std::size_t> size(x.size(), 0);
  for (std::size_t p = 0; p < x.size(); ++p) ++size[first(p)];
  std::sort(size.rbegin(), size.rend());
  size.erase(std::find(size.begin(), size.end(), std::size_t{0}), size.end());
  return size;
}

}  // namespace dreampm::validate
