// Where the surface meets colliders: on them, or a chosen depth inside.
#include "dreampm/surface/solids.h"

#include <gtest/gtest.h>

#include "clouds.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/region.h"
#include "dreampm/surface/surface.h"

namespace dreampm {
namespace {

using test::lattice;
using test::topology;

constexpr float kH = 0.01f;
constexpr float kDepth = 0.5f * kH;

WettedSolid solid(const Shape& shape, const Pose& pose = {}) { return {make_region(shape, 0.01, {}), pose}; }

double particles_volume(std::size_t n) { return static_cast<double>(n) * static_cast<double>(kH) * kH * kH; }

/// Liquid up to `level` in a basin around the solids.
struct Tank {
  Vec3f size{0.3f, 0.3f, 0.3f};
  std::vector<WettedSolid> solids;
  std::vector<Vec3f> points;

  Tank(std::vector<WettedSolid> in, float level, float jitter = 0.35f) : solids(std::move(in)) {
    const surface::Solids all(solids, {}, 3 * kH);
    points = lattice(kH, size, [&](const Vec3f& p) { return p.y < level && all.distance(p) > 0; }, jitter);
  }
  SurfaceInput input() const {
    SurfaceInput in{.positions = points,
                    .spacing = kH,
                    .walls = {{0, 0, 0}, size},
                    .is_wall = {true, true, true, false, true, true}};
    in.solids = solids;
    return in;
  }
  SurfaceResult wrapped(float overlap) const {
    SurfaceSettings settings;
    settings.overlap = overlap;
    return reconstruct(input(), settings);
  }
};

/// Vertices of the mesh by their distance to the solids.
struct Contact {
  std::size_t on = 0;       ///< within the tolerance at the wanted distance
  std::size_t between = 0;  ///< before the solids, but within half a spacing: a film of air
  std::size_t beyond = 0;   ///< deeper
};
Contact contact(const TriMesh& mesh, const std::vector<WettedSolid>& solids, float depth) {
  const surface::Solids all(solids, {}, 3 * kH);
  Contact c;
  for (const Vec3f& v : mesh.vertices) {
    const float d = all.distance(v) + depth;
    if (d < -0.1f * kH)
      ++c.beyond;
    else if (d < 0.1f * kH)
      ++c.on;
    else if (all.distance(v) < 0.5f * kH && all.distance(v) > (depth > 0 ? -0.05f * kH : 0))
      ++c.between;
  }
  return c;
}

TEST(Solids, ManyDistancesAtOnceHaveTheBitsOfOne) {
  const Pose turned{{0.02, 0.01, 0}, Quaternion::about({0.3, 0.2, 0.1})};
  const std::vector<WettedSolid> solids{solid(Shape::sphere({0.1, 0.1, 0.1}, 0.05)),
                                        solid(Shape::box({0.2, 0, 0.1}, {0.25, 0.2, 0.2}), turned)};
  const surface::Solids all(solids, {}, 3 * kH), first({&solids[0], 1}, {}, 3 * kH),
      second({&solids[1], 1}, {}, 3 * kH);
  std::vector<Vec3f> points;
  for (int n = 0; n < 1000; ++n)
    points.push_back(Vec3f{static_cast<float>(n % 10), static_cast<float>(n / 10 % 10), static_cast<float>(n / 100)} *
                     0.03f);
  std::vector<float> found(points.size());
  all.distances(points, found.data());
  std::size_t near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(found[i], all.distance(points[i]));
    EXPECT_EQ(found[i], std::min(first.distance(points[i]), second.distance(points[i])));
    near += found[i] < all.reach();
  }
  EXPECT_GT(near, 50u);
  EXPECT_LT(near, 950u);
}

TEST(Solids, LiquidAroundABallLiesOnIt) {
  const Tank tank({solid(Shape::sphere({0.15, 0.12, 0.15}, 0.06))}, 0.25f);
  for (const float overlap : {0.0f, 0.5f}) {
    const SurfaceResult r = tank.wrapped(overlap);
    const auto t = topology(r.mesh);
    EXPECT_TRUE(t.closed());
    EXPECT_EQ(t.components, 2u) << "the surface of the liquid, and that of the ball in it";
    EXPECT_NEAR(r.volume / particles_volume(tank.points.size()), 1, 0.01) << "that of the liquid alone";
    const Contact c = contact(r.mesh, tank.solids, overlap * kH);
    EXPECT_GT(c.on, 1000u);
    EXPECT_EQ(c.between, 0u);
    EXPECT_EQ(c.beyond, 0u);
  }
}

TEST(Solids, LiquidFillsTheCornersOfAHollowBlock) {
  const Shape block =
      Shape::box({0.05, 0.02, 0.05}, {0.25, 0.2, 0.25}) - Shape::box({0.08, 0.05, 0.08}, {0.22, 0.3, 0.22});
  const Tank tank({solid(block)}, 0.15f);
  std::vector<Vec3f> inside;
  for (const Vec3f& p : tank.points)
    if (p.x > 0.07f && p.x < 0.23f && p.z > 0.07f && p.z < 0.23f && p.y > 0.04f) inside.push_back(p);
  SurfaceInput input = tank.input();
  input.positions = inside;
  SurfaceSettings settings;
  settings.overlap = 0.5f;
  const SurfaceResult r = reconstruct(input, settings);
  EXPECT_TRUE(topology(r.mesh).closed());
  EXPECT_NEAR(r.volume / particles_volume(inside.size()), 1, 0.02);
  // Rays from the middle of the liquid meet the glass before they leave the mesh, the corners too.
  const surface::Solids all(tank.solids, {}, 3 * kH);
  for (const Vec3f& corner : {Vec3f{0.08f, 0.05f, 0.08f},
                              {0.22f, 0.05f, 0.08f},
                              {0.08f, 0.05f, 0.22f},
                              {0.22f, 0.1f, 0.22f},
                              {0.08f, 0.05f, 0.15f},
                              {0.15f, 0.05f, 0.22f}}) {
    float nearest = 1;
    for (const Vec3f& v : r.mesh.vertices)
      if (all.distance(v) > -0.02f * kH && v.y < 0.13f) nearest = std::min(nearest, length(v - corner));
    EXPECT_GT(nearest, 0.5f * kH) << corner.x << " " << corner.y << " " << corner.z;
  }
}

TEST(Solids, TheRimIsLevelWhereWaterMeetsGlass) {
  constexpr float kLevel = 0.15f;
  const Tank tank({solid(Shape::cylinder({0.15, 0.15, 0.15}, 0.05, 0.4))}, kLevel);
  const SurfaceResult r = tank.wrapped(0.5f);
  std::size_t rim = 0;
  const surface::Solids all(tank.solids, {}, 3 * kH);
  for (std::size_t v = 0; v < r.mesh.vertices.size(); ++v) {
    const Vec3f p = r.mesh.vertices[v];
    const float d = all.distance(p);
    if (d > kH || r.mesh.normals[v].y < 0.7f || p.y < kLevel - 2 * kH) continue;
    ++rim;
    EXPECT_NEAR(p.y, kLevel, 0.4f * kH);
  }
  EXPECT_GT(rim, 50u);
}

TEST(Solids, ConvexEdgesAreEnteredAsFar) {
  // Near an edge the way against the normal of one face runs along the other.
  const Pose turned{{0.15, 0.13, 0.15}, Quaternion::about({0.3, 0.5, 0.2})};
  const Tank tank({solid(Shape::box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}), turned)}, 0.25f);
  const surface::Solids all(tank.solids, {}, 3 * kH);
  std::size_t faces = 0;
  const TriMesh mesh = tank.wrapped(0.5f).mesh;
  for (const auto& t : mesh.triangles) {
    const Vec3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (all.distance(a) > 0) continue;
    ++faces;
    for (const Vec3f& p : {a, (a + b) / 2.0f, (a + b + c) / 3.0f}) EXPECT_NEAR(all.distance(p), -kDepth, 0.1f * kH);
  }
  EXPECT_GT(faces, 4000u);
}

