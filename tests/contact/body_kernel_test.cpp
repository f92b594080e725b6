// The part of a node's kernel inside a rigid body, read from its table, against sums over its
// space.
#include "dreampm/contact/body_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "dreampm/contact/obstacle_nodes.h"
#include "dreampm/contact/obstacles.h"

namespace dreampm::body_kernel_test {
namespace {

constexpr double dx = 0.02;
const Vec3d center{0.3, 0.2, 0.4};

std::shared_ptr<const Region> box(const Vec3d& size) {
  Shape s;
  s.form = BoxShape{size};
  s.center = center;
  return make_region(s, dx, {});
}
std::shared_ptr<const Region> ball(double radius) {
  Shape s;
  s.form = SphereShape{radius};
  s.center = center;
  return make_region(s, dx, {});
}

/// Returns the share of the kernel of a node at `p`, with the axes of space, inside of the shape
/// that `inside` gives.
template <class Inside>
double summed(const Vec3d& p, const Inside& inside) {
  constexpr int parts = 48;
  std::array<double, parts> weight{}, place{};
  for (std::size_t i = 0; i < parts; ++i) {
    const double begin = -1.5 + 3.0 * static_cast<double>(i) / parts;
    weight[i] = kernel_inside(begin) - kernel_inside(begin + 3.0 / parts);
    place[i] = (begin + 1.5 / parts) * dx;
  }
  double sum = 0;
  for (std::size_t i = 0; i < parts; ++i)
    for (std::size_t j = 0; j < parts; ++j)
      for (std::size_t k = 0; k < parts; ++k)
        if (inside(p + Vec3d{place[i], place[j], place[k]})) sum += weight[i] * weight[j] * weight[k];
  return sum;
}

Vec3d somewhere(std::mt19937& random, double half) {
  std::uniform_real_distribution<double> along(-half, half);
  const double x = along(random), y = along(random), z = along(random);
  return center + Vec3d{x, y, z};
}

TEST(BodyKernel, ABoxTakesTheProductOfItsSides) {
  const Vec3d size{0.127, 0.093, 0.011};  // the last is half a cell
  const BodyKernel kernel(box(size), dx);
  std::mt19937 random(1);
  for (int n = 0; n < 2000; ++n) {
    const Vec3d p = somewhere(random, 0.1);
    double want = 1;
    for (int a = 0; a < 3; ++a) {
      const double from_middle = (p[a] - center[a]) / dx, half = 0.5 * size[a] / dx;
      want *= kernel_inside(from_middle - half) - kernel_inside(from_middle + half);
    }
    EXPECT_NEAR(kernel.inside(p), want, 0.01);
  }
}

TEST(BodyKernel, ABallTakesWhatASumOverSpaceTakes) {
  const auto region = ball(0.05);
  const BodyKernel kernel(region, dx);
  std::mt19937 random(2);
  int cut = 0;
  for (int n = 0; n < 60; ++n) {
    const Vec3d p = somewhere(random, 0.06);
    const double want = summed(p, [&](const Vec3d& q) { return region->distance(q) < 0; });
    EXPECT_NEAR(kernel.inside(p), want, 0.01);
    cut += want > 0.02 && want < 0.98;
  }
  EXPECT_GT(cut, 30);
}

TEST(BodyKernel, KnowsWhereItIsThin) {
  EXPECT_FALSE(BodyKernel(box({0.1, 0.1, 0.1}), dx).any_thin());
  const BodyKernel plank(box({0.2, 0.012, 0.1}), dx);
  EXPECT_TRUE(plank.any_thin());
  EXPECT_TRUE(plank.is_thin(center + Vec3d{0.02, 0.01, 0}));
  EXPECT_FALSE(plank.is_thin(center + Vec3d{0, 0.1, 0}));
}

/// A turned cube half a cell to three cells over the floor of a box, and a ball beside it. What the
/// nodes are given of each is what lies in their kernels, mirrored in the wall.
TEST(BodyKernel, NodesBesideBodiesAndWallsKnowWhatIsTaken) {
  World<double> w;
  w.dx = dx;
  w.low = {0, 0, 0}, w.high = {40, 40, 40};
  for (const auto& shape : {box({0.1, 0.1, 0.1}), ball(0.04)}) {
    Collider body;
    body.shape = shape, body.rigid = true;
    w.colliders.push_back(body);
    w.rigid.push_back({});
  }
  Shape slab;
  slab.form = BoxShape{{0.8, 0.06, 0.8}};
  slab.center = {0.4, 0.03, 0.4};
  w.colliders.push_back({"floor", make_region(slab, dx, {})});
  std::vector<Vec3i> blocks;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k) blocks.push_back({i, j, k});
  w.grid.blocks.assign(blocks);
  std::mt19937 random(3);
  for (const double gap : {0.5, 1.2, 3.0}) {
    w.colliders[0].surface_pose = {{0, 0, 0}, Quaternion::about({0, 0.4, 0})};
    const Vec3d turned = w.colliders[0].surface_pose(center);
    w.colliders[0].surface_pose.position = Vec3d{0.3, 0.11 + gap * dx, 0.4} - turned;
    w.colliders[1].surface_pose.position = {0.13, -0.05, 0};
    Obstacles obstacles;
    obstacles.prepare(w);
    const auto inside = [&](Vec3d p) {
      for (int a = 0; a < 3; ++a) p[a] = std::abs(p[a]);
      return std::any_of(w.colliders.begin(), w.colliders.end(), [&](const Collider& c) { return c.distance(p) < 0; });
    };
    std::vector<std::pair<std::size_t, int>> seen;  // grid block and node that a body reaches
    for (std::size_t b = 0; b < w.grid.blocks.size(); ++b)
      for (const ObstacleNode& o : obstacles.at(b))
        if (o.collider != 2) seen.emplace_back(b, o.node);
    ASSERT_GT(seen.size(), 500u);
    for (int n = 0; n < 40; ++n) {
      const auto [block, node] = seen[std::uniform_int_distribution<std::size_t>(0, seen.size() - 1)(random)];
      double taken = 0;
      for (const ObstacleNode& o : obstacles.at(block))
        if (o.node == node) taken += static_cast<double>(o.taken);
      const Vec3d at = w.node_position(w.grid.blocks[block] * block_width + node_offset(node));
      EXPECT_NEAR(taken, summed(at, inside), 0.025) << gap << ": " << at.x << ' ' << at.y << ' ' << at.z;
    }
  }
}

}  // namespace
}  // namespace dreampm::body_kernel_test
