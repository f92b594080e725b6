#include "dreampm/surface/kernels.h"

#include <algorithm>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/neighbors.h"
#include "dreampm/surface/wide.h"

namespace dreampm::surface {

namespace {

/// Sum of kernel weights around k's center, and their weighted mean offset.
struct Shift {
  float sum;
  Vec3f offset;
};
DM_WIDE Shift shift_of(const Kernel& k, const Neighborhood& near) {
  Wide n{}, mx{}, my{}, mz{};
  const float xy = 2 * k.form.xy, xz = 2 * k.form.xz, yz = 2 * k.form.yz;
  for (std::size_t b = 0; b < near.x.size(); b += kLanes) {
    Wide dx, dy, dz;
    load(&near.x[b], dx), load(&near.y[b], dy), load(&near.z[b], dz);
    dx -= k.center.x, dy -= k.center.y, dz -= k.center.z;
    const Wide q2 = dx * (k.form.xx * dx + xy * dy + xz * dz) + dy * (k.form.yy * dy + yz * dz) + k.form.zz * dz * dz;
    Wide t = 1 - q2;
    t = t > 0 ? t : Wide{};
    const Wide w = t * t * t;
    n += w, mx += w * dx, my += w * dy, mz += w * dz;
  }
  const float sum = lane_sum(n);
  return {sum, Vec3f{lane_sum(mx), lane_sum(my), lane_sum(mz)} / sum};  // the particle itself counts: sum >= 1
}

}  // namespace

void correct_amounts(std::vector<Kernel>& kernels, std::size_t real, const CellGrid& grid,
                     const std::vector<std::uint8_t>& deep) {
  constexpr float kLeast = 0.4f, kMost = 1.6f, kSparse = 0.9f;
  const SortedPlaces places(grid, [&](std::uint32_t i) -> const Vec3f& { return kernels[i].center; });
  parallel_ranges(grid.cells.size(), 16, [&](std::size_t begin, std::size_t end) {
    Neighborhood near;
    for (std::size_t c = begin; c < end; ++c) {
      if (deep[c]) continue;
      near.gather(grid, places, grid.cells[c], 2);
      for (std::uint32_t i = grid.first[c]; i < grid.first[c + 1]; ++i) {
        Kernel& k = kernels[grid.order[i]];
        if (grid.order[i] >= real || is_single(k)) continue;
        const Shift s = shift_of(k, near);
        const float m = std::sqrt(std::max(0.0f, dot(s.offset, k.form * s.offset)));
        const float g = std::clamp(k.amount * s.sum + 2 * m, kLeast, kMost);
        k.amount /= g < kSparse ? g * g / kSparse : g;  // sparse liquid would still fall short of one half
      }
    }
  });
}

void mirror_kernels(std::vector<Kernel>& kernels, const Mirrored& points) {
  parallel_for(kernels.size() - points.real, 4096, [&](std::size_t n) {
    const std::size_t i = points.real + n, from = points.source[i];
    const unsigned flip = points.flipped[i];
    const auto sign = [&](unsigned axes) { return (flip & axes) == 0 || (flip & axes) == axes ? 1.0f : -1.0f; };
    const auto turned = [&](unsigned axis) { return (flip & axis) == 0 ? 1.0f : -1.0f; };
    Kernel k = kernels[from];
    k.form.xy *= sign(3), k.form.xz *= sign(5), k.form.yz *= sign(6);
    k.center = points.points[i] + (k.center - points.points[from]) * Vec3f{turned(1), turned(2), turned(4)};
    kernels[i] = k;
  });
}

}  // namespace dreampm::surface
