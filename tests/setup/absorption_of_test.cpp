// What clear liquids of several colors absorb.
#include "dreampm/pictures/absorption_of.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dreampm/math/look_color.h"

namespace dreampm {
namespace {

TEST(AbsorptionOf, ALayerOfItLetsTheColorThrough) {
  const Vec3f color{0.3f, 0.9f, 0.05f};
  EXPECT_LT(length(light_through(absorption_of(color)) - color), 1e-5f);
  EXPECT_LT(absorption_of({0, 0, 0}).x, 100);  // nothing is quite black
  EXPECT_EQ(absorption_of({1, 1, 1}).y, 0);
}

TEST(AbsorptionField, KeepsPureColorsAndMixesBlueAndYellowToGreen) {
  // A row of matter: blue, then both, then yellow.
  const Vec3f blue{0.02f, 0.1f, 0.8f}, yellow{0.9f, 0.8f, 0.05f};
  constexpr float spacing = 0.01f;
  std::vector<Vec3f> positions, colors;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 8; ++k) {
        positions.push_back(
            Vec3f{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f, static_cast<float>(k) + 0.5f} * spacing);
        const bool is_blue = i < 20 || (i < 40 && (i + j + k) % 2 == 0);
        colors.push_back(is_blue ? blue : yellow);
      }
  const AbsorptionField field = absorption_field(positions, colors, spacing);
  const auto color_at = [&](float x) { return light_through(static_cast<Vec3d>(field.at({x, 0.04f, 0.04f}))); };
  EXPECT_LT(length(color_at(0.1f) - blue), 1e-3f);
  EXPECT_LT(length(color_at(0.5f) - yellow), 1e-3f);
  const Vec3f mixed = color_at(0.3f);
  EXPECT_GT(mixed.y, 1.5f * mixed.x);
  EXPECT_GT(mixed.y, 1.5f * mixed.z);
  // The surface ends half a spacing beyond the particles, and more where it is smoothed.
  EXPECT_LT(length(light_through(static_cast<Vec3d>(field.at({-0.015f, 0.04f, 0.095f}))) - blue), 1e-3f);
}

}  // namespace
}  // namespace dreampm
