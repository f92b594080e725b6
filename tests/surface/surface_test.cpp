#include "dreampm/surface/surface.h"
#include "dreampm/geometry/nearest_on_triangle.h"

#include <gtest/gtest.h>

#include "clouds.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

using test::lattice;
using test::topology;

constexpr float kH = 0.01f;

double particles_volume(const std::vector<Vec3f>& points) {
  return static_cast<double>(points.size()) * static_cast<double>(kH) * kH * kH;
}
bool everything(const Vec3f&) { return true; }

/// A basin, open above, with liquid standing in it.
SurfaceInput in_basin(const std::vector<Vec3f>& points, const Vec3f& size) {
  return {
      .positions = points, .spacing = kH, .walls = {{0, 0, 0}, size}, .is_wall = {true, true, true, false, true, true}};
}
/// Deep water, a wave on it, drops above and a jet: about 9000 particles.
std::vector<Vec3f> splash() {
  auto points = lattice(kH, {0.3f, 0.3f, 0.2f}, [](const Vec3f& p) {
    const float wave = 0.08f + 0.03f * std::sin(25 * p.x) * std::cos(18 * p.z);
    const Vec3f jet = p - Vec3f{0.15f, p.y, 0.1f};
    return p.y < wave || (p.y < 0.22f && length(jet) < 0.018f) || (p.y > 0.25f && p.y < 0.27f && p.x < 0.1f);
  });
  for (std::uint64_t i = 0; i < 300; ++i)
    points.push_back({0.3f * static_cast<float>(uniform(7, 3 * i)),
                      0.12f + 0.18f * static_cast<float>(uniform(7, 3 * i + 1)),
                      0.2f * static_cast<float>(uniform(7, 3 * i + 2))});
  return points;
}

TEST(Surface, NoParticlesGiveAnEmptyMesh) {
  const SurfaceResult r = reconstruct({.spacing = kH});
  EXPECT_TRUE(r.mesh.vertices.empty());
  EXPECT_TRUE(r.mesh.triangles.empty());
  EXPECT_EQ(r.volume, 0);
}

TEST(Surface, LiquidFillingABoxHasItsVolumeAndLiesOnTheWalls) {
  const Vec3f size{0.3f, 0.2f, 0.25f};
  const auto points = lattice(kH, size, everything);
  SurfaceInput input = in_basin(points, size);
  input.is_wall[3] = true;
  const SurfaceResult r = reconstruct(input);
  const auto t = topology(r.mesh);
  EXPECT_TRUE(t.closed()) << t.open_edges << " " << t.broken_fans;
  EXPECT_EQ(t.components, 1u);
  EXPECT_NEAR(r.volume / particles_volume(points), 1, 0.001);  // a box with sharp edges
  for (std::size_t v = 0; v < r.mesh.vertices.size(); ++v) {
    const Vec3f p = r.mesh.vertices[v];
    int walls = 0;
    for (int a = 0; a < 3; ++a) walls += p[a] == 0 || p[a] == size[a];
    ASSERT_GE(walls, 1) << p.x << " " << p.y << " " << p.z;
    if (walls == 1)
      for (int a = 0; a < 3; ++a) {
        const float outward = p[a] == 0 ? -1.0f : p[a] == size[a] ? 1.0f : 0.0f;
        ASSERT_EQ(r.mesh.normals[v][a], outward);
      }
  }
}

TEST(Surface, WaterInABasinIsLevelAndMeetsTheWalls) {
  const Vec3f size{0.3f, 0.3f, 0.25f};
  constexpr float kLevel = 0.12f;
  const auto points = lattice(kH, size, [](const Vec3f& p) { return p.y < kLevel; });
  const SurfaceResult r = reconstruct(in_basin(points, size));
  EXPECT_TRUE(topology(r.mesh).closed());
  EXPECT_NEAR(r.volume / particles_volume(points), 1, 0.01);
  double tilt = 0;
  std::size_t n = 0, contact = 0;
  for (std::size_t v = 0; v < r.mesh.vertices.size(); ++v) {
    const Vec3f p = r.mesh.vertices[v];
    if (p.y < kLevel - 2 * kH) continue;  // the free surface and its rim remain
    const bool on_wall = p.x == 0 || p.z == 0 || p.x == size.x || p.z == size.z;
    contact += on_wall;
    if (on_wall && r.mesh.normals[v].y < 0.5f) continue;  // the wetted wall below the rim
    EXPECT_NEAR(p.y, kLevel, 0.35f * kH);
    tilt += 1 - static_cast<double>(r.mesh.normals[v].y);
    ++n;
  }
  EXPECT_GT(contact, 100u);
  ASSERT_GT(n, 1000u);
  EXPECT_LT(std::acos(1 - tilt / static_cast<double>(n)), 0.1);  // 6 degrees
}

