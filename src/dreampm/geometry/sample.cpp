#include "dreampm/geometry/sample.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"

namespace dreampm {

std::vector<Vec3d> sample_region(const Region& region, double spacing, Pattern pattern, std::uint64_t seed) {
  if (!(spacing > 0) || !std::isfinite(spacing)) fail_input("a spacing of {} m: a length above 0 is wanted", spacing);
  const Box3d box = region.bounds();
  if (box.empty()) return {};
  if (!is_finite(box.min) || !is_finite(box.max)) fail_input("an unbounded shape cannot be filled with particles");
  const Vec3d size = box.size(), centre = box.center();
  std::uint64_t n[3];
  double cells = 1;
  for (int i = 0; i < 3; ++i) {
    // Rounded: a box of 10.4 spacings gets 10 layers, one of 10.6 gets 11, and even jittered points stay inside it.
    const double count = std::max(1.0, std::round(size[i] / spacing));
    cells *= count;
    if (!(cells <= 0x1p36))
      fail_input("a spacing of {} m is too fine for a shape of {} x {} x {} m", spacing, size.x, size.y, size.z);
    n[i] = static_cast<std::uint64_t>(count);
  }
  const Vec3d low = Vec3d{double(n[0]), double(n[1]), double(n[2])} * -0.5;
  std::vector<std::vector<Vec3d>> slices(n[2]);
  parallel_for(n[2], 1, [&](std::size_t k) {
    for (std::uint64_t j = 0; j < n[1]; ++j)
      for (std::uint64_t i = 0; i < n[0]; ++i) {
        Vec3d cell = low + Vec3d{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5};
        if (pattern == Pattern::jitter) {
          const std::uint64_t index = 3 * ((k * n[1] + j) * n[0] + i);
          // +-1/4 of a cell: neighbours keep half a spacing even when they meet head on
          for (int a = 0; a < 3; ++a) cell[a] += 0.5 * uniform(seed, index + static_cast<std::uint64_t>(a)) - 0.25;
        }
        const Vec3d p = centre + cell * spacing;
        if (region.distance(p) < 0) slices[k].push_back(p);
      }
  });
  std::size_t total = 0;
  for (const auto& s : slices) total += s.size();
  std::vector<Vec3d> points;
  points.reserve(total);
  for (const auto& s : slices) points.insert(points.end(), s.begin(), s.end());
  return points;
}

}  // namespace dreampm
