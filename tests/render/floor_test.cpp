// The floor's baked light against what theory and a long plain path trace say.
#include "dreampm/render/floor.h"

#include <gtest/gtest.h>

#include "dreampm/render/color.h"
#include "dreampm/render/integrator.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

RenderScene stage() {
  RenderScene s;
  s.basin = {{0, 0, 0}, {1, 0.5f, 0.6f}};
  s.stage = {.floor = model::Floor::tiles, .basin = model::Basin::none};
  s.physical = true;
  return s;
}

/// Bakes as render() does.
struct Baked {
  explicit Baked(const RenderScene& scene, bool bend = true)
      : geometry(scene), sky(scene.light, scene.physical), pattern(scene.basin), light(geometry, sky, scene.basin) {
    light.bake_sun(bend, 400000, 7);
    const Integrator bounce = integrator(&light, false);
    const auto gather = [&](const Vec3f& p, const Vec3f& d, Sampler& r) { return bounce.radiance(p, d, r); };
    light.bake_sky(gather, 16, 7);
    light.bake_sky(gather, 48, 8);
  }
  Integrator integrator(const FloorLight* with, bool sun_disc) const {
    PathOptions o;
    o.floor_light = with;
    o.physical = true;
    o.looks = false;
    o.sun_disc = sun_disc;
    o.splits = 0;
    return {geometry, sky, pattern, 1, o};
  }
  Geometry geometry;
  Sky sky;
  FloorPattern pattern;
  FloorLight light;
};

TEST(BakedFloor, OpenFloorIsExact) {
  const Baked b(stage());
  const Vec3f open = b.sky.open_irradiance() + b.sky.sun_irradiance() * b.sky.sun_direction().y;
  for (const float x : {-0.3f, 0.2f, 0.55f, 1.3f, 5.0f})
    for (const float z : {-0.2f, 0.3f, 0.7f}) {
      const Vec3f e = b.light.irradiance(x, z, 1);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(e[k], open[k], 2e-4f * open[k]) << x << " " << z;
    }
}

TEST(BakedFloor, ShadowOfABallMatchesAPlainPathTrace) {
  RenderScene scene = stage();
  const TriMesh ball = ball_mesh({0.4f, 0.25f, 0.3f}, 0.15f, 32);
  scene.objects = {{&ball, model::Look::opaque(srgb_of({0.7f, 0.3f, 0.2f}), 1)}};
  const Baked b(scene);
  const Integrator baked = b.integrator(&b.light, true), plain = b.integrator(nullptr, true);
  // where the ball's center throws its shadow, then places around it, clear of the penumbra
  const Vec3f s = b.sky.sun_direction();
  const float cx = 0.4f - s.x / s.y * 0.25f, cz = 0.3f - s.z / s.y * 0.25f;
  int dark = 0;
  for (const auto& [x, z] :
       {std::pair{cx, cz}, {cx + 0.05f, cz}, {0.4f, 0.3f}, {0.25f, 0.1f}, {cx + 0.5f, cz - 0.3f}, {0.9f, 0.1f}}) {
    const Vec3f from{x, 0.03f, z}, down{0, -1, 0};
    Sampler one(1, 0);
    const float got = luminance(baked.radiance(from, down, one));
    constexpr int n = 6000;
    double sum = 0, sum2 = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      Sampler random(99, i);
      const double l = luminance(plain.radiance(from, down, random));
      sum += l, sum2 += l * l;
    }
    const double want = sum / n, error = std::sqrt((sum2 / n - want * want) / n);
    EXPECT_NEAR(got, want, 3 * error + 0.04 * want) << "at " << x << ", " << z;
    const Vec3f open = b.sky.open_irradiance() + b.sky.sun_irradiance() * b.sky.sun_direction().y;
    if (luminance(b.light.irradiance(x, z, 1)) < 0.5f * luminance(open)) ++dark;
  }
  EXPECT_GE(dark, 2) << "no point was in the shadow";
}