TEST(Solids, AThinPlateIsNotPierced) {
  // 8 mm, and an overlap of 5 from either side.
  const Tank tank({solid(Shape::box({0.146, -0.1, -0.1}, {0.154, 0.4, 0.4}))}, 0.15f);
  const SurfaceResult r = tank.wrapped(0.5f);
  EXPECT_TRUE(topology(r.mesh).closed());
  EXPECT_EQ(topology(r.mesh).components, 2u);
  std::size_t deep = 0;
  for (const Vec3f& v : r.mesh.vertices) {
    if (v.x > 0.146f && v.x < 0.154f) ++deep;
    ASSERT_GT(std::abs(v.x - 0.15f), 0.5e-3f) << "the two sides do not meet";
  }
  EXPECT_GT(deep, 500u);
}

TEST(Solids, ASolidThatStandsElsewhereIsMetThere) {
  const Pose pose{{0.15, 0.1, 0.15}, Quaternion::about({0.3, 0.2, 0.5})};
  const Tank tank({solid(Shape::box({-0.05, -0.04, -0.06}, {0.05, 0.04, 0.06}), pose)}, 0.25f);
  Contact c = contact(tank.wrapped(0.5f).mesh, tank.solids, kDepth);
  EXPECT_GT(c.on, 1000u);
  EXPECT_EQ(c.between, 0u);  // beside its edges it is entered less deep
  // The same counted from elsewhere.
  SurfaceInput moved = tank.input();
  std::vector<Vec3f> points = tank.points;
  const Vec3f by{4, 5, 6};
  for (Vec3f& p : points) p -= by;
  moved.positions = points;
  moved.walls = {moved.walls.min - by, moved.walls.max - by};
  moved.origin = Vec3d(by);
  SurfaceSettings settings;
  settings.overlap = 0.5f;
  TriMesh mesh = reconstruct(moved, settings).mesh;
  for (Vec3f& v : mesh.vertices) v += by;
  EXPECT_NEAR(static_cast<double>(contact(mesh, tank.solids, kDepth).on), static_cast<double>(c.on),
              0.05 * static_cast<double>(c.on));
}

