// Prescribed motions: where keys put a shape, and the twists that take it there.
#include "dreampm/math/motion_path.h"

#include <gtest/gtest.h>

namespace dreampm::motion_path_test {
namespace {

void expect_near(const Vec3d& a, const Vec3d& b, double slack) {
  EXPECT_LT(length(a - b), slack) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

TEST(MotionPath, GoesFromKeyToKeyAndStandsOutside) {
  MotionPath path;
  path.keys = {{1, {0, 0, 0}, {0, 0, 1}, 0}, {2, {2, 0, 0}, {0, 0, 1}, 90}, {3, {2, 1, 0}, {0, 0, 1}, 90}};
  path.center = {1, 1, 0};
  expect_near(path.pose_at(0)({3, 4, 5}), {3, 4, 5}, 1e-12);
  expect_near(path.pose_at(1.5)({1, 1, 0}), {2, 1, 0}, 1e-12);
  // Its center goes along, and the rest turns about it.
  expect_near(path.pose_at(2)({2, 1, 0}), {3, 2, 0}, 1e-12);
  expect_near(path.pose_at(9)({1, 1, 0}), {3, 2, 0}, 1e-12);
}

TEST(MotionPath, SmoothMotionRestsAtItsKeys) {
  MotionPath path;
  path.keys = {{0, {0, 0, 0}, {}, 0}, {2, {4, 0, 0}, {}, 0}};
  path.smooth = true;
  EXPECT_NEAR(path.pose_at(1).position.x, 2, 1e-12);
  EXPECT_NEAR(path.pose_at(0.5).position.x, 4 * 0.25 * 0.25 * 2.5, 1e-12);
  EXPECT_LT(path.twist_over(0, 1e-4).velocity.x, 1e-3);
  EXPECT_NEAR(path.twist_over(0.9999, 1.0001).velocity.x, 3, 1e-6);
  EXPECT_DOUBLE_EQ(path.fastest_within(0, 2).speed, 3);
  EXPECT_EQ(path.fastest_within(2.5, 3).speed, 0);
}

TEST(MotionPath, AnglesAboutOneAxisGoAllTheirWay) {
  MotionPath path;
  path.keys = {{0, {}, {0, 1, 0}, 0}, {4, {}, {0, 1, 0}, 720}};
  expect_near(path.pose_at(0.5)({1, 0, 0}), {0, 0, -1}, 1e-12);
  expect_near(path.twist_over(1, 1.001).spin, {0, std::numbers::pi, 0}, 1e-9);
}

TEST(MotionPath, BetweenAxesItTakesTheShortestWay) {
  MotionPath path;
  path.keys = {{0, {}, {1, 0, 0}, 90}, {1, {}, {0, 1, 0}, 90}};
  const Twist twist = path.twist_over(0, 0.5), rest = path.twist_over(0.5, 1);
  EXPECT_NEAR(length(twist.spin), length(rest.spin), 1e-12);
  EXPECT_LT(length(twist.spin), std::numbers::pi);
  EXPECT_NEAR(path.fastest_within(0, 1).spin, length(twist.spin), 1e-12);
}

// Steps of the twist follow the path.
TEST(MotionPath, TwistsTakeTheShapeAlong) {
  MotionPath path;
  path.keys = {{0, {0, 0, 0}, {0, 0, 1}, 0}, {1, {1, 2, 3}, {1, 2, 3}, 200}};
  path.center = {0.5, 0, 0};
  const Vec3d p{1, 1, 1};
  for (double t = 0; t < 0.99; t += 0.1) {
    const Twist twist = path.twist_over(t, t + 1e-6);
    expect_near(twist.at(path.pose_at(t)(p)), (path.pose_at(t + 1e-6)(p) - path.pose_at(t)(p)) / 1e-6, 1e-4);
  }
}

TEST(MotionPath, WithoutKeysItIsConstant) {
  MotionPath path;
  path.velocity = {1, 0, 0}, path.spin = {0, 0, 2}, path.center = {0, 1, 0};
  expect_near(path.pose_at(0.5)({0, 1, 0}), {0.5, 1, 0}, 1e-12);
  expect_near(path.twist_over(3, 3.1).spin, {0, 0, 2}, 1e-12);
  EXPECT_EQ(path.fastest_within(0, 1).spin, 2);
}

}  // namespace
}  // namespace dreampm::motion_path_test
