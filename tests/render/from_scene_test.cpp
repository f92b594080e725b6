#include "dreampm/render/from_scene.h"

#include <gtest/gtest.h>

namespace dreampm {
namespace {

TEST(FromScene, TakesOverWallsLooksAndSizes) {
  model::Scene scene;
  scene.seed = 9;
  scene.space.max = {1.2, 0.9, 0.4};
  scene.space.walls[index(Side::y_max)].type = WallType::open;
  scene.render.width = 64, scene.render.height = 36, scene.render.samples = 2;
  scene.render.light.sky = SkyKind::studio;
  scene.render.stage.floor = model::Floor::none;
  const RenderScene out = render_scene(scene);
  EXPECT_FLOAT_EQ(out.basin.max.y, 0.9f);
  EXPECT_FALSE(out.is_wall[3]);
  EXPECT_TRUE(out.is_wall[2]);
  EXPECT_EQ(out.light.sky, SkyKind::studio);
  EXPECT_FALSE(out.stage.floor_tiles);
  const RenderSettings settings = render_settings(scene);
  EXPECT_EQ(settings.samples, 2);
  EXPECT_EQ(settings.min_samples, 2) << "no more than the scene allows";
  EXPECT_EQ(settings.seed, 9u);
  EXPECT_EQ(render(out, settings).linear.size(), 64u * 36u);
}

TEST(FromScene, ColorsBecomeLinear) {
  model::Look look;
  look.type = model::LookType::opaque;
  look.color = {0, 0.5, 1};
  const auto opaque = std::get<OpaqueLook>(render_look(look));
  EXPECT_FLOAT_EQ(opaque.color.x, 0);
  EXPECT_NEAR(opaque.color.y, 0.2140f, 1e-4f);
  EXPECT_FLOAT_EQ(opaque.color.z, 1);
}

TEST(FromScene, AClearDielectricDoesNotGlow) {
  model::Look look;
  look.absorption = {0, 0, 0};
  EXPECT_EQ(std::get<DielectricLook>(render_look(look)).glow, (Vec3f{0, 0, 0}));
  // Water glows in the colors that it lets through.
  look.absorption = {6, 1.7, 0.5};
  const Vec3f water = std::get<DielectricLook>(render_look(look)).glow;
  EXPECT_GT(water.z, water.y);
  EXPECT_GT(water.y, water.x);
  EXPECT_GT(water.x, 0);
}

}  // namespace
}  // namespace dreampm
