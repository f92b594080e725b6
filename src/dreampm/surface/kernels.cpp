#include "dreampm/surface/kernels.h"

#include <algorithm>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/neighbours.h"

namespace dreampm::surface {

std::vector<Kernel> round_kernels(std::span<const Vec3f> points, const KernelSettings& s) {
  const float ratio = s.spacing / s.support;
  Kernel k;
  k.form = Sym3<float>::isotropic(1 / (s.support * s.support));
  k.amount = ratio * ratio * ratio / kKernelIntegral;
  std::vector<Kernel> all(points.size(), k);
  for (std::size_t i = 0; i < points.size(); ++i) all[i].centre = points[i];
  return all;
}

namespace {

/// Sum of kernel weights around k's centre, and their weighted mean offset.
struct Shift {
  float sum;
  Vec3f offset;
};
Shift shift_of(const Kernel& k, const Neighbourhood& near) {
  Lane n{}, mx{}, my{}, mz{};
  const float xy = 2 * k.form.xy, xz = 2 * k.form.xz, yz = 2 * k.form.yz;
  for (std::size_t b = 0; b < near.x.size(); b += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float dx = near.x[b + l] - k.centre.x, dy = near.y[b + l] - k.centre.y, dz = near.z[b + l] - k.centre.z;
      const float q2 =
          dx * (k.form.xx * dx + xy * dy + xz * dz) + dy * (k.form.yy * dy + yz * dz) + k.form.zz * dz * dz;
      const float t = std::max(0.0f, 1 - q2), w = t * t * t;
      n[l] += w, mx[l] += w * dx, my[l] += w * dy, mz[l] += w * dz;
    }
  const float sum = lane_sum(n);
  return {sum, Vec3f{lane_sum(mx), lane_sum(my), lane_sum(mz)} / sum};  // the particle itself counts: sum >= 1
}

}  // namespace

void correct_amounts(std::vector<Kernel>& kernels, const CellGrid& grid, const std::vector<std::uint8_t>& deep,
                     const KernelSettings&) {
  constexpr float kLeast = 0.4f, kMost = 1.6f, kSparse = 0.9f;
  parallel_ranges(grid.cells.size(), 16, [&](std::size_t begin, std::size_t end) {
    Neighbourhood near;
    for (std::size_t c = begin; c < end; ++c) {
      if (deep[c]) continue;
      near.gather(grid, grid.cells[c], 2, [&](std::uint32_t k) { return kernels[grid.order[k]].centre; });
      for (std::uint32_t i = grid.first[c]; i < grid.first[c + 1]; ++i) {
        Kernel& k = kernels[grid.order[i]];
        const Shift s = shift_of(k, near);
        const float m = std::sqrt(std::max(0.0f, dot(s.offset, k.form * s.offset)));
        const float g = std::clamp(k.amount * s.sum + 2 * m, kLeast, kMost);
        k.amount /= g < kSparse ? g * g / kSparse : g;  // sparse liquid would still fall short of one half
      }
    }
  });
}

}  // namespace dreampm::surface
