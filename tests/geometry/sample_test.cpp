#include "dreampm/geometry/sample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"

using namespace dreampm;

namespace {

std::shared_ptr<const Region> make(auto form, Vec3d center = {}) {
  Shape s;
  s.form = form, s.center = center;
  return make_region(s, 0.01, {});
}

double nearest_pair(const std::vector<Vec3d>& points, double reach) {
  std::map<std::tuple<int, int, int>, std::vector<Vec3d>> cells;
  auto key = [&](const Vec3d& p, int i, int j, int k) {
    return std::tuple(int(std::floor(p.x / reach)) + i, int(std::floor(p.y / reach)) + j,
                      int(std::floor(p.z / reach)) + k);
  };
  double best = reach;
  for (const Vec3d& p : points) {
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k)
          if (const auto it = cells.find(key(p, i, j, k)); it != cells.end())
            for (const Vec3d& q : it->second) best = std::min(best, length(p - q));
    cells[key(p, 0, 0, 0)].push_back(p);
  }
  return best;
}

TEST(Sample, FillsABoxFlush) {
  const auto points = sample_region(*make(BoxShape{{1, 0.5, 0.3}}, {0.5, 0.25, 0.15}), 0.1, Pattern::lattice, 1);
  ASSERT_EQ(points.size(), 150u);
  Box3d box;
  for (const Vec3d& p : points) box.add(p);
  EXPECT_NEAR(box.min.x, 0.05, 1e-12);
  EXPECT_NEAR(box.max.y, 0.45, 1e-12);
  EXPECT_EQ(sample_region(*make(BoxShape{{1, 0.5, 0.3}}), 0.1, Pattern::jitter, 1).size(), 150u);
}

TEST(Sample, BallHasItsVolumeAndNoPointOutsideOrTooNear) {
  const auto ball = make(SphereShape{0.5});
  for (const Pattern pattern : {Pattern::lattice, Pattern::jitter}) {
    const double h = 0.02;
    const auto points = sample_region(*ball, h, pattern, 7);
    EXPECT_NEAR(double(points.size()) * h * h * h, std::numbers::pi / 6, 0.005 * std::numbers::pi / 6);
    for (const Vec3d& p : points) ASSERT_LT(ball->distance(p), 0);
    EXPECT_GE(nearest_pair(points, h), (pattern == Pattern::lattice ? 1 - 1e-9 : 0.5) * h);
  }
}

TEST(Sample, PoissonPointsKeepTheirDistanceAndLeaveNoRoom) {
  // Two tiles of 24 spacings across, so that seams are seen.
  const double h = 0.02;
  const auto ball = make(SphereShape{0.5});
  const auto points = sample_region(*ball, h, Pattern::poisson, 7);
  const double volume = std::numbers::pi / 6;
  EXPECT_NEAR(double(points.size()) * h * h * h, volume, 0.005 * volume);
  for (const Vec3d& p : points) ASSERT_LT(ball->distance(p), 0);
  const double nearest = nearest_pair(points, 1.5 * h) / h;
  EXPECT_GE(nearest, 0.89);
  // Saturated random packings keep 0.902 spacings apart; the tile's own count decides the last
  // percent.
  EXPECT_NEAR(nearest, 0.902, 0.01);

  // Wherever in the ball: a point nearer than that distance.
  std::map<std::tuple<int, int, int>, std::vector<Vec3d>> cells;
  const double reach = 0.93 * h;
  const auto cell = [&](const Vec3d& p, int a) { return int(std::floor(p[a] / reach)); };
  for (const Vec3d& p : points) cells[{cell(p, 0), cell(p, 1), cell(p, 2)}].push_back(p);
  int probes = 0, empty = 0;
  double farthest = 0;
  for (std::uint64_t i = 0; probes < 20000; ++i) {
    const Vec3d p{uniform(5, 3 * i) - 0.5, uniform(5, 3 * i + 1) - 0.5, uniform(5, 3 * i + 2) - 0.5};
    if (ball->distance(p) > -reach) continue;
    ++probes;
    double near = 2 * reach;
    for (int n = 0; n < 27; ++n)
      if (const auto it = cells.find({cell(p, 0) + n / 9 - 1, cell(p, 1) + n / 3 % 3 - 1, cell(p, 2) + n % 3 - 1});
          it != cells.end())
        for (const Vec3d& q : it->second) near = std::min(near, length(p - q));
    farthest = std::max(farthest, near);
    empty += near > nearest * h * (1 + 1e-3);
  }
  EXPECT_EQ(empty, 0) << farthest / h;
}

