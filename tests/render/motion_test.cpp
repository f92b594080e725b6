// Motion blur: edges become ramps as wide as the way that they go while the shutter is open.
#include <gtest/gtest.h>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "shapes.h"
#include "thrown.h"

namespace dreampm {
namespace {

constexpr int wide = 96, high = 16;

/// A black box before the sky, seen from far away, where a pixel is 0.05 m.
RenderScene far_box(const RenderObject& object, double shutter) {
  RenderScene s = before_uniform_sky(object, 1);
  const double distance = 0.05 * high / (2 * std::tan(0.5 * std::numbers::pi / 180));
  s.camera.from = {0, 0, distance};
  s.camera.shutter = shutter;
  s.frame_time = 0.1;
  s.basin = {{-3, -3, -3}, {3, 3, 3}};
  s.is_wall.fill(false);
  return s;
}

TriMesh moving_box(const Vec3f& velocity) {
  TriMesh box = box_mesh({-0.5f, -2, -0.5f}, {0.5f, 2, 0.5f});
  box.velocities.assign(box.vertices.size(), velocity);
  return box;
}

/// What the middle row lacks of the sky.
std::vector<double> lacks(const Image& image) {
  std::vector<double> row;
  for (int x = 0; x < image.width; ++x)
    row.push_back(1 - image.linear[static_cast<std::size_t>((image.height / 2) * image.width + x)].x);
  return row;
}

/// Of an even ramp from 1 to 0 at the box's right edge: its middle and its width, which is the root
/// of 12 times the variance of its slope.
std::pair<double, double> right_ramp(const std::vector<double>& row) {
  double sum = 0, first = 0, second = 0;
  for (std::size_t x = row.size() / 2; x + 1 < row.size(); ++x) {
    const double slope = row[x] - row[x + 1], at = static_cast<double>(x) + 1;
    sum += slope, first += slope * at, second += slope * at * at;
  }
  const double middle = first / sum, variance = second / sum - middle * middle;
  return {middle - 0.5 * wide, std::sqrt(12 * variance)};
}

const model::Look black = model::Look::opaque({0, 0, 0});

TEST(Motion, AnEdgeIsSmearedOverItsWayWhileTheShutterIsOpen) {
  // 10 m/s for half of 0.1 s: 0.5 m, 10 pixels, about the place at the frame.
  const TriMesh box = moving_box({10, 0, 0});
  const auto [still_at, still] =
      right_ramp(lacks(render(far_box({&box, black, {}}, 0), small_picture(wide, high, 256))));
  EXPECT_NEAR(still_at, 10, 0.2);
  EXPECT_LT(still, 2) << "the picture's own filter";
  const auto [at, width] = right_ramp(lacks(render(far_box({&box, black, {}}, 0.5), small_picture(wide, high, 256))));
  EXPECT_NEAR(at, 10, 0.2);
  EXPECT_NEAR(width, std::hypot(10, still), 0.4);
}

TEST(Motion, AlongItselfAnEdgeStaysSharp) {
  const TriMesh box = moving_box({0, 10, 0});
  const auto [at, width] = right_ramp(lacks(render(far_box({&box, black, {}}, 1), small_picture(wide, high, 64))));
  EXPECT_NEAR(at, 10, 0.1);
  EXPECT_LT(width, 2);
}

TEST(Motion, BallsAndGrainsAreSmearedAsMeshesAre) {
  const std::vector<Vec3f> at{{0, 0, 0}}, velocity{{10, 0, 0}}, dark{{0, 0, 0}};
  const std::vector<float> radius{0.5f}, opacity{1.0f};
  const TriMesh ball = [&] {
    TriMesh m = ball_mesh({0, 0, 0}, 0.5f, 24);
    m.velocities.assign(m.vertices.size(), velocity[0]);
    return m;
  }();
  const auto row_of = [&](const RenderObject& o) {
    return lacks(render(far_box(o, 0.5), small_picture(wide, high, 256)));
  };
  const std::vector<double> mesh = row_of({&ball, black, {}});
  const std::vector<double> sphere = row_of({RenderSpheres{at, 0.5f, {}, velocity}, black, {}});
  const std::vector<double> grain = row_of({RenderGrains{at, radius, opacity, dark, velocity}, black, {}});
  double widest = 0;
  for (std::size_t x = 0; x < mesh.size(); ++x) {
    EXPECT_NEAR(sphere[x], mesh[x], 0.06) << x;
    EXPECT_NEAR(grain[x], mesh[x], 0.06) << x;
    widest += mesh[x] > 0.02;
  }
  EXPECT_NEAR(widest, 30, 3) << "20 pixels of ball and 10 of way";
}

TEST(Motion, WhatTurnsGoesByItsSteps) {
  // A bar 2 m long that makes half a turn: it covers the disc, which straight ways to the ends,
  // which are the beginnings mirrored, would not.
  std::vector<TriMesh> steps;
  constexpr int count = 17;
  const TriMesh bar = box_mesh({-1, -0.05f, -0.05f}, {1, 0.05f, 0.05f});
  for (int k = 0; k < count; ++k) {
    const float angle = std::numbers::pi_v<float> * (static_cast<float>(k) / (count - 1) - 0.5f);
    TriMesh& m = steps.emplace_back(bar);
    for (Vec3f& v : m.vertices)
      v = {v.x * std::cos(angle) - v.y * std::sin(angle), v.x * std::sin(angle) + v.y * std::cos(angle), v.z};
  }
  RenderObject object{&bar, black, {}};
  for (const TriMesh& m : steps) object.motion.push_back(&m);
  const Image image = render(far_box(object, 1), small_picture(48, 48, 256));
  // At a distance r from the middle a bar 0.1 m wide covers 0.1/(r pi) of the time, the same all
  // round. A pixel is 0.05/3 m wide here.
  double ring = 0;
  int pixels = 0;
  double least = 1;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const double r = std::hypot(x + 0.5 - 24, y + 0.5 - 24) * 0.05 / 3;
      if (r < 0.3 || r > 0.35) continue;
      const double lack = 1 - image.linear[static_cast<std::size_t>(y * 48 + x)].x;
      ring += lack, least = std::min(least, lack), ++pixels;
    }
  EXPECT_GT(pixels, 20);
  EXPECT_NEAR(ring / pixels, 0.1 / (0.325 * std::numbers::pi), 0.01);
  EXPECT_GT(least, 0.03);
}

TEST(Motion, WaterStaysWithinItsPanes) {
  // A block on three panes whose velocities would carry it through them and off them.
  TriMesh water = box_mesh({0, 0, 0}, {0.6f, 0.5f, 0.4f});
  RenderScene scene;
  scene.basin = {{0, 0, 0}, {1, 1, 1}};
  scene.frame_time = 1;
  scene.stage.floor = model::Floor::none;
  const auto picture = [&](const Vec3f& velocity, double shutter) {
    water.velocities.assign(water.vertices.size(), velocity);
    scene.objects = {{&water, model::Look::dielectric(), {}}};
    scene.camera.shutter = shutter;
    return render(scene, small_picture(48, 32, 16));
  };
  const Image still = picture({0, 0, 0}, 0), moving = picture({0, 0.2f, 0}, 1);
  const Image pressed = picture({-0.4f, -0.4f, -0.4f}, 1);
  for (const Image* image : {&moving, &pressed}) {
    const Vec3f a = mean_of(still), b = mean_of(*image);
    EXPECT_LT(length(a - b), 0.05f * length(a)) << "no leak, no darkness";
  }
}

TEST(Motion, TheSameBitsForAnyNumberOfThreads) {
  const TriMesh box = moving_box({4, 1, 0});
  RenderScene scene = far_box({&box, model::Look::opaque({0.8, 0.3, 0.2}), {}}, 0.5);
  scene.camera.aperture = 0.5;
  scene.stage.floor = model::Floor::tiles;
  scene.light = {};
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(scene, small_picture(40, 24, 8));
  };
  const Image one = with(1), two = with(2);
  for (std::size_t i = 0; i < one.linear.size(); ++i) ASSERT_EQ(one.linear[i], two.linear[i]) << i;
}

TEST(Motion, BrokenVelocitiesAreNamed) {
  TriMesh box = moving_box({1, 0, 0});
  box.velocities.pop_back();
  EXPECT_NE(test::refusal([&] {
              render(far_box({&box, black, {}}, 0.5), small_picture(8, 8, 2));
            }).find("35 velocities for 36"),
            std::string::npos);
  box.velocities.push_back({std::nanf(""), 0, 0});
  EXPECT_NE(test::refusal([&] { render(far_box({&box, black, {}}, 0), small_picture(8, 8, 2)); }).find("vertex 35"),
            std::string::npos);
  box.velocities.clear();
  const TriMesh other = ball_mesh({0, 0, 0}, 1, 4);
  RenderObject object{&box, black, {}};
  object.motion = {&box, &other};
  EXPECT_NE(test::refusal([&] { render(far_box(object, 0.5), small_picture(8, 8, 2)); }).find("other triangles"),
            std::string::npos);
}

}  // namespace
}  // namespace dreampm
