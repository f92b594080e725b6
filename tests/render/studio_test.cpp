// The studio's paper and its light, found beforehand.
#include <gtest/gtest.h>

#include "dreampm/render/backdrop.h"
#include "dreampm/render/light_grid.h"
#include "dreampm/render/paper_light.h"
#include "shapes.h"

namespace dreampm {
namespace {

using namespace trace;

TEST(Backdrop, ItsPlacesLieOnItsMesh) {
  const Backdrop paper({{0, 0.1f, 0}, {1, 0.6f, 0.5f}}, {2, 1, 3});
  for (const Vec3f& v : paper.mesh().vertices) {
    const Backdrop::Place at = paper.place_of(v);
    EXPECT_LT(length(paper.point_at(at) - v), 1e-4f);
    EXPECT_NEAR(length(paper.normal_at(at)), 1, 1e-5f);
    EXPECT_GE(paper.normal_at(at).y, -1e-5f);
  }
  // Flat where the basin stands, upright and towards the eye at its end.
  EXPECT_LT(length(paper.point_at({0.3f, 0.2f}) - Vec3f{0.5f, 0.1f, 0.25f}), 0.37f);
  EXPECT_NEAR(paper.point_at({0.3f, 0.2f}).y, 0.1f, 1e-6f);
  const Vec3f end = paper.normal_at({paper.end(), 0});
  EXPECT_NEAR(end.y, 0, 1e-5f);
  EXPECT_GT(dot(end, Vec3f{1.5f, 0, 2.75f}), 0);
}

TEST(LightGrid, KeepsItsSumUnderBlurAndReadsBetweenCells) {
  LightGrid g = LightGrid::covering(2, 1, 0.1f);
  ASSERT_EQ(g.width, 20);
  ASSERT_EQ(g.height, 10);
  g.values[5 * 20 + 10] = {1, 2, 3};
  g.blur(1);
  Vec3d sum;
  for (const Vec3f& v : g.values) sum += static_cast<Vec3d>(v);
  EXPECT_NEAR(sum.y, 2, 1e-5);
  EXPECT_NEAR(g.at(11, 5.5f).x, 0.5f * (g.values[5 * 20 + 10].x + g.values[5 * 20 + 11].x), 1e-6f);
}

TEST(PaperLight, AWhiteFurnaceLightsItEvenly) {
  // What arrives everywhere is 1, and what things take away is 0.2 of it below and beside the box.
  PaperLight light(Backdrop({{0, 0, 0}, {1, 0.5f, 0.5f}}, {0, 1, 3}));
  EXPECT_EQ(light.irradiance({0.5f, 0, 0.2f}).x, 0);
  const auto one = [](const Vec3f&, const Vec3f&, Sampler&) { return Vec3f{1, 1, 1}; };
  const auto less = [](const Vec3f& p, const Vec3f& n, Sampler&) {
    EXPECT_EQ(p.y, 0);
    EXPECT_EQ(n.y, 1);
    return Vec3f{0.8f, 0.8f, 0.8f};
  };
  light.bake_open(one, 2, 1);
  EXPECT_NEAR(light.irradiance({0.5f, 0, 0.2f}).x, 1, 1e-5f);
  EXPECT_NEAR(light.irradiance({0.5f, 4, -2.45f}).x, 1, 1e-5f);
  const auto wet = [](const Vec3f& p, const Vec3f&, Sampler&) {
    return p.x < 0.5f ? Vec3f{0.5f, 0.5f, 0.5f} : Vec3f{1, 1, 1};
  };
  const auto lies = [](const Vec3f& p) {
    return p.x < 0.5f              ? PaperLight::Over::clear
           : p.x > 0.9f && p.x < 1 ? PaperLight::Over::opaque
                                   : PaperLight::Over::nothing;
  };
  light.bake_near({{0, 0, 0}, {1, 0.5f, 0.5f}}, wet, one, lies, 4, 1);
  // The edge of what is under clear matter stays sharp, and nothing leaks from below what is
  // opaque.
  EXPECT_NEAR(light.irradiance({0.499f, 0, 0.2f}, false).x, 0.5f, 1e-4f);
  EXPECT_NEAR(light.irradiance({0.501f, 0, 0.2f}, true).x, 1, 1e-4f);
  EXPECT_NEAR(light.irradiance({1.01f, 0, 0.2f}).x, 1, 1e-4f);
  const auto in_air = [](const Vec3f&) { return PaperLight::Over::nothing; };
  light.bake_near({{0, 0, 0}, {1, 0.5f, 0.5f}}, less, one, in_air, 2, 1);
  EXPECT_NEAR(light.irradiance({0.5f, 0, 0.2f}).x, 0.8f, 1e-5f);
  EXPECT_NEAR(light.irradiance({0.5f, 0, 2.45f}).x, 1, 1e-5f);
}

TEST(PaperLight, APictureIsAsBrightAsATracedOne) {
  // A sun that is next to none makes the paper be traced plainly.
  const TriMesh block = box_mesh({0.3f, 0.001f, 0.1f}, {0.7f, 0.3f, 0.4f});
  RenderScene scene;
  scene.basin = {{0, 0, 0}, {1, 0.5f, 0.5f}};
  scene.objects = {{&block, model::Look::opaque(srgb_of({0.6f, 0.2f, 0.2f}))}};
  scene.light.sky = SkyKind::studio, scene.light.sun.strength = 0;
  scene.stage = {.place = model::Place::studio, .floor = model::Floor::tiles, .basin = model::Basin::none};
  scene.physical = true;
  const RenderSettings settings = small_picture(24, 14, 96);
  const Vec3f baked = mean_of(render(scene, settings));
  scene.light.sun.strength = 1e-6;
  const Vec3f traced = mean_of(render(scene, settings));
  // Light of more than five bounces, 0.2^5 of it, and the noise of both.
  EXPECT_NEAR(baked.x, traced.x, 0.015f * traced.x);
  EXPECT_NEAR(baked.z, traced.z, 0.015f * traced.z);
}

}  // namespace
}  // namespace dreampm
