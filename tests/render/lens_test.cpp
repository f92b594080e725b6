// The lens: what is out of focus spreads over the circle that the formula of thin lenses gives.
#include <gtest/gtest.h>

#include "dreampm/base/error.h"
#include "dreampm/render/camera.h"
#include "shapes.h"
#include "thrown.h"

namespace dreampm {
namespace {

/// An eye at z = 4 that looks along -z, with a lens that is sharp 4 m away.
model::Camera before_origin(double aperture) {
  model::Camera c;
  c.fit_basin = false;
  c.from = {0, 0, 4}, c.to = {0, 0, 0}, c.fov = 30;
  c.aperture = aperture;
  return c;
}

/// The width of the circle of confusion [pixels] of a point at `depth`: aperture |depth - focus| /
/// depth in the plane that is sharp, seen from the eye.
double circle(double aperture, double focus, double depth, double fov, int height) {
  const double in_plane = aperture * std::abs(depth - focus) / depth;
  return in_plane * height / (2 * focus * std::tan(0.5 * fov * std::numbers::pi / 180));
}

TEST(Lens, RaysOfOnePixelMeetWhereItIsSharp) {
  const trace::Camera camera(before_origin(0.2), {}, 400, 300);
  EXPECT_FLOAT_EQ(camera.lens_radius(), 0.1f);
  EXPECT_FLOAT_EQ(camera.focus(), 4);
  const Vec3f through = camera.direction(130, 70), sharp = camera.eye() + through * (4 / -through.z);
  float widest = 0;
  for (const auto& [a, b] : {std::pair{0.1f, 0.2f}, {0.9f, 0.4f}, {0.0f, 0.5f}, {0.5f, 0.5f}, {0.7f, 0.999f}}) {
    const trace::CameraRay ray = camera.ray(130, 70, a, b);
    widest = std::max(widest, length(ray.origin - camera.eye()));
    EXPECT_LE(length(ray.origin - camera.eye()), 0.1f + 1e-6f);
    const Vec3f p = ray.origin + ray.direction * ((ray.origin.z - sharp.z) / -ray.direction.z);
    EXPECT_LT(length(p - sharp), 1e-5f);
  }
  EXPECT_GT(widest, 0.09f);
}

TEST(Lens, FNumbersAreOfFilm24MillimetersHigh) {
  model::Camera wish = before_origin(0);
  wish.fstop = 2.0;
  // 12 mm / tan(15 degrees) = 44.78 mm of focal length.
  EXPECT_NEAR(trace::Camera(wish, {}, 400, 300).lens_radius(), 0.25 * 0.012 / std::tan(std::numbers::pi / 12), 1e-7);
}

TEST(Lens, TheFocusIsADistanceOrAPointOrTheMiddle) {
  model::Camera wish = before_origin(0.1);
  wish.focus = 2.5;
  EXPECT_FLOAT_EQ(trace::Camera(wish, {}, 400, 300).focus(), 2.5f);
  wish.focus.reset(), wish.focus_point = {1, 1, 1};
  EXPECT_FLOAT_EQ(trace::Camera(wish, {}, 400, 300).focus(), 3) << "along the line of sight";
  wish.focus_point = {0, 0, 5};
  EXPECT_NE(
      test::refusal([&] { trace::Camera(wish, {}, 400, 300); }).find("render.camera.focus lies 1 m behind the eye"),
      std::string::npos);
  model::Camera fitted;
  fitted.aperture = 0.1;
  const Box3f box{{0, 0, 0}, {2, 1, 1}};
  const trace::Camera camera(fitted, box, 400, 300);
  EXPECT_NEAR(camera.focus(), camera.depth(box.center()), 1e-4f);
}

constexpr int side = 72;
/// What the picture's own filter adds to the square of the width: the variance of a tent of 0.9
/// pixels each way, where that of an even disc is a sixteenth of the square.
constexpr double filter = 16 * 0.9 * 0.9 / 6;

/// A black ball of a radius of 0.08 m, several pixels wide, before the uniform sky.
Image small_ball(double aperture, float z) {
  TriMesh ball = ball_mesh({0, 0, z}, 0.08f, 32);
  RenderScene scene = before_uniform_sky({&ball, model::Look::opaque({0, 0, 0}), {}}, 30);
  scene.camera = before_origin(aperture);
  return render(scene, small_picture(side, side, 256));
}

/// The width [pixels] of an even disc of the same mean square radius as what the picture lacks of
/// the sky.
double shadow_width(const Image& image) {
  double sum = 0, square = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double lack = 1 - image.linear[static_cast<std::size_t>(y * image.width + x)].x;
      const double u = x + 0.5 - 0.5 * image.width, v = y + 0.5 - 0.5 * image.height;
      sum += lack, square += lack * (u * u + v * v);
    }
  return 2 * std::sqrt(2 * square / sum);
}

TEST(Lens, WhatIsOutOfFocusSpreadsAsTheThinLensSays) {
  const double of_ball = 0.16 * side / (2 * 4 * std::tan(std::numbers::pi / 12));
  // Squares of widths add up where an even disc is spread over another.
  EXPECT_NEAR(shadow_width(small_ball(0.4, 0)) / std::sqrt(of_ball * of_ball + filter), 1, 0.03) << "in focus";
  for (const float z : {1.0f, -2.0f}) {
    const double depth = 4 - static_cast<double>(z), ball = of_ball * 4 / depth,
                 spread = circle(0.4, 4, depth, 30, side);
    EXPECT_NEAR(shadow_width(small_ball(0.4, z)) / std::sqrt(ball * ball + spread * spread + filter), 1, 0.03) << z;
    EXPECT_NEAR(shadow_width(small_ball(0, z)) / std::sqrt(ball * ball + filter), 1, 0.03) << "without a lens, " << z;
  }
}

TEST(Lens, ALensOfNoWidthIsAPinholeBitByBit) {
  TriMesh ball = ball_mesh({0, 0, 0}, 0.5f, 12);
  RenderScene scene = before_uniform_sky({&ball, model::Look::opaque({0.5, 0.4, 0.3}), {}}, 30);
  const Image before = render(scene, small_picture(32, 24, 8));
  scene.camera.focus = 1.5;
  const Image after = render(scene, small_picture(32, 24, 8));
  for (std::size_t i = 0; i < before.linear.size(); ++i) EXPECT_EQ(before.linear[i], after.linear[i]);
}

TEST(Lens, ValuesOutOfRangeAreRefused) {
  TriMesh ball = ball_mesh({0, 0, 0}, 0.5f, 6);
  const RenderScene good = before_uniform_sky({&ball, model::Look::opaque({0.5, 0.4, 0.3}), {}}, 30);
  const auto message = [&](const auto& change) {
    RenderScene scene = good;
    change(scene);
    return test::refusal([&] { check_render(scene, {}); });
  };
  EXPECT_NE(message([](auto& s) { s.camera.shutter = 1.5; }).find("camera shutter is 1.5"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.camera.aperture = -1; }).find("camera aperture is -1"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.camera.fstop = 0; }).find("camera fstop is 0"), std::string::npos);
  EXPECT_NE(message([](auto& s) { s.camera.focus = 0; }).find("camera focus is 0"), std::string::npos);
}

}  // namespace
}  // namespace dreampm