TEST(BakedFloor, SunUnderALevelSurfaceKeepsItsEnergy) {
  // without absorption the floor of a wide pool gets the sun's irradiance times one transmission
  RenderScene scene = stage();
  scene.basin = {{0, 0, 0}, {4, 0.2f, 4}};
  scene.light.sun.angle = 0.5f;
  const TriMesh water = box_mesh({0, 0, 0}, {4, 0.1f, 4});
  scene.objects = {{&water, model::Look::dielectric(1.333, {})}};
  const Geometry geometry(scene);
  const Sky sky(scene.light, true);
  FloorLight light(geometry, sky, scene.basin);
  light.bake_sun(true, 400000, 3);
  FloorLight dry(geometry, sky, scene.basin);
  float cos_out;
  const float pass = 1 - fresnel(sky.sun_direction().y, 1 / 1.333f, cos_out);
  Vec3d sum;
  int n = 0;
  for (float x = 1.2f; x < 2.8f; x += 0.05f)
    for (float z = 1.2f; z < 2.8f; z += 0.05f)
      sum += static_cast<Vec3d>(light.irradiance(x, z, 1) - sky.open_irradiance()), ++n;
  const double mean = (sum / static_cast<double>(n)).y;
  const double open = dry.irradiance(2, 2, 1).y - sky.open_irradiance().y;
  EXPECT_NEAR(mean / open, pass, 0.01);
  // seen in the medium, radiance is counted by 1/n^2
  EXPECT_NEAR((light.irradiance(2, 2, 1.333f).y - sky.open_irradiance().y) * 1.333f * 1.333f,
              light.irradiance(2, 2, 1).y - sky.open_irradiance().y, 1e-3f * open);
}

TEST(BakedFloor, UnderALevelSurfaceItMatchesAPlainPathTrace) {
  // plain paths reach the sun along the bent line, which is exact here, and find the floor's own
  // light that the surface throws back
  RenderScene scene = stage();
  scene.basin = {{0, 0, 0}, {1, 0.1f, 1}};
  const TriMesh water = box_mesh({0, 0, 0}, {1, 0.04f, 1});
  scene.objects = {{&water, model::Look::dielectric(1.333, {3, 1, 0.3})}};
  const Baked b(scene);
  const Integrator baked = b.integrator(&b.light, false), plain = b.integrator(nullptr, false);
  for (const auto& [x, z] : {std::pair{0.5f, 0.5f}, {0.6f, 0.45f}}) {
    const Vec3f from{x, 0.3f, z}, down{0, -1, 0};
    constexpr int n = 20000;
    Vec3d got, want, want2;
    for (std::uint32_t i = 0; i < n; ++i) {
      Sampler one(17, i), other(99, i);
      const Vec3d p = static_cast<Vec3d>(plain.radiance(from, down, other));
      got += static_cast<Vec3d>(baked.radiance(from, down, one)), want += p, want2 += p * p;
    }
    for (int k = 0; k < 3; ++k) {
      const double mean = want[k] / n, error = std::sqrt((want2[k] / n - mean * mean) / n);
      EXPECT_NEAR(got[k] / n, mean, 3 * error + 0.03 * mean) << "channel " << k << " at " << x;
    }
  }
}

TEST(BakedFloor, AStrayDropDoesNotBlurIt) {
  RenderScene scene = stage();
  scene.light.sun.elevation = 90, scene.light.sun.angle = 0.3f;
  const TriMesh lens = ball_mesh({0.5f, 0.2f, 0.3f}, 0.1f, 64);
  const std::vector<Vec3f> far{{60, 0.1f, -40}};
  scene.objects = {{&lens, model::Look::dielectric(1.333, {})},
                   {RenderSpheres{far, 0.01f, {}}, model::Look::opaque({0.9, 0.9, 0.9})}};
  const Geometry geometry(scene);
  const Sky sky(scene.light, true);
  FloorLight light(geometry, sky, scene.basin);
  light.bake_sun(true, 400000, 7);
  const float open = sky.sun_irradiance().y;
  EXPECT_GT(light.irradiance(0.5f, 0.3f, 1).y, 4 * open);
}

TEST(BakedFloor, ALensGathersSunlightBehindIt) {
  RenderScene scene = stage();
  scene.light.sun.elevation = 90, scene.light.sun.angle = 0.3f;
  const TriMesh ball = ball_mesh({0.5f, 0.2f, 0.3f}, 0.1f, 64);
  scene.objects = {{&ball, model::Look::dielectric(1.333, {})}};
  const Baked bent(scene), straight(scene, false);
  const float open = bent.sky.sun_irradiance().y + bent.sky.open_irradiance().y;
  EXPECT_GT(bent.light.irradiance(0.5f, 0.3f, 1).y, 4 * open) << "the focus";
  EXPECT_LT(bent.light.irradiance(0.58f, 0.3f, 1).y, 0.5f * open) << "the dark round it";
  EXPECT_LT(straight.light.irradiance(0.5f, 0.3f, 1).y, open) << "no lens when light goes straight on";
}

}  // namespace
}  // namespace dreampm
