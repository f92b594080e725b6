// The points of a rigid body's surface: what sums over them have to give, and that they move with
// it.
#include "dreampm/contact/body_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/contact/obstacles.h"
#include "dreampm/state/regroup.h"

namespace dreampm::body_surface_test {
namespace {

constexpr double dx = 0.02;

std::shared_ptr<const Region> box(const Vec3d& size) {
  Shape s;
  s.form = BoxShape{size};
  s.center = {0.3, 0.2, 0.4};
  return make_region(s, dx, {});
}
std::shared_ptr<const Region> ball(double radius) {
  Shape s;
  s.form = SphereShape{radius};
  s.center = {0.3, 0.2, 0.4};
  return make_region(s, dx, {});
}

/// The force and the torque about `center` of the pressure a + b . x on the points [dx^2].
struct Push {
  Vec3d force, torque;
};
Push push_of(const std::vector<BodyPoint>& points, double a, const Vec3d& b, const Vec3d& center) {
  Push all{};
  for (const BodyPoint& p : points) {
    const Vec3d push = p.normal * (-p.area * (a + dot(b, p.at - center)));
    all.force += push, all.torque += cross(p.at - center, push);
  }
  return all;
}

TEST(BodySurface, PressureGivesWhatTheVolumeDisplaces) {
  struct Case {
    std::shared_ptr<const Region> shape;
    double volume;  // m^3
  };
  // Neither of whole cells, and one thinner than a cell.
  for (const Case& c :
       {Case{box({0.127, 0.093, 0.061}), 0.127 * 0.093 * 0.061}, Case{ball(0.05), std::numbers::pi / 6 * 1e-3},
        Case{box({0.2, 0.017, 0.11}), 0.2 * 0.017 * 0.11}}) {
    const Vec3d center = c.shape->bounds().center();
    const std::vector<BodyPoint> points = body_points(c.shape, dx);
    double area = 0;
    for (const BodyPoint& p : points) area += p.area;
    const Push flat = push_of(points, 1, {}, center);
    EXPECT_LT(length(flat.force), 1e-9 * area);
    EXPECT_LT(length(flat.torque), 1e-9 * area * dx);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d slope;
      slope[axis] = 1;
      const Push push = push_of(points, 0, slope, center);
      EXPECT_NEAR(push.force[axis] * dx * dx, -c.volume, 0.01 * c.volume);
      for (int other = 0; other < 3; ++other)
        if (other != axis) {
          EXPECT_LT(std::abs(push.force[other]) * dx * dx, 1e-6 * c.volume);
        }
    }
  }
}

TEST(BodySurface, MovesWithTheBody) {
  World<double> w;
  w.dx = dx;
  w.low = {0, 0, 0}, w.high = {40, 40, 40};
  Collider body;
  body.shape = box({0.127, 0.093, 0.061}), body.rigid = true;
  w.colliders.push_back(body);
  w.rigid.push_back({});
  std::vector<Vec3i> blocks;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k) blocks.push_back({i, j, k});
  w.grid.blocks.assign(blocks);
  const std::vector<BodyPoint> own = body_points(body.shape, dx);
  Obstacles kept;
  for (int n = 0; n < 6; ++n) {
    Pose& pose = w.colliders[0].surface_pose;
    pose = {{0.013 * n, 0.007 * n, 0}, Quaternion::about({0.1 * n, 0.05 * n, 0.2 * n})};
    kept.prepare(w);
    std::size_t found = 0;
    double area = 0;
    for (std::size_t b = 0; b < w.grid.blocks.size(); ++b)
      for (const SurfacePoint& p : kept.points(b)) {
        const Vec3d at = w.node_position(w.grid.blocks[b] * block_width) + static_cast<Vec3d>(p.at) * dx;
        const auto same = std::find_if(own.begin(), own.end(), [&](const BodyPoint& o) {
          return length(pose(o.at) - at) < 1e-6 &&
                 length(pose.rotation(o.normal) - static_cast<Vec3d>(p.normal)) < 1e-6;
        });
        EXPECT_NE(same, own.end());
        ++found, area += static_cast<double>(p.area);
      }
    EXPECT_EQ(found, own.size()) << n;
    EXPECT_GT(area, 0.98 * 2 * (0.127 * 0.093 + 0.127 * 0.061 + 0.093 * 0.061) / (dx * dx));
  }
}

}  // namespace
}  // namespace dreampm::body_surface_test
