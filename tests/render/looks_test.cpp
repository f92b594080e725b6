#include "dreampm/render/looks.h"

#include <gtest/gtest.h>

namespace dreampm {
namespace {

TEST(Looks, ColorsBecomeLinear) {
  const Vec3f color = trace::traced(model::Look::opaque({0, 0.5, 1}))->color();
  EXPECT_FLOAT_EQ(color.x, 0);
  EXPECT_NEAR(color.y, 0.2140f, 1e-4f);
  EXPECT_FLOAT_EQ(color.z, 1);
}

TEST(Looks, AClearDielectricDoesNotGlow) {
  EXPECT_EQ(trace::traced(model::Look::dielectric(1.333, {}))->interior()->glow, (Vec3f{0, 0, 0}));
  // Water glows in the colors that it lets through.
  const Vec3f water = trace::traced(model::Look::dielectric())->interior()->glow;
  EXPECT_GT(water.z, water.y);
  EXPECT_GT(water.y, water.x);
  EXPECT_GT(water.x, 0);
  // What scatters is traced.
  const auto milk = trace::traced(model::Look::dielectric(1.3, {6, 1.7, 0.5}, {10, 10, 10}));
  EXPECT_EQ(milk->interior()->glow, (Vec3f{0, 0, 0}));
  EXPECT_TRUE(milk->interior()->scatters);
}

TEST(Looks, EveryKindIsClearOrHasASurface) {
  for (std::size_t type = 0; type < model::look_type_names.size(); ++type) {
    model::Look look;
    look.type = static_cast<model::LookType>(type);
    const auto traced = trace::traced(look);
    EXPECT_EQ(traced->interior() == nullptr, traced->bsdf(1) != nullptr) << model::look_type_names[type];
    EXPECT_EQ(traced->model().type, look.type);
  }
}

}  // namespace
}  // namespace dreampm
