// Metal, plastic and wood: what they send back, by samples and by formula.
#include "dreampm/render/rough_surface.h"

#include <gtest/gtest.h>

#include "dreampm/base/error.h"
#include "dreampm/render/color.h"
#include "dreampm/render/sky.h"
#include "dreampm/render/wood.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

TEST(Furnace, WhiteRoughBallsAreInvisible) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
    for (const model::Look& look :
         {model::Look::metal({1, 1, 1}, roughness), model::Look::plastic({1, 1, 1}, roughness)}) {
      const Vec3f mean = mean_of(render(before_uniform_sky({&ball, look}, 20), small_picture(32, 32, 16)));
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(mean[k], 1, 0.006f) << "roughness " << roughness
                                        << (look.type == model::LookType::metal ? ", metal" : ", plastic");
    }
}

TEST(Furnace, NoLookGivesLightAway) {
  const TriMesh ball = ball_mesh({}, 1, 24);
  for (const float roughness : {0.0f, 0.3f, 1.0f})
    for (const auto make : {model::Look::metal, model::Look::plastic, model::Look::wood}) {
      const model::Look look = make(srgb_of({0.9f, 0.6f, 0.2f}), roughness);
      const Vec3f mean = mean_of(render(before_uniform_sky({&ball, look}, 12), small_picture(24, 24, 16)));
      for (int k = 0; k < 3; ++k) {
        EXPECT_LT(mean[k], 1) << static_cast<int>(look.type);
        EXPECT_GT(mean[k], 0.08f) << static_cast<int>(look.type);
      }
      EXPECT_GT(mean.x, mean.y);
      EXPECT_GT(mean.y, mean.z);
    }
}

/// A grid of directions over the hemisphere, of equal projected area: the integral of f cos is the
/// mean of pi f.
template <class Each>
void over_hemisphere(int n, Each&& each) {
  const Frame up({0, 0, 1});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3f d = cosine_direction(up, (static_cast<float>(i) + 0.5f) / static_cast<float>(n),
                                       (static_cast<float>(j) + 0.5f) / static_cast<float>(n));
      each(up.local(d));
    }
}

TEST(RoughSurface, SamplesAgreeWithTheFormula) {
  constexpr int n = 400;
  const Vec3f color{0.9f, 0.5f, 0.1f};
  for (const float outer : {1.0f, 1.333f})
    for (const float roughness : {0.4f, 0.7f, 1.0f})
      for (const Look& look : {Look{Metal{color, roughness}}, Look{Plastic{color, roughness}}}) {
        const RoughSurface surface(look, outer);
        for (const float c : {0.95f, 0.5f, 0.2f}) {
          const Vec3f view{std::sqrt(1 - c * c), 0, c};
          Vec3d formula, sampled;
          over_hemisphere(n, [&](const Vec3f& light) {
            formula += static_cast<Vec3d>(surface.scattered(view, light, color) * (pi / light.z)) / double(n * n);
            if (surface.has_base())
              sampled += static_cast<Vec3d>(surface.base_weight(view, light, color)) / double(n * n);
          });
          for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
              sampled += static_cast<Vec3d>(surface
                                                .sample_gloss(view, color, (static_cast<float>(i) + 0.5f) / n,
                                                              (static_cast<float>(j) + 0.5f) / n)
                                                .weight) /
                         double(n * n);
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(formula[k], sampled[k], 0.012 * sampled[k] + 0.001)
                << "look " << look.index() << " roughness " << roughness << " cosine " << c << " channel " << k;
        }
      }
}

TEST(RoughSurface, PlasticIsTheSameBothWays) {
  const Vec3f color{0.2f, 0.5f, 0.8f}, a = normalized(Vec3f{0.3f, 0.2f, 0.6f}),
                                       b = normalized(Vec3f{-0.7f, 0.1f, 0.3f});
  const RoughSurface surface(Plastic{color, 0.5f}, 1);
  const Vec3f there = surface.scattered(a, b, color) / b.z, back = surface.scattered(b, a, color) / a.z;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(there[k], back[k], 1e-4f);
}