TEST(Solids, ASmallDropLiesFlatOnABall) {
  const Vec3f middle{0.15f, 0.12f, 0.15f};
  const std::vector<WettedSolid> solids{solid(Shape::sphere(Vec3d(middle), 0.06))};
  const Vec3f out = normalized(Vec3f{1, 2, -1});
  const std::vector<Vec3f> points{middle + out * 0.063f};
  SurfaceInput in{.positions = points, .spacing = kH};
  in.solids = solids;
  for (const float overlap : {0.0f, 0.5f}) {
    SurfaceSettings settings;
    settings.overlap = overlap;
    const SurfaceResult r = reconstruct(in, settings);
    EXPECT_TRUE(topology(r.mesh).closed());
    EXPECT_NEAR(r.volume, particles_volume(1), 1e-9);
    float deepest = 1, highest = -1;
    for (const Vec3f& v : r.mesh.vertices) {
      const float d = length(v - middle) - 0.06f;
      deepest = std::min(deepest, d), highest = std::max(highest, d);
    }
    EXPECT_NEAR(deepest, -overlap * kH, 0.05f * kH);
    EXPECT_LT(highest, 0.6f * kH);
    EXPECT_GT(highest, 0.3f * kH);
  }
}

TEST(Solids, WallsAreEnteredAsFar) {
  const Vec3f size{0.2f, 0.2f, 0.2f};
  const auto points = lattice(kH, size, [](const Vec3f& p) { return p.y < 0.1f; });
  SurfaceInput in{
      .positions = points, .spacing = kH, .walls = {{0, 0, 0}, size}, .is_wall = {true, true, true, false, true, true}};
  SurfaceSettings settings;
  const SurfaceResult flush = reconstruct(in, settings);
  settings.overlap = 0.5f;
  const SurfaceResult deep = reconstruct(in, settings);
  EXPECT_EQ(deep.volume, flush.volume) << "that of the liquid";
  ASSERT_EQ(deep.mesh.vertices.size(), flush.mesh.vertices.size());
  EXPECT_TRUE(deep.mesh.triangles == flush.mesh.triangles);
  for (std::size_t v = 0; v < flush.mesh.vertices.size(); ++v) {
    const Vec3f p = flush.mesh.vertices[v], q = deep.mesh.vertices[v];
    for (int a : {0, 2}) {
      const float off = p[a] == 0 ? -kDepth : p[a] == size[a] ? kDepth : 0;
      ASSERT_NEAR(q[a], p[a] + off, off == 0 ? 0.2f * kDepth : 1e-6f);
    }
    if (p.y == 0) {
      ASSERT_NEAR(q.y, -kDepth, 1e-6f);
    } else if (p.y > 0.09f && flush.mesh.normals[v].y > 0.9f) {
      ASSERT_NEAR(q.y, p.y, 0.3f * kDepth) << "the level is the same";
    }
  }
}

TEST(Solids, SameBytesForAnyNumberOfThreads) {
  const Tank tank(
      {solid(Shape::sphere({0.15, 0.12, 0.15}, 0.06)), solid(Shape::cylinder({0.06, 0.1, 0.06}, 0.02, 0.4))}, 0.14f);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return tank.wrapped(0.5f).mesh;
  };
  const TriMesh one = with(1), three = with(3);
  EXPECT_TRUE(one.vertices == three.vertices);
  EXPECT_TRUE(one.triangles == three.triangles);
  EXPECT_TRUE(one.normals == three.normals);
}

TEST(Solids, AnOverlapOutOfRangeIsRefused) {
  const std::vector<Vec3f> one{{0, 0, 0}};
  SurfaceSettings settings;
  for (const float overlap : {-0.1f, 1.5f, NAN}) {
    settings.overlap = overlap;
    EXPECT_THROW(reconstruct({.positions = one, .spacing = kH}, settings), InputError);
  }
}

}  // namespace
}  // namespace dreampm