TEST(Surface, AFreeBallKeepsItsVolume) {
  for (const float radius : {0.02f, 0.03f, 0.05f, 0.1f}) {
    const Vec3f c{0.12f, 0.12f, 0.12f};
    const auto points = lattice(kH, c * 2.0f, [&](const Vec3f& p) { return length(p - c) < radius; });
    const SurfaceResult r = reconstruct({.positions = points, .spacing = kH});
    const auto t = topology(r.mesh);
    EXPECT_TRUE(t.closed());
    EXPECT_EQ(t.components, 1u);
    EXPECT_NEAR(r.volume / particles_volume(points), 1, 0.03) << radius;
  }
}

TEST(Surface, ALoneParticleBecomesASphereOfItsVolume) {
  const std::vector<Vec3f> points{{0.5f, 0.1f, 0.5f}, {0.2f, 0.001f, 0.999f}}, velocities{{1, 2, 3}, {-1, 0, 0}};
  SurfaceInput input = in_basin(points, {1, 1, 1});
  input.velocities = velocities;
  const SurfaceResult r = reconstruct(input);
  EXPECT_EQ(r.small_drops, 2u);
  const auto t = topology(r.mesh);
  EXPECT_TRUE(t.closed());
  EXPECT_EQ(t.components, 2u);
  EXPECT_NEAR(r.volume / particles_volume(points), 1, 1e-3);
  for (std::size_t v = 0; v < r.mesh.vertices.size(); ++v) {
    const Vec3f p = r.mesh.vertices[v];
    EXPECT_TRUE(p.y >= 0 && p.z <= 1);  // moved off the walls
    EXPECT_LT(length(r.mesh.velocities[v] - velocities[p.x < 0.35f]), 1e-4f);
  }
}

TEST(Surface, AThinSheetHasNoHole) {
  // 1.6 h thick: one full layer of lattice cells and 0.6 of the next.
  const auto points = lattice(kH, {0.4f, 0.02f, 0.4f}, [&](const Vec3f& p) {
    return p.y < kH || uniform(5, static_cast<std::uint64_t>(1e9f * p.x)) < 0.6;
  });
  const SurfaceResult r = reconstruct({.positions = points, .spacing = kH});
  const auto t = topology(r.mesh);
  EXPECT_TRUE(t.closed());
  EXPECT_EQ(t.components, 1u);
  // One closed surface without handles: a hole would make the Euler number 0 or less.
  const auto edges = r.mesh.triangles.size() * 3 / 2;
  EXPECT_EQ(
      static_cast<long>(r.mesh.vertices.size()) - static_cast<long>(edges) + static_cast<long>(r.mesh.triangles.size()),
      2);
}

TEST(Surface, ASheetOfSixTenthsOfASpacingHasNoHole) {
  // In the air: particles 1.29 h apart in a plane, so that they fill it 0.6 h thick.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const float apart = kH / std::sqrt(0.6f);
    std::vector<Vec3f> points;
    for (std::uint64_t j = 0; j < 30; ++j)
      for (std::uint64_t i = 0; i < 30; ++i) {
        const auto off = [&](std::uint64_t k) {
          return 2 * static_cast<float>(uniform(seed, 3 * (30 * j + i) + k)) - 1;
        };
        points.push_back({apart * (static_cast<float>(i) + 0.3f * off(0)), 0.2f * kH * off(1),
                          apart * (static_cast<float>(j) + 0.3f * off(2))});
      }
    const SurfaceResult r = reconstruct({.positions = points, .spacing = kH});
    const auto t = topology(r.mesh);
    EXPECT_TRUE(t.closed());
    EXPECT_EQ(t.components, 1u);
    const auto faces = static_cast<long>(r.mesh.triangles.size());
    EXPECT_EQ(static_cast<long>(r.mesh.vertices.size()) - faces * 3 / 2 + faces, 2) << "no hole";
    EXPECT_NEAR(r.volume / particles_volume(points), 1, 0.15);
  }
}