TEST(RoughSurface, MetalReflectsItsColorAhead) {
  const Vec3f color{0.9f, 0.5f, 0.1f};
  const RoughSurface surface(Metal{color, 0.05f}, 1);
  const RoughSurface::Sample s = surface.sample_gloss({0, 0, 1}, color, 0.3f, 0.6f);
  EXPECT_NEAR(s.light.z, 1, 1e-3f);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(s.weight[k], color[k], 0.01f);
  EXPECT_TRUE(surface.mirror());
  EXPECT_FALSE(RoughSurface(Metal{color, 0.3f}, 1).mirror());
}

TEST(RoughSurface, TheSunLightsThemAsItsDiscWould) {
  // A wide sun with its true radiance: what direct light gives must be what a bounce would find.
  const TriMesh plate = box_mesh({-1, -0.1f, -1}, {1, 0, 1});
  RenderScene scene = before_uniform_sky({&plate, model::Look::plastic(srgb_of({0.5f, 0.5f, 0.5f}), 0.6)}, 8);
  scene.camera.from = {0.2, 4, 0.1};
  scene.light.sun.strength = 5, scene.light.sun.elevation = 60, scene.light.sun.angle = 10;
  const Vec3f mean = mean_of(render(scene, small_picture(16, 16, 64)));
  const Sky sky(scene.light, true);
  const RoughSurface surface(traced(scene.objects[0].look), 1);
  const Vec3f view = normalized(Vec3f{0.2f, 0.1f, 4});  // x, z, and up as z
  Vec3d expected;
  constexpr int n = 300;
  over_hemisphere(n, [&](const Vec3f& light) {
    const Vec3f f = surface.scattered(view, light, {0.5f, 0.5f, 0.5f}) * (pi / light.z);
    expected += static_cast<Vec3d>(f * sky.radiance({light.x, light.z, light.y}, true)) / double(n * n);
  });
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], expected[k], 0.02 * expected[k]);
}

TEST(Wood, IsOfOnePieceAndItsGrainRunsAlong) {
  TextureFrame frame;
  frame.half = {0.2f, 0.05f, 0.02f};
  const Wood look;
  const auto difference = [&](const Vec3f& step) {
    float sum = 0;
    for (int i = 0; i < 400; ++i) {
      const float t = static_cast<float>(i) / 400;
      const Vec3f p{0.3f * t - 0.15f, 0.08f * unit_float(hash32(static_cast<std::uint32_t>(i))) - 0.04f, 0.01f};
      sum += std::fabs(luminance(wood_color(look, frame, p, 0)) - luminance(wood_color(look, frame, p + step, 0)));
    }
    return sum / 400;
  };
  EXPECT_LT(difference({1e-6f, 1e-6f, 1e-6f}), 1e-3f);
  EXPECT_GT(difference({0, 0.004f, 0}), 3 * difference({0.004f, 0, 0})) << "across the grain and along it";
  EXPECT_LT(difference({0, 0.004f, 0}), 0.3f);
}

TEST(Wood, GoesWithItsBody) {
  TextureFrame rest, moved;
  moved.middle = {1, 2, 3};
  moved.x = {0, 1, 0}, moved.y = {0, 0, 1}, moved.z = {1, 0, 0};
  for (int i = 0; i < 20; ++i) {
    const Vec3f p{0.008f * static_cast<float>(i) - 0.08f, 0.03f, -0.05f + 0.004f * static_cast<float>(i)};
    const Vec3f q = moved.middle + moved.x * p.x + moved.y * p.y + moved.z * p.z;
    const Vec3f a = wood_color({}, rest, p, 0), b = wood_color({}, moved, q, 0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 2e-3f);
  }
}

TEST(Wood, FarAwayIsItsMean) {
  TextureFrame frame;
  const Wood look;
  float low = 1, high = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3f p{0.001f * static_cast<float>(i), 0.0013f * static_cast<float>(i) - 0.05f, 0.02f};
    const float c = luminance(wood_color(look, frame, p, 0.1f));
    low = std::min(low, c), high = std::max(high, c);
  }
  EXPECT_LT(high / low, 1.25f);
}

}  // namespace
}  // namespace dreampm
