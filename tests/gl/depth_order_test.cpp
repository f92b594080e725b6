#include "dreampm/gl/depth_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "dreampm/gl/patch.h"

namespace dreampm::gl {
namespace {

TEST(DepthOrder, EveryParticleOnceTheNearestFirst) {
  const Camera camera{{0, 0, 5}, {0, 0, 0}};
  std::vector<Vec3f> at;
  for (int k = 0; k < 1000; ++k)
    at.push_back({0.1f * static_cast<float>(k % 7), 0, -0.004f * static_cast<float>(k * 37 % 1000)});
  DepthOrder order;
  const auto found = order.front_to_back(at, camera);
  std::vector<std::uint32_t> sorted(found.begin(), found.end());
  std::sort(sorted.begin(), sorted.end());
  ASSERT_EQ(sorted.size(), at.size());
  for (std::uint32_t k = 0; k < sorted.size(); ++k) EXPECT_EQ(sorted[k], k);
  // Layers are a 255th of the depth that the particles take.
  for (std::size_t k = 1; k < found.size(); ++k) EXPECT_LT(at[found[k]].z, at[found[k - 1]].z + 4.0f / 250);
}

TEST(DepthOrder, WhatIsNoNumberIsLeftOut) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  DepthOrder order;
  const std::vector<Vec3f> at{{nan, 0, 0}, {0, 0, 1}, {0, 0, inf}, {0, 0, 2}};
  const auto found = order.front_to_back(at, Camera{{0, 0, 5}, {0, 0, 0}});
  EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), (std::vector<std::uint32_t>{3, 1}));
  EXPECT_TRUE(order.front_to_back({}, Camera{}).empty());
  const std::vector<Vec3f> one{{0, 0, 1}, {1, 0, 1}};
  EXPECT_EQ(order.front_to_back(one, Camera{{0, 0, 5}, {0, 0, 0}}).size(), 2u);
}

TEST(Patch, HoldsTheImageOfEveryPointOfTheBox) {
  const Camera camera;
  const Box3f box{{0.3f, 0.1f, 0.2f}, {0.6f, 0.4f, 0.7f}};
  const Patch patch = seen_patch(camera, box, 0, 640, 360);
  EXPECT_LT(patch.width, 400);
  for (int k = 0; k < 8; ++k) {
    const auto p = camera.project({(k & 1) ? 0.3f : 0.6f, (k & 2) ? 0.1f : 0.4f, (k & 4) ? 0.2f : 0.7f}, 640, 360);
    ASSERT_TRUE(p);
    EXPECT_GE(p->x, static_cast<float>(patch.x));
    EXPECT_LE(p->x, static_cast<float>(patch.x + patch.width));
    EXPECT_GE(360 - p->y, static_cast<float>(patch.y));
    EXPECT_LE(360 - p->y, static_cast<float>(patch.y + patch.height));
  }
}

TEST(Patch, IsEmptyBesideThePictureAndAllOfItAboutTheEye) {
  const Camera camera{{0, 0, 2}, {0, 0, 0}};
  EXPECT_TRUE(seen_patch(camera, {{50, 0, 0}, {51, 1, 1}}, 0, 64, 64).empty());
  const Patch all = seen_patch(camera, {{-1, -1, 1}, {1, 1, 3}}, 0, 64, 48);
  EXPECT_EQ(all.width, 64);
  EXPECT_EQ(all.height, 48);
  const Patch half = half_patch({10, 11, 3, 3}, 32, 32, 0);
  EXPECT_LE(2 * half.x, 10);
  EXPECT_GE(2 * (half.x + half.width), 13);
  EXPECT_GE(2 * (half.y + half.height), 14);
}

}  // namespace
}  // namespace dreampm::gl