TEST(Surface, SmallDropsOnTheFloorAreFlatCaps) {
  // One particle, and four together.
  for (const std::vector<Vec3f>& points :
       {std::vector<Vec3f>{{0.15f, 0.003f, 0.15f}},
        std::vector<Vec3f>{
            {0.15f, 0.004f, 0.15f}, {0.158f, 0.004f, 0.15f}, {0.15f, 0.004f, 0.158f}, {0.158f, 0.005f, 0.159f}}}) {
    for (const float overlap : {0.0f, 0.5f}) {
      SurfaceSettings settings;
      settings.overlap = overlap;
      const SurfaceResult r = reconstruct(in_basin(points, {0.3f, 0.3f, 0.3f}), settings);
      const auto t = topology(r.mesh);
      EXPECT_TRUE(t.closed());
      EXPECT_EQ(t.components, 1u);
      EXPECT_EQ(r.small_drops, 1u);
      EXPECT_NEAR(r.volume / particles_volume(points), 1, 1e-3);
      float low = 1, high = 0, wide = 0;
      for (const Vec3f& v : r.mesh.vertices)
        low = std::min(low, v.y), high = std::max(high, v.y), wide = std::max(wide, std::abs(v.x - points[0].x));
      EXPECT_NEAR(low, -overlap * kH, 1e-6f) << "it reaches into the floor";
      const float size = kH * std::cbrt(static_cast<float>(points.size()));
      EXPECT_LT(high, 0.6f * size) << "a sphere is 1.24 high";
      EXPECT_GT(wide, 0.9f * size);
      if (overlap == 0) {
        double six = 0;
        for (const auto& [i, j, k] : r.mesh.triangles)
          six += static_cast<double>(dot(r.mesh.vertices[i], cross(r.mesh.vertices[j], r.mesh.vertices[k])));
        EXPECT_NEAR(six / 6 / particles_volume(points), 1, 0.01) << "the cap has the volume of its particles";
      }
    }
  }
}

TEST(Surface, AStillTankHardlyFlickers) {
  // Particles of a tank at rest move by 0.006 to 0.011 spacings a frame, root mean square: here by
  // 0.011, and each by itself, where neighbors in a tank move together.
  const Vec3f size{0.3f, 0.3f, 0.25f};
  auto points = lattice(kH, size, [](const Vec3f& p) { return p.y < 0.12f; });
  const TriMesh before = reconstruct(in_basin(points, size)).mesh;
  std::uint64_t n = 0;
  for (Vec3f& p : points)
    for (int a = 0; a < 3; ++a) p[a] += 0.011f * kH * (2 * static_cast<float>(uniform(9, n++)) - 1);
  const TriMesh after = reconstruct(in_basin(points, size)).mesh;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < before.vertices.size(); ++v) {
    const Vec3f& p = before.vertices[v];
    if (before.normals[v].y < 0.9f || p.y < 0.05f) continue;
    float off = 1;
    for (const auto& [i, j, k] : after.triangles) {
      const Vec3f &a = after.vertices[i], &b = after.vertices[j], &c = after.vertices[k];
      if (length(a - p) > 2 * kH) continue;
      const Vec3f w = nearest_weights(p, a, b, c);
      off = std::min(off, length(a * w.x + b * w.y + c * w.z - p));
    }
    sum += static_cast<double>(off), ++count;
  }
  ASSERT_GT(count, 1000u);
  EXPECT_LT(sum / static_cast<double>(count), 0.02 * static_cast<double>(kH));
}

TEST(Surface, AFilmOnTheFloorHasNoHole) {
  const Vec3f size{0.3f, 0.3f, 0.3f};
  const auto points = lattice(kH, {size.x, kH, size.z}, everything);  // one layer
  const SurfaceResult r = reconstruct(in_basin(points, size));
  const auto t = topology(r.mesh);
  EXPECT_TRUE(t.closed());
  EXPECT_EQ(t.components, 1u);
  EXPECT_NEAR(r.volume / particles_volume(points), 1, 0.1);
  std::size_t floor = 0;
  for (const Vec3f& v : r.mesh.vertices) floor += v.y == 0;
  EXPECT_GT(floor, 3000u);  // wetted all over, at voxels of h/2
}

