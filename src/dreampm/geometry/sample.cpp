#include "dreampm/geometry/sample.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/poisson.h"
#include "dreampm/math/rng.h"

namespace dreampm {

namespace {

using Pieces = std::vector<std::vector<Vec3d>>;

/// Lattice and jitter, by slices of n[0] x n[1] cells.
Pieces fill_cells(const Region& region, double spacing, const std::uint64_t n[3], bool jitter, std::uint64_t seed) {
  const Vec3d center = region.bounds().center();
  const Vec3d low = Vec3d{double(n[0]), double(n[1]), double(n[2])} * -0.5;
  std::vector<std::vector<Vec3d>> slices(n[2]);
  parallel_for(n[2], 1, [&](std::size_t k) {
    for (std::uint64_t j = 0; j < n[1]; ++j)
      for (std::uint64_t i = 0; i < n[0]; ++i) {
        Vec3d cell = low + Vec3d{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5};
        if (jitter) {
          const std::uint64_t index = 3 * ((k * n[1] + j) * n[0] + i);
          // +-1/4 of a cell: neighbors keep half a spacing even when they meet head on
          for (int a = 0; a < 3; ++a) cell[a] += 0.5 * uniform(seed, index + static_cast<std::uint64_t>(a)) - 0.25;
        }
        const Vec3d p = center + cell * spacing;
        if (region.distance(p) < 0) slices[k].push_back(p);
      }
  });
  return slices;
}

/// Copies of a tile side by side, in pieces of a tile.
Pieces fill_tiles(const Region& region, double spacing, std::uint64_t seed) {
  constexpr int least_side = 6, most_side = 24;
  constexpr std::size_t piece = 2048;
  const Box3d box = region.bounds();
  const Vec3d half = box.size() * 0.5, center = box.center();
  const double longest = 2 * std::max({half.x, half.y, half.z}) / spacing;
  const PoissonTile tile =
      poisson_tile(static_cast<int>(std::clamp(std::ceil(longest) + 1, double(least_side), double(most_side))), seed);
  // The cube is as large as its points are many: a spacing^3 each.
  const double side = std::cbrt(static_cast<double>(tile.points.size())) * spacing;
  std::int64_t reach[3];  // tiles lie centered on the region: numbers -reach .. reach
  for (int a = 0; a < 3; ++a) reach[a] = static_cast<std::int64_t>(std::ceil(std::max(0.0, half[a] / side - 0.5)));
  const auto across = [&](int a) { return static_cast<std::size_t>(2 * reach[a] + 1); };
  const std::size_t pieces = (tile.points.size() + piece - 1) / piece;
  Pieces found(across(0) * across(1) * across(2) * pieces);
  parallel_for(found.size(), 1, [&](std::size_t job) {
    const std::size_t first = job % pieces * piece, t = job / pieces;
    const Vec3d corner{double(std::int64_t(t % across(0)) - reach[0]) - 0.5,
                       double(std::int64_t(t / across(0) % across(1)) - reach[1]) - 0.5,
                       double(std::int64_t(t / across(0) / across(1)) - reach[2]) - 0.5};
    for (std::size_t i = first; i < std::min(first + piece, tile.points.size()); ++i) {
      const Vec3d p = center + (corner + tile.points[i]) * side;
      if (box.contains(p) && region.distance(p) < 0) found[job].push_back(p);
    }
  });
  return found;
}

}  // namespace

std::vector<Vec3d> sample_region(const Region& region, double spacing, Pattern pattern, std::uint64_t seed) {
  if (!(spacing > 0) || !std::isfinite(spacing)) fail_input("a spacing of {} m: a length above 0 is wanted", spacing);
  const Box3d box = region.bounds();
  if (box.empty()) return {};
  if (!is_finite(box.min) || !is_finite(box.max)) fail_input("an unbounded shape cannot be filled with particles");
  const Vec3d size = box.size();
  std::uint64_t n[3];
  double cells = 1;
  for (int i = 0; i < 3; ++i) {
    // Rounded: a box of 10.4 spacings gets 10 layers, one of 10.6 gets 11, and even jittered points
    // stay inside it.
    const double count = std::max(1.0, std::round(size[i] / spacing));
    cells *= count;
    if (!(cells <= 0x1p36))
      fail_input("a spacing of {} m is too fine for a shape of {} x {} x {} m", spacing, size.x, size.y, size.z);
    n[i] = static_cast<std::uint64_t>(count);
  }
  const Pieces slices = pattern == Pattern::poisson ? fill_tiles(region, spacing, seed)
                                                    : fill_cells(region, spacing, n, pattern == Pattern::jitter, seed);
  std::size_t total = 0;
  for (const auto& s : slices) total += s.size();
  std::vector<Vec3d> points;
  points.reserve(total);
  for (const auto& s : slices) points.insert(points.end(), s.begin(), s.end());
  return points;
}

}  // namespace dreampm