TEST(Sample, PoissonPreferNoDirection) {
  const double h = 0.05;
  const auto points = sample_region(*make(BoxShape{{1, 1, 1}}), h, Pattern::poisson, 3);
  EXPECT_NEAR(double(points.size()), 8000, 80);
  // Directions to neighbors within 1.5 spacings: second moments of 1/3 and 0, fourth moments of
  // 1/5.
  Vec3d second, mixed, fourth;
  double n = 0;
  const Box3d inner{{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}};
  for (const Vec3d& p : points) {
    if (!inner.contains(p)) continue;
    for (const Vec3d& q : points) {
      const Vec3d d = q - p;
      const double l2 = length2(d);
      if (l2 == 0 || l2 > 2.25 * h * h) continue;
      const Vec3d e = d / std::sqrt(l2), e2 = e * e;
      second += e2, mixed += Vec3d{e.x * e.y, e.y * e.z, e.z * e.x}, fourth += e2 * e2;
      n += 1;
    }
  }
  // 30,000 pairs or more: chance is below 1/sqrt(30000) = 0.006 of unit variance.
  EXPECT_GT(n, 30000);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(second[a] / n, 1.0 / 3, 0.006);
    EXPECT_NEAR(mixed[a] / n, 0, 0.006);
    EXPECT_NEAR(fourth[a] / n, 1.0 / 5, 0.006);
  }
}

TEST(Sample, JitterIsIsotropicAndSeeded) {
  const auto box = make(BoxShape{{1, 1, 1}});
  const auto plain = sample_region(*box, 0.05, Pattern::lattice, 0), a = sample_region(*box, 0.05, Pattern::jitter, 1),
             b = sample_region(*box, 0.05, Pattern::jitter, 2);
  ASSERT_EQ(plain.size(), a.size());
  EXPECT_NE(a[0], b[0]);
  Vec3d mean, square;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec3d d = (a[i] - plain[i]) / 0.05;
    mean += d / double(a.size()), square += d * d / double(a.size());
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k], 0, 0.008);
    EXPECT_NEAR(square[k], 0.25 / 12, 0.001);  // uniform in +-1/4
  }
}

TEST(Sample, SameForEveryThreadCountAndMovedWithTheRegion) {
  const auto ball = make(SphereShape{0.5});
  for (const Pattern pattern : {Pattern::jitter, Pattern::poisson}) {
    const auto all = sample_region(*ball, 0.1, pattern, 3);
    {
      const ThreadLimit one(1);
      EXPECT_EQ(sample_region(*ball, 0.1, pattern, 3), all);
    }
    EXPECT_NE(sample_region(*ball, 0.1, pattern, 4), all);
    const auto moved = sample_region(*make(SphereShape{0.5}, {8, 0, -4}), 0.1, pattern, 3);
    ASSERT_EQ(moved.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_LT(length(moved[i] - all[i] - Vec3d{8, 0, -4}), 1e-12);
  }
}

TEST(Sample, RefusesTheUnboundedAndTheAbsurd) {
  EXPECT_THROW(sample_region(*make(PlaneShape{}), 0.1, Pattern::lattice, 0), InputError);
  EXPECT_THROW(sample_region(*make(SphereShape{1}), 1e-9, Pattern::lattice, 0), InputError);
  EXPECT_THROW(sample_region(*make(SphereShape{1}), 0, Pattern::lattice, 0), InputError);
}

}  // namespace
