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
  EXPECT_EQ(out.stage.floor, model::Floor::none);
  const RenderSettings settings = render_settings(scene);
  EXPECT_EQ(settings.samples, 2);
  EXPECT_EQ(settings.min_samples, 2) << "no more than the scene allows";
  EXPECT_EQ(settings.seed, 9u);
  EXPECT_EQ(render(out, settings).linear.size(), 64u * 36u);
}

}  // namespace
}  // namespace dreampm
