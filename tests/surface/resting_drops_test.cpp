// Drops at rest that dry up.
#include "dreampm/surface/resting_drops.h"

#include <gtest/gtest.h>

#include <cmath>

#include "clouds.h"
#include "dreampm/surface/surface.h"

namespace dreampm {
namespace {

constexpr float kH = 0.01f;
constexpr double kFps = 24, kLife = 0.5;

/// A block of liquid, particle 0 that lies apart from frame 4 on, and particle 1 that flies.
surface::LiquidFrame frame_of(int number) {
  surface::LiquidFrame frame{(number - 1) / kFps, {0, 1}, {}};
  const auto f = static_cast<float>(number);
  frame.positions = {{0.3f + 0.05f * std::min(f, 4.0f), 0.004f, 0.1f}, {0.3f + 0.1f * f, 0.5f, 0.3f}};
  for (const Vec3f& p : test::lattice(kH, {0.08f, 0.08f, 0.08f}, [](const Vec3f&) { return true; }, 0.3f)) {
    frame.ids.push_back(static_cast<std::int32_t>(frame.ids.size()));
    frame.positions.push_back(p);
  }
  return frame;
}

TEST(RestingDrops, OneThatRestsShrinksFromWhereItCameToRest) {
  surface::RestingDrops drops(kH, kLife, 1, frame_of);
  for (int f = 1; f <= 20; ++f) {
    const std::vector<float> left = drops.remaining(f);
    ASSERT_EQ(left.size(), frame_of(f).ids.size());
    const double rest = std::max(0, f - 4) / kFps;
    EXPECT_NEAR(static_cast<double>(left[0]), std::pow(std::max(0.0, 1 - rest / kLife), 1.5), 1e-6) << f;
    for (std::size_t i = 1; i < left.size(); ++i) EXPECT_EQ(left[i], 1) << f;
    EXPECT_EQ(left, surface::RestingDrops(kH, kLife, 1, frame_of).remaining(f)) << f;  // made singly
  }
}

TEST(RestingDrops, OneThatLiquidCameToBeginsAnew) {
  const auto washed = [](int number) {
    surface::LiquidFrame frame = frame_of(number);
    if (number == 8) frame.positions[0] = {0.04f, 0.04f, 0.04f};
    return frame;
  };
  surface::RestingDrops drops(kH, kLife, 1, washed);
  EXPECT_LT(drops.remaining(7)[0], 1);
  EXPECT_EQ(drops.remaining(8)[0], 1);
  EXPECT_EQ(drops.remaining(9)[0], 1);
  EXPECT_LT(drops.remaining(11)[0], 1);
  EXPECT_GT(drops.remaining(11)[0], drops.remaining(12)[0]);
}

/// Of two drops of one particle, on the floor and in the air, of which shares are left.
SurfaceResult wrapped(float on_floor, float in_air) {
  const std::vector<Vec3f> points{{0.1f, 0.004f, 0.1f}, {0.1f, 0.2f, 0.1f}};
  const std::vector<float> remaining{on_floor, in_air};
  SurfaceInput in{.positions = points,
                  .remaining = remaining,
                  .spacing = kH,
                  .walls = {{0, 0, 0}, {0.3f, 0.3f, 0.3f}},
                  .is_wall = {true, true, true, false, true, true}};
  return reconstruct(in);
}

TEST(RestingDrops, WhatIsLeftOfADropOnTheFloorIsShown) {
  constexpr double one = 1e-6;  // m^3, of a particle
  const auto volume = [](const SurfaceResult& r) {
    double six = 0;
    for (const auto& t : r.mesh.triangles)
      six += static_cast<double>(dot(r.mesh.vertices[t[0]], cross(r.mesh.vertices[t[1]], r.mesh.vertices[t[2]])));
    return six / 6;
  };
  EXPECT_NEAR(volume(wrapped(1, 1)), 2 * one, 0.01 * one);
  EXPECT_NEAR(volume(wrapped(0.25f, 1)), 1.25 * one, 0.01 * one);
  EXPECT_NEAR(wrapped(0.25f, 1).volume, 1.25 * one, 0.01 * one);
  EXPECT_NEAR(volume(wrapped(0, 1)), one, 0.01 * one);
  EXPECT_NEAR(volume(wrapped(1, 0.25f)), 2 * one, 0.01 * one);  // none that flies dries up
  EXPECT_EQ(test::topology(wrapped(0.25f, 1).mesh).open_edges, 0u);
}

}  // namespace
}  // namespace dreampm
