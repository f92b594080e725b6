// Stage 2; constants found by experiment on splashes, for a support of 4 spacings.
#include <algorithm>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/eigen3.h"
#include "dreampm/surface/kernels.h"
#include "dreampm/surface/neighbors.h"
#include "dreampm/surface/wide.h"

namespace dreampm::surface {
namespace {

float ramp(float x, float from, float to) { return std::clamp((x - from) / (to - from), 0.0f, 1.0f); }

/// Weighted sums over the neighbors: count, mean offset, mean square offset.
struct Moments {
  float sum;
  Vec3f mean;
  Sym3<float> square;
};
DM_WIDE Moments moments_of(const Vec3f& p, float support, const Neighborhood& near) {
  Wide n{}, mx{}, my{}, mz{}, xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
  const float scale = 1 / (support * support);
  for (std::size_t b = 0; b < near.x.size(); b += kLanes) {
    Wide dx, dy, dz;
    load(&near.x[b], dx), load(&near.y[b], dy), load(&near.z[b], dz);
    dx -= p.x, dy -= p.y, dz -= p.z;
    Wide t = 1 - scale * (dx * dx + dy * dy + dz * dz);
    t = t > 0 ? t : Wide{};
    const Wide w = t * t * t, wx = w * dx, wy = w * dy, wz = w * dz;
    n += w, mx += wx, my += wy, mz += wz;
    xx += wx * dx, yy += wy * dy, zz += wz * dz;
    xy += wx * dy, xz += wx * dz, yz += wy * dz;
  }
  const float sum = lane_sum(n), per = 1 / sum;
  return {sum,
          {lane_sum(mx) * per, lane_sum(my) * per, lane_sum(mz) * per},
          {lane_sum(xx) * per, lane_sum(yy) * per, lane_sum(zz) * per, lane_sum(xy) * per, lane_sum(xz) * per,
           lane_sum(yz) * per}};
}

/// The ellipsoid, from axes relative to those in the bulk: 0 thin, 1 as in the bulk.
void shape(Kernel& k, const Moments& m, const KernelSettings& s) {
  constexpr float kThinnest = 0.38f;
  const float bulk = s.support * s.support / 11;  // variance of the kernel along an axis
  const float reach = s.support / (4 * s.spacing);
  const float count = 1 + (m.sum - 1) / (reach * reach * reach);
  const Eigen3 e = eigen(m.square * (1 / bulk));
  std::array<float, 3> q;
  for (std::size_t a = 0; a < 3; ++a) q[a] = ramp(std::sqrt(std::max(0.0f, e.values[a])), 0.35f, 0.80f);
  // Few points say little about a shape: small clusters are round.
  float round = 1 - ramp(q[2], 0.5f, 0.9f);
  round = std::max(round, 1 - ramp(count, 2.2f, 3.5f));
  round = std::max(round, q[1] * (1 - ramp(count, 4, 8)));
  const float mean = (q[0] + q[1] + q[2]) / 3;
  for (float& v : q) v += round * (mean - v);
  // At the rim of a sheet the neighbors lie to one side: a rounder edge there.
  const Vec3f thin = e.axes.column(0), within = m.mean - thin * dot(thin, m.mean);
  const float rim = (1 - q[0]) * q[1] * ramp(length(within) / (0.26f * s.support), 0.25f, 0.85f);
  const float mid = q[1] * q[1] * (3 - 2 * q[1]);
  k.smoothing = (0.05f + 0.95f * mid) * (1 - 0.5f * rim);
  std::array<float, 3> axis;
  k.form = {};
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    axis[i] = std::min(1.0f, kThinnest * (a == 0 ? 1 + 0.5f * rim : 1) + (1 - kThinnest) * q[i]) * s.support;
    const Vec3f u = e.axes.column(a);
    k.form = k.form + symmetric_part(outer(u, u)) * (1 / (axis[i] * axis[i]));
  }
  k.amount = s.spacing * s.spacing * s.spacing / (kKernelIntegral * axis[0] * axis[1] * axis[2]);
  Vec3f move{};
  for (int a = 0; a < 2; ++a) {
    const Vec3f u = e.axes.column(a);
    move += u * (0.9f * q[2] * (1 - q[static_cast<std::size_t>(a)]) * dot(u, m.mean));
  }
  const float l = length(move), most = 0.5f * s.spacing;
  k.center += l > most ? move * (most / l) : move;
}

/// No neighbor nearer than about 0.57 of the support. A point's own images in walls do not count.
bool is_alone(const Moments& m, const Vec3f& p, const Mirrored& points, const CellGrid& grid, const Neighborhood& near,
              float support) {
  constexpr float kAlone = 0.30f, kMostImages = 8;
  if (m.sum > kMostImages + kAlone) return false;
  float sum = -1;  // less the point itself
  near.for_each([&](std::size_t i, std::size_t k) {
    if (grid.order[k] >= points.real) return;
    const float t = 1 - length2(Vec3f{near.x[i], near.y[i], near.z[i]} - p) / (support * support);
    if (t > 0) sum += t * t * t;
  });
  return sum < kAlone;
}

}  // namespace

std::vector<Kernel> fit_kernels(const Mirrored& points, const CellGrid& grid, const std::vector<std::uint8_t>& deep,
                                const KernelSettings& s) {
  const float ratio = s.spacing / s.support;
  Kernel round;
  round.form = Sym3<float>::isotropic(1 / (s.support * s.support));
  round.amount = ratio * ratio * ratio / kKernelIntegral;
  std::vector<Kernel> kernels(points.points.size(), round);
  const SortedPlaces places(grid, [&](std::uint32_t i) -> const Vec3f& { return points.points[i]; });
  parallel_ranges(grid.cells.size(), 16, [&](std::size_t begin, std::size_t end) {
    Neighborhood near;
    for (std::size_t c = begin; c < end; ++c) {
      if (!deep[c]) near.gather(grid, places, grid.cells[c], 2);
      for (std::uint32_t i = grid.first[c]; i < grid.first[c + 1]; ++i) {
        const std::size_t p = grid.order[i];
        Kernel& k = kernels[p];
        k.center = points.points[p];
        if (deep[c] || p >= points.real) continue;
        const Moments m = moments_of(k.center, s.support, near);
        if (is_alone(m, k.center, points, grid, near, s.support))
          k.amount = 0;
        else
          shape(k, m, s);
      }
    }
  });
  return kernels;
}

}  // namespace dreampm::surface
