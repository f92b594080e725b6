// Contact at the surfaces of colliders, on nodes that a test has filled.
#include "dreampm/backend/surface_contact.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "dreampm/math/bspline.h"
#include "worlds.h"

namespace dreampm::surface_contact_test {
namespace {
using namespace test;

constexpr double dx = 0.1, full = 1;  // m, kg a cell
constexpr int blocks = 6;             // along each axis

Shape box(const Vec3d& size, double degrees) {
  Shape s;
  s.form = BoxShape{size};
  s.center = {1.23, 1.17, 1.21};
  s.rotate_axis = {1, 2, 0.5}, s.rotate_angle = degrees;
  return s;
}
Shape plane(const Vec3d& normal) {
  Shape s;
  s.form = PlaneShape{{1.23, 1.17, 1.21}, normal};
  return s;
}

/// A collider in matter: each node holds what fills its kernel outside.
struct Tank {
  World<double> world = empty_world<double>(dx, Vec3i{1, 1, 1} * (blocks * block_width));
  Obstacles obstacles;
  SurfaceContact<double> contact;
  std::vector<BlockStats> found;
  Node<double> outside{};

  Tank(const Shape& shape, WallType type) {
    world.colliders.push_back({"collider", make_region(shape, dx, {}), type, 0});
    std::vector<Vec3i> all;
    for (int b = 0; b < blocks * blocks * blocks; ++b)
      all.push_back({b / blocks / blocks, b / blocks % blocks, b % blocks});
    world.grid.blocks.assign(all);
    obstacles.prepare(world);
    contact.prepare(world, obstacles);
    world.grid.nodes.resize(all.size() * block_nodes);
    found.resize(all.size());
    for (Node<double>& node : world.grid.nodes) node.m = full;
    for (std::size_t b = 0; b < all.size(); ++b)
      for (const ObstacleNode& o : obstacles.at(b)) world.grid.nodes[b * block_nodes + o.node].m *= 1 - o.blocked;
  }
  Node<double>& at(const Vec3i& node) {
    const Vec3i b{node.x >> 2, node.y >> 2, node.z >> 2};
    if (world.grid.blocks.find(b) == BlockList::none) return outside;
    return world.grid.nodes[static_cast<std::size_t>(world.grid.blocks.find(b) * block_nodes +
                                                     node_index(node.x & 3, node.y & 3, node.z & 3))];
  }
  void move(const Vec3d& v) {
    for (Node<double>& node : world.grid.nodes) set_velocity(node, v);
  }
  /// Gives to all nodes the momentum of a pressure of 1 Pa in 1 s: -1/m_i times the integral of w_i
  /// n over the surface.
  void press() {
    move({});
    for (std::size_t b = 0; b < world.grid.blocks.size(); ++b)
      for (const SurfacePoint& p : obstacles.points(b)) {
        const Vec3i first = world.grid.blocks[b] * block_width + Vec3i{p.first[0], p.first[1], p.first[2]};
        std::array<Weights1<double>, 3> w;
        for (int a = 0; a < 3; ++a)
          w[static_cast<std::size_t>(a)] =
              bspline2(static_cast<double>(p.at[a]) - p.first[static_cast<std::size_t>(a)] - 1);
        for (int m = 0; m < 27; ++m) {
          if (p.deep >> m & 1) continue;
          const double weight = w[0].w[m / 9] * w[1].w[m / 3 % 3] * w[2].w[m % 3] * static_cast<double>(p.area);
          const Vec3i place = first + Vec3i{m / 9, m / 3 % 3, m % 3};
          if (Node<double>& node = at(place); node.m > 0)
            set_velocity(node, velocity(node) - static_cast<Vec3d>(p.normal) * (weight * dx * dx / node.m));
        }
      }
  }
  /// Returns the impulse that the collider gave [N s].
  Vec3d touch() {
    for (std::size_t b = 0; b < found.size(); ++b) {
      found[b].sums.mass = 0;
      for (std::size_t n = 0; n < block_nodes; ++n) found[b].sums.mass += world.grid.nodes[b * block_nodes + n].m;
    }
    parallel_region([&](ThreadTeam& team) { contact(team, world, obstacles, 0, {}, 0, found); });
    Vec3d sum;
    for (BlockStats& f : found)
      if (!f.impulses.empty()) sum += f.impulse_of(BlockStats::first_collider).impulse;
    return sum;
  }
  /// The largest speed of nodes eight cells and more from walls, for walls cut surfaces short.
  double fastest() {
    double v = 0;
    constexpr int end = blocks * block_width - 8;
    for (int i = 8; i < end; ++i)
      for (int j = 8; j < end; ++j)
        for (int k = 8; k < end; ++k)
          if (const Node<double>& node = at({i, j, k}); node.m > 1e-3 * full) v = std::max(v, length(velocity(node)));
    return v;
  }
};

// For matter at rest under pressure the impulses are the pressure, and every node stands still.
TEST(SurfaceContact, HoldsWhatPressesHoweverTheSurfaceLies) {
  for (const WallType type : {WallType::slip, WallType::separate})
    for (const Shape& shape :
         {plane({0, 1, 0}), plane({0.3, 1, 0.2}), box({0.64, 0.82, 0.78}, 0), box({0.64, 0.82, 0.78}, 33)}) {
      Tank tank(shape, type);
      tank.press();
      const double before = tank.fastest();
      const Vec3d given = tank.touch();
      std::printf("pressed: %.3g m/s, held: %.3g\n", before, tank.fastest());
      EXPECT_LT(tank.fastest(), 0.05 * before);
      EXPECT_TRUE(std::holds_alternative<PlaneShape>(shape.form) || length(given) < 0.02) << length(given);
    }
}

// A box in a stream stops the part that meets its face, to half a cell at each edge.
TEST(SurfaceContact, AnEdgeStopsNoMoreThanItsFace) {
  const auto taken = [](const Shape& shape) {
    Tank tank(shape, WallType::separate);
    tank.move({-1, 0, 0});
    return tank.touch().x;
  };
  const double side = blocks * block_width, by_cell = taken(plane({1, 0, 0})) / (side * side);
  for (const double width : {0.45, 0.6, 0.72, 0.9}) {
    const double reach = std::sqrt(taken(box({0.5, width, width}, 0)) / by_cell);  // cells
    std::printf("a face of %.1f cells stops as %.2f cells\n", width / dx, reach);
    EXPECT_NEAR(reach, width / dx, 0.5);
  }
}

// A node with next to nothing between full ones does not pay for them: it leaves no faster than
// they came.
TEST(SurfaceContact, ALightNodeDoesNotTakeOff) {
  for (const double mass : {0.1, 0.01, 1e-4, 1e-6}) {
    Tank tank(plane({0, 1, 0}), WallType::separate);
    tank.move({0, -1, 0});
    for (const int y : {11, 12, 13}) tank.at({12, y, 12}).m = mass * full;
    tank.touch();
    for (const int y : {11, 12, 13}) {
      const double up = velocity(tank.at({12, y, 12})).y;
      std::printf("%g of a node's mass at y = %d: %.3g m/s\n", mass, y, up);
      EXPECT_LE(up, 1 + 1e-9);
    }
  }
}

// A ball that moves beside a box at rest: what is kept from one look to the next is what a new look
// finds, where the ball has only changed its velocity and where it has moved on.
TEST(SurfaceContact, WhatItKeepsIsWhatANewLookFinds) {
  Tank tank(box({0.64, 0.82, 0.78}, 33), WallType::stick);
  Shape ball;
  ball.form = SphereShape{0.35};
  ball.center = {1.9, 1.8, 1.85};
  Collider moving{"ball", make_region(ball, dx, {}), WallType::separate, 0.3};
  moving.twist = {{0.1, 0, 0.2}, {0, 1, 0}, *ball.center};
  tank.world.colliders.push_back(moving);
  Collider bar{"bar", make_region(box({0.3, 0.3, 0.9}, 10), dx, {}), WallType::slip, 0};
  bar.pose.position = bar.surface_pose.position = {-0.6, 0.5, -0.4};
  tank.world.colliders.push_back(bar);
  tank.obstacles.prepare(tank.world);
  tank.contact.prepare(tank.world, tank.obstacles);
  const auto expect_same = [&] {
    Tank fresh(box({0.64, 0.82, 0.78}, 33), WallType::stick);
    fresh.world.colliders = tank.world.colliders;
    fresh.obstacles.prepare(fresh.world);
    fresh.contact.prepare(fresh.world, fresh.obstacles);
    for (Tank* t : {&tank, &fresh}) t->move({0.3, -1, 0.2}), t->touch();
    double fastest = 0;
    for (std::size_t n = 0; n < tank.world.grid.nodes.size(); ++n) {
      ASSERT_EQ(velocity(tank.world.grid.nodes[n]), velocity(fresh.world.grid.nodes[n]));
      fastest = std::max(fastest, length(velocity(fresh.world.grid.nodes[n]) - Vec3d{0.3, -1, 0.2}));
    }
    EXPECT_GT(fastest, 0.1);
  };
  expect_same();
  tank.world.colliders[1].twist = {{-0.3, 0.1, 0}, {0, 0, 2}, *ball.center};
  tank.obstacles.prepare(tank.world);
  EXPECT_FALSE(tank.obstacles.changed());
  EXPECT_TRUE(tank.contact.set_velocities(tank.world, tank.obstacles));
  expect_same();
  // One that stood still begins to move, and stops again.
  for (const Vec3d& velocity : {Vec3d{0.5, 0, -0.2}, Vec3d{}}) {
    tank.world.colliders[2].twist.velocity = velocity;
    tank.obstacles.prepare(tank.world);
    EXPECT_FALSE(tank.obstacles.changed());
    EXPECT_TRUE(tank.contact.set_velocities(tank.world, tank.obstacles));
    expect_same();
  }
  tank.world.colliders[1].surface_pose.position = {0.04, -0.03, 0};
  tank.obstacles.prepare(tank.world);
  EXPECT_TRUE(tank.obstacles.changed());
  tank.contact.prepare(tank.world, tank.obstacles);
  expect_same();
}

}  // namespace
}  // namespace dreampm::surface_contact_test
