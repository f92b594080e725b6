#include "dreampm/render/looks.h"

#include <gtest/gtest.h>

namespace dreampm {
namespace {

TEST(Looks, ColorsBecomeLinear) {
  model::Look look;
  look.type = model::LookType::opaque;
  look.color = {0, 0.5, 1};
  const auto opaque = std::get<trace::Opaque>(trace::traced(look));
  EXPECT_FLOAT_EQ(opaque.color.x, 0);
  EXPECT_NEAR(opaque.color.y, 0.2140f, 1e-4f);
  EXPECT_FLOAT_EQ(opaque.color.z, 1);
}

TEST(Looks, AClearDielectricDoesNotGlow) {
  model::Look look;
  look.absorption = {0, 0, 0};
  EXPECT_EQ(std::get<trace::Dielectric>(trace::traced(look)).glow, (Vec3f{0, 0, 0}));
  // Water glows in the colors that it lets through.
  look.absorption = {6, 1.7, 0.5};
  const Vec3f water = std::get<trace::Dielectric>(trace::traced(look)).glow;
  EXPECT_GT(water.z, water.y);
  EXPECT_GT(water.y, water.x);
  EXPECT_GT(water.x, 0);
}

}  // namespace
}  // namespace dreampm
