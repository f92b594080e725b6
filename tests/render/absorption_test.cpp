// Clear matter that absorbs from place to place.
#include "dreampm/render/absorption.h"

#include <gtest/gtest.h>

#include "shapes.h"

namespace dreampm {
namespace {

/// Absorption a + b x over 2 m.
AbsorptionField ramp_field(const Vec3f& a, const Vec3f& b) {
  AbsorptionField field{{-1, -1, -1}, 0.1f, {20, 20, 20}, {}};
  for (int i = 0; i < 8000; ++i) field.values.push_back(a + b * (-0.95f + 0.1f * static_cast<float>(i % 20)));
  return field;
}

TEST(AbsorptionField, IsLinearBetweenCellsAndItsLossIsTheIntegral) {
  const AbsorptionField field = ramp_field({2, 1, 3}, {1, 0, -2});
  EXPECT_NEAR(field.at({0.31f, 0.2f, -0.7f}).x, 2.31f, 1e-5f);
  EXPECT_NEAR(field.at({5, 0, 0}).x, 2.95f, 1e-5f);  // as at the edge
  // From x = -0.5 to 0.3 along x: 0.8 a - 0.08 b.
  const Vec3f left = field.left({-0.5f, 0.03f, 0}, {1, 0, 0}, 0.8f);
  EXPECT_NEAR(left.x, std::exp(-(0.8f * 2 - 0.08f)), 1e-5f);
  EXPECT_NEAR(left.y, std::exp(-0.8f), 1e-5f);
  EXPECT_NEAR(left.z, std::exp(-(0.8f * 3 + 0.16f)), 1e-5f);
}

TEST(AbsorptionField, ABodyIsDrawnByItAndAnEvenOneAsByItsLook) {
  const TriMesh block = box_mesh({-0.5f, -0.5f, -0.25f}, {0.5f, 0.5f, 0.25f});
  model::Look look;
  look.type = model::LookType::dielectric, look.ior = 1.001, look.absorption = {2, 1, 3};
  RenderScene scene = before_uniform_sky({&block, look}, 6);
  const RenderSettings settings = small_picture(16, 16, 4);
  const Vec3f plain = mean_of(render(scene, settings));
  EXPECT_NEAR(plain.x, std::exp(-1.0f), 0.01f);
  const AbsorptionField even = ramp_field({2, 1, 3}, {0, 0, 0});
  scene.objects[0].look.absorption = {50, 50, 50};
  scene.objects[0].absorption = &even;
  EXPECT_LT(length(mean_of(render(scene, settings)) - plain), 1e-4f);
  // Clearer to the right in red.
  const AbsorptionField ramp = ramp_field({2, 1, 3}, {-4, 0, 0});
  scene.objects[0].absorption = &ramp;
  const Image image = render(scene, settings);
  const Vec3f first = image.linear[8 * 16], last = image.linear[8 * 16 + 15];
  EXPECT_GT(last.x, 1.2f * first.x);
  EXPECT_NEAR(last.y, first.y, 0.01f);
}

}  // namespace
}  // namespace dreampm