TEST(Surface, ASplashIsClosedManifoldAndKeepsItsVolume) {
  const auto points = splash();
  const SurfaceResult r = reconstruct(in_basin(points, {0.3f, 0.3f, 0.2f}));
  const auto t = topology(r.mesh);
  EXPECT_TRUE(t.closed()) << t.open_edges << " " << t.broken_fans;
  EXPECT_GT(t.components, 10u);
  EXPECT_NEAR(r.volume / particles_volume(points), 1, 0.08);
}

TEST(Surface, RandomSprayIsClosedManifold) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {  // from loose to crowded
    std::vector<Vec3f> points;
    const float edge = kH * (5.0f + 6.0f * static_cast<float>(seed));
    for (std::uint64_t i = 0; i < 1500; ++i)
      points.push_back(Vec3f(Vec3d{uniform(seed, 3 * i), uniform(seed, 3 * i + 1), uniform(seed, 3 * i + 2)}) * edge);
    const SurfaceResult r = reconstruct({.positions = points, .spacing = kH}, {.smooth = 1});
    const auto t = topology(r.mesh);
    EXPECT_TRUE(t.closed()) << edge << ": " << t.open_edges << " " << t.broken_fans;
    EXPECT_GT(r.volume, 0);
  }
}

TEST(Surface, BulkDensityMayVaryByATenth) {
  for (const float stretch : {0.967f, 1.034f}) {  // 10 % denser, 10 % thinner
    const Vec3f size{0.3f, 0.3f, 0.3f};
    auto points = lattice(kH, size, everything);
    for (Vec3f& p : points) p *= stretch;
    const SurfaceResult r = reconstruct({.positions = points, .spacing = kH});
    const auto t = topology(r.mesh);
    EXPECT_TRUE(t.closed());
    EXPECT_EQ(t.components, 1u);  // no bubble inside
    for (const Vec3f& v : r.mesh.vertices) {
      float depth = 1;
      for (int a = 0; a < 3; ++a) depth = std::min({depth, v[a], stretch * size[a] - v[a]});
      ASSERT_LT(depth, 3 * kH);
    }
  }
}

TEST(Surface, SameBytesForAnyNumberOfThreads) {
  const auto points = splash();
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    SurfaceInput input = in_basin(points, {0.3f, 0.3f, 0.2f});
    input.velocities = points;
    return reconstruct(input).mesh;
  };
  const TriMesh one = with(1);
  for (const int threads : {2, 3}) {
    const TriMesh many = with(threads);
    EXPECT_TRUE(one.vertices == many.vertices);
    EXPECT_TRUE(one.triangles == many.triangles);
    EXPECT_TRUE(one.normals == many.normals);
    EXPECT_TRUE(one.velocities == many.velocities);
  }
}

TEST(Surface, VerticesMoveWithTheLiquid) {
  const Vec3f size{0.3f, 0.3f, 0.25f};
  const auto points = lattice(kH, size, [](const Vec3f& p) { return p.y < 0.15f + 0.2f * (p.x - 0.15f); });
  const auto flow = [](const Vec3f& p) { return Vec3f{1 - 3 * p.y, 2 * p.x + p.z, 5 * p.z}; };
  std::vector<Vec3f> velocities;
  for (const Vec3f& p : points) velocities.push_back(flow(p));
  SurfaceInput input = in_basin(points, size);
  input.velocities = velocities;
  const SurfaceResult r = reconstruct(input);
  ASSERT_EQ(r.mesh.velocities.size(), r.mesh.vertices.size());
  for (std::size_t v = 0; v < r.mesh.vertices.size(); ++v)
    ASSERT_LT(length(r.mesh.velocities[v] - flow(r.mesh.vertices[v])), 5 * 0.2f * kH);  // as if 0.2 h off, at the rim
}

TEST(Surface, BadSettingsSayWhatWouldBeRight) {
  const std::vector<Vec3f> one{{0, 0, 0}}, two{{0, 0, 0}, {NAN, 0, 0}};
  EXPECT_THROW(reconstruct({.positions = one, .spacing = 0}), InputError);
  EXPECT_THROW(reconstruct({.positions = one, .spacing = kH}, {.voxel = kH / 100}), InputError);
  EXPECT_THROW(reconstruct({.positions = one, .spacing = kH}, {.support = 1}), InputError);
  EXPECT_THROW(reconstruct({.positions = one, .velocities = two, .spacing = kH}), InputError);
  EXPECT_THROW(reconstruct({.positions = two, .spacing = kH}), RunError);
}

}  // namespace
}  // namespace dreampm
