#include "dreampm/gl/pick.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace dreampm::gl {
namespace {

TEST(Pick, TheFirstSphereOnTheRay) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Ray ray{{0, 0, 2}, {0, 0, -1}};
  const std::vector<Vec3f> centers{{0, 0, -1}, {nan, 0, 0}, {0.05f, 0, 0.5f}, {0.2f, 0, 1}, {0, 0, 3}, {0, 0, 2}};
  const auto hit = first_sphere(ray, centers, 0.1f);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(*hit, 1.5f - std::sqrt(0.01f - 0.0025f), 1e-5);
  EXPECT_FALSE(first_sphere(ray, std::span(centers).subspan(3), 0.1f));
  EXPECT_FALSE(first_sphere(ray, {}, 0.1f));
}

TEST(Pick, ThePixelOfAParticleFindsIt) {
  const Camera camera;
  const std::vector<Vec3f> centers{{0.3f, 0.2f, 0.6f}, {0.7f, 0.1f, 0.4f}};
  const auto at = camera.project(centers[1], 800, 600);
  ASSERT_TRUE(at);
  const Ray ray = camera.ray(at->x, at->y, 800, 600);
  const auto hit = first_sphere(ray, centers, 0.01f);
  ASSERT_TRUE(hit);
  EXPECT_LT(length(ray.origin + ray.direction * *hit - centers[1]), 0.0101f);
}

}  // namespace
}  // namespace dreampm::gl
