#include "dreampm/gl/camera.h"

#include <gtest/gtest.h>

#include "dreampm/gl/color_scale.h"

namespace dreampm::gl {
namespace {

Vec3f through(const Mat4f& m, const Vec3f& p, float* w) {
  const auto row = [&](std::size_t i) { return m[i] * p.x + m[4 + i] * p.y + m[8 + i] * p.z + m[12 + i]; };
  *w = row(3);
  return {row(0), row(1), row(2)};
}

TEST(Camera, TheTargetIsInTheMiddle) {
  const Camera camera;
  const auto p = camera.project(camera.target, 1280, 720);
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->x, 640, 1e-3);
  EXPECT_NEAR(p->y, 360, 1e-3);
  EXPECT_NEAR(p->depth, camera.distance(), 1e-5);
}

TEST(Camera, ARayThroughTheImageOfAPointMeetsThePoint) {
  Camera camera;
  camera.orbit(0.7f, -0.2f);
  camera.pan(0.1f, 0.05f);
  for (const Vec3f& p : {Vec3f{0.2f, 0.1f, 0.9f}, Vec3f{0.9f, 0.7f, 0.3f}, Vec3f{0.5f, 0, 0.5f}}) {
    const auto at = camera.project(p, 640, 480);
    ASSERT_TRUE(at);
    const Ray ray = camera.ray(at->x, at->y, 640, 480);
    const Vec3f arm = p - ray.origin;
    EXPECT_LT(length(cross(arm, ray.direction)), 1e-5f);
    EXPECT_GT(dot(arm, ray.direction), 0);
    EXPECT_NEAR(length(ray.direction), 1, 1e-6);
  }
}

// The matrices for OpenGL and project() are two ways to the same pixel.
TEST(Camera, TheMatricesAgreeWithTheProjection) {
  Camera camera;
  camera.orbit(-1.1f, 0.3f);
  const Vec3f p{0.3f, 0.6f, 0.2f};
  float w = 0;
  const Vec3f eye = through(camera.view(), p, &w);
  const Vec3f clip = through(camera.projection(640.0f / 360.0f), eye, &w);
  const auto at = camera.project(p, 640, 360);
  ASSERT_TRUE(at);
  EXPECT_NEAR((clip.x / w * 0.5f + 0.5f) * 640, at->x, 1e-3);
  EXPECT_NEAR((0.5f - clip.y / w * 0.5f) * 360, at->y, 1e-3);
  EXPECT_NEAR(w, at->depth, 1e-5);
  EXPECT_GT(clip.z / w, -1);
  EXPECT_LT(clip.z / w, 1);
}

TEST(Camera, WhatIsBehindHasNoImage) {
  const Camera camera;
  EXPECT_FALSE(camera.project(camera.eye + (camera.eye - camera.target), 64, 64));
  EXPECT_FALSE(camera.project(camera.eye, 64, 64));
}

TEST(Camera, OrbitKeepsTheDistanceAndStopsBeforeThePole) {
  Camera camera;
  const float d = camera.distance();
  camera.orbit(0.4f, 10);
  EXPECT_NEAR(camera.distance(), d, 1e-5);
  EXPECT_LT(camera.eye.y - camera.target.y, d);
  const ViewAxes a = camera.axes();
  EXPECT_NEAR(dot(a.right, a.up), 0, 1e-5);
  EXPECT_NEAR(a.right.y, 0, 1e-6);  // the horizon stays level
  camera.orbit(0, -20);
  EXPECT_NEAR(camera.distance(), d, 1e-5);
}

// A quarter of a turn to the right about +y: from +z to +x.
TEST(Camera, OrbitTurnsToTheRight) {
  Camera camera{{0, 0, 2}, {0, 0, 0}};
  camera.orbit(std::numbers::pi_v<float> / 2, 0);
  EXPECT_NEAR(camera.eye.x, 2, 1e-5);
  EXPECT_NEAR(camera.eye.z, 0, 1e-5);
}

TEST(Camera, PanMovesThePictureByThatShareOfItsHeight) {
  Camera camera;
  const Vec3f p = camera.target;
  camera.pan(0.25f, -0.1f);
  const auto at = camera.project(p, 1000, 1000);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, 500 - 250, 0.01);
  EXPECT_NEAR(at->y, 500 - 100, 0.01);
}

TEST(Camera, ZoomMultipliesTheDistanceWithinBounds) {
  Camera camera;
  const float d = camera.distance();
  camera.zoom(0.5f);
  EXPECT_NEAR(camera.distance(), 0.5f * d, 1e-5);
  camera.zoom(1e-9f);
  EXPECT_GE(camera.distance(), 1e-3f);
  camera.zoom(1e30f);
  EXPECT_NEAR(camera.distance(), 1e3f, 1e-2);
}

TEST(Camera, LookingStraightDownIsAllowed) {
  const Camera camera{{0, 3, 0}, {0, 0, 0}};
  const auto at = camera.project({0, 0, 0}, 100, 100);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, 50, 1e-3);
  EXPECT_NEAR(at->y, 50, 1e-3);
}

// sRGB's luminance grows all the way, and by no step that is more than three times another: what a
// map for numbers is for.
TEST(ColorScale, GetsBrighterEvenly) {
  const auto lightness = [](float t) {
    const Vec3f c = color_scale(t);
    const auto linear = [](float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); };
    return std::cbrt(0.2126f * linear(c.x) + 0.7152f * linear(c.y) + 0.0722f * linear(c.z));
  };
  float least = 1, most = 0;
  for (int k = 0; k < 20; ++k) {
    const float step = lightness(0.05f * static_cast<float>(k + 1)) - lightness(0.05f * static_cast<float>(k));
    least = std::min(least, step);
    most = std::max(most, step);
  }
  EXPECT_GT(least, 0);
  EXPECT_LT(most, 3 * least);
}

TEST(ColorScale, EndsAreKeptOutside) {
  EXPECT_EQ(color_scale(-3), color_scale(0));
  EXPECT_EQ(color_scale(7), color_scale(1));
  EXPECT_EQ(color_scale(std::numeric_limits<float>::quiet_NaN()), color_scale(0));
}

}  // namespace
}  // namespace dreampm::gl
