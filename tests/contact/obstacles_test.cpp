// Obstacles: colliders near nodes, with the same results whenever they are asked for.
#include "dreampm/contact/obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/base/parallel.h"
#include "dreampm/contact/collider_view.h"
#include "dreampm/state/regroup.h"

namespace dreampm::obstacles_test {
namespace {

std::shared_ptr<const Region> ball(const Vec3d& center, double radius) {
  Shape s;
  s.form = SphereShape{radius};
  s.center = center;
  return make_region(s, 0.01, {});
}

/// A ball in the corner of a box, and another that a periodic axis cuts in two.
World<float> world_of(bool periodic) {
  World<float> w;
  w.dx = 0.1;
  w.origin = {1, 2, 3};
  w.low = Vec3i{-2, 3, 0} * block_width;
  w.high = w.low + Vec3i{32, 24, 24};
  w.periodic = {periodic, false, false};
  w.colliders.push_back({"corner", ball({1.5, 2.3, 3.2}, 0.41), WallType::stick, 0});
  w.colliders.push_back({"seam", ball({4.2, 3.2, 4.4}, 0.6), WallType::slip, 0});
  return w;
}

/// The place before all closed walls whose image is `p`.
Vec3d before_walls(const World<float>& w, Vec3d p) {
  const Vec3d low = w.node_position(w.low), high = w.node_position(w.high);
  for (int a = 0; a < 3; ++a) p[a] = p[a] < low[a] ? 2 * low[a] - p[a] : p[a] > high[a] ? 2 * high[a] - p[a] : p[a];
  return p;
}

void lay_blocks(World<float>& w, const Vec3i& first, const Vec3i& count) {
  std::vector<Vec3i> blocks;
  for (int i = 0; i < count.x; ++i)
    for (int j = 0; j < count.y; ++j)
      for (int k = 0; k < count.z; ++k) blocks.push_back(first + Vec3i{i, j, k});
  w.grid.blocks.assign(blocks);
}

bool same(const ObstacleNode& a, const ObstacleNode& b) {
  return a.node == b.node && a.collider == b.collider && a.inside == b.inside && a.deep == b.deep &&
         a.blocked == b.blocked && a.taken == b.taken && a.normal == b.normal;
}

TEST(Obstacles, EveryNodeNearAColliderIsThere) {
  for (const bool periodic : {false, true}) {
    World<float> w = world_of(periodic);
    lay_blocks(w, {-2, 3, 0}, {8, 6, 6});
    Obstacles obstacles;
    obstacles.prepare(w);
    int deep = 0;
    double blocked[2]{};
    for (std::size_t b = 0; b < w.grid.blocks.size(); ++b) {
      std::vector<ObstacleNode> left = obstacles.at(b);
      for (int n = 0; n < block_nodes; ++n)
        for (std::uint8_t c = 0; c < 2; ++c) {
          Vec3d p = w.node_position(w.grid.blocks[b] * block_width + node_offset(n));
          if (!periodic) p = before_walls(w, p);
          double d = w.colliders[c].shape->distance(p);
          // The nearest place on a ball that walls cut may lie behind them, where there is no
          // matter.
          const Vec3d normal = w.colliders[c].shape->normal(p),
                      before = p - normal * (d - ColliderView::before_face * w.dx);
          if (d < ColliderView::slit * w.dx && length(before_walls(w, before) - before) > 0) continue;
          if (periodic)
            for (const double side : {-3.2, 3.2})
              d = std::min(d, w.colliders[c].shape->distance(p + Vec3d{side, 0, 0}));
          const auto it = std::find_if(left.begin(), left.end(),
                                       [&](const ObstacleNode& o) { return o.node == n && o.collider == c; });
          // A quadratic kernel reaches 1.5 cells; where it just does so, it may or may not count.
          if (std::abs(d - 0.15) > 1e-9) {
            ASSERT_EQ(it != left.end(), d < 0.15) << d;
          }
          if (it == left.end()) continue;
          if (std::abs(d + 0.12) > 1e-6) {
            EXPECT_EQ(it->deep, d < -0.12);
          }
          if (std::abs(d) > 1e-6) {
            EXPECT_EQ(it->inside, d < 0);
          }
          deep += it->deep;
          blocked[c] += static_cast<double>(it->blocked);
          if (it->inside) {
            EXPECT_NEAR(length(it->normal), 1, 1e-9);
          }
        }
    }
    EXPECT_GT(deep, 200);
    // Each node has a cell: together they block the volume of a ball. The end of the domain halves
    // the second one, where that is no seam, and half of the middle layer of cells has its nodes on
    // that end, outside of these blocks. That a surface is taken for a plane adds a few percent.
    const double pi = std::numbers::pi;
    const double cells[]{4.0 / 3 * pi * std::pow(4.1, 3), 4.0 / 3 * pi * 216 * (periodic ? 1 : 0.5)};
    EXPECT_NEAR(blocked[1] / (cells[1] - (periodic ? 0 : 0.5 * pi * 36)), 1.025, 0.025);
    EXPECT_LT(blocked[0], 1.1 * cells[0]);
  }
}

/// All points of the blocks' surfaces: sum of area [m^2], of area times normal, and the largest
/// distance from it.
struct Surface {
  double area = 0, off = 0;
  Vec3d closed{};
};
Surface surface_of(const World<float>& w, const Obstacles& obstacles) {
  Surface all;
  for (std::size_t b = 0; b < w.grid.blocks.size(); ++b)
    for (const SurfacePoint& p : obstacles.points(b)) {
      const double area = static_cast<double>(p.area) * w.dx * w.dx;
      const Vec3d at = w.node_position(w.grid.blocks[b] * block_width) + static_cast<Vec3d>(p.at) * w.dx;
      all.area += area;
      all.closed += static_cast<Vec3d>(p.normal) * area;
      all.off = std::max(all.off, std::abs(w.colliders[p.collider].shape->distance(at)));
      for (std::size_t a = 0; a < 3; ++a) EXPECT_LE(std::abs(p.at[static_cast<int>(a)] - p.first[a] - 1), 0.5f);
      EXPECT_NEAR(length(static_cast<Vec3d>(p.normal)), 1, 1e-6);
    }
  return all;
}

TEST(Obstacles, PointsStandForAllOfASurfaceOnce) {
  World<float> w = world_of(false);
  const double pi = std::numbers::pi, radius = 0.6;
  w.colliders = {{"ball", ball({2.53, 3.17, 4.21}, radius), WallType::slip, 0}};
  lay_blocks(w, {-2, 3, 0}, {8, 6, 6});
  Obstacles round;
  round.prepare(w);
  const Surface ball = surface_of(w, round);
  EXPECT_NEAR(ball.area, 4 * pi * radius * radius, 0.005 * ball.area);
  EXPECT_LT(length(ball.closed), 0.005 * ball.area);
  EXPECT_LT(ball.off, 0.003);  // in the middle of a patch that bends

  // Some of the area within a quarter of a cell of an edge is missed.
  double area = 0;
  constexpr int turns = 30;
  for (int i = 0; i < turns; ++i) {
    Shape turned;
    turned.form = BoxShape{{0.8, 0.6, 0.7}};
    turned.center = Vec3d{2.53, 3.17, 4.21} + Vec3d{0.0013, 0.0029, 0.0037} * i;
    turned.rotate_axis = {1, 2, 0.5}, turned.rotate_angle = 11 * i;
    w.colliders[0].shape = make_region(turned, w.dx, {});
    Obstacles box;
    box.prepare(w);
    const Surface sides = surface_of(w, box);
    EXPECT_LT(length(sides.closed), 0.05 * sides.area);
    area += sides.area / turns;
  }
  const double want = 2 * (0.8 * 0.6 + 0.6 * 0.7 + 0.7 * 0.8);
  EXPECT_NEAR(area, want, 0.02 * want);
}

std::shared_ptr<const Region> box(const Vec3d& low, const Vec3d& high, const Vec3d& axis = {0, 1, 0},
                                  double angle = 0) {
  Shape s;
  s.form = BoxShape{high - low};
  s.center = (low + high) * 0.5;
  s.rotate_axis = axis, s.rotate_angle = angle;
  return make_region(s, 0.01, {});
}

/// Nodes and surfaces must see the same solid in two worlds, whichever collider takes a node's
/// kernel.
void expect_same_solid(const std::vector<Collider>& one, const std::vector<Collider>& other, double within = 1e-3) {
  World<float> w = world_of(false);
  const auto see = [&](const std::vector<Collider>& colliders) {
    w.colliders = colliders;
    lay_blocks(w, {-2, 3, 0}, {8, 6, 6});
    Obstacles seen;
    seen.prepare(w);
    return seen;
  };
  const Obstacles a = see(one), b = see(other);
  int inside = 0, points = 0;
  for (std::size_t block = 0; block < w.grid.blocks.size(); ++block) {
    std::array<float, block_nodes> taken{}, also{};
    for (const ObstacleNode& n : a.at(block)) taken[n.node] += n.blocked, inside += n.inside;
    for (const ObstacleNode& n : b.at(block)) also[n.node] += n.blocked;
    double area = 0;
    Vec3d middle{};
    const auto add = [&](const Obstacles& of, double sign) {
      for (const SurfacePoint& p : of.points(block)) {
        area += sign * static_cast<double>(p.area), middle += static_cast<Vec3d>(p.at * p.area) * sign;
        EXPECT_EQ(dot(p.from_edge, p.from_edge), 0) << "no edge anywhere";
        ++points;
      }
    };
    add(a, 1), add(b, -1);
    EXPECT_NEAR(area, 0, within);
    EXPECT_NEAR(length(middle), 0, within);
    for (std::size_t n = 0; n < block_nodes; ++n) {
      const Vec3d p = w.node_position(w.grid.blocks[block] * block_width + node_offset(static_cast<int>(n)));
      // The kernel's part in colliders with faces askew to each other is an estimate.
      EXPECT_NEAR(taken[n], also[n], std::max(within, 0.1)) << p.x << " " << p.y << " " << p.z;
      const auto at = block * block_nodes + n;
      const Node<float>&c = a.clearance()[at], &d = b.clearance()[at];
      EXPECT_NEAR(c.m, d.m, within) << p.x << " " << p.y << " " << p.z;
      const Vec3<float> turn{c.x - d.x, c.y - d.y, c.z - d.z};
      EXPECT_NEAR(std::abs(c.m) < 2 ? length(turn) : 0, 0, within);
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(points, 100);
}

// The box of the world lies from (1, 2, 3) to (4.2, 4.4, 5.4), in cells of 0.1.
TEST(Obstacles, AColliderThatEndsOnAWallHasNoEdgeThere) {
  for (const double wide : {0.1, 0.23, 0.7}) {
    const auto plate = [&](double beyond, double gap) {
      return std::vector<Collider>{{"plate", box({2.03, 2 - beyond + gap, 3 - beyond + gap},
                                                 {2.03 + wide, 4.4 + beyond - gap, 5.4 + beyond - gap})}};
    };
    expect_same_solid(plate(0, 0), plate(1, 0));
    expect_same_solid(plate(0, 0.004), plate(1, 0), 0.15);  // a slit of 0.04 cells
  }
  const auto slab = [](double x, double beyond) {
    return std::vector<Collider>{{"floor", box({x, 2 - beyond, 3 - beyond}, {4.2 + beyond, 2.37, 5.4 + beyond})}};
  };
  expect_same_solid(slab(1, 0), slab(-1, 1));
}

TEST(Obstacles, CollidersThatTouchAreOneSolid) {
  const auto wall = [](double x, double y, double to_y, double z, double to_z) {
    return Collider{"wall", box({x, y, z}, {x + 0.6, to_y, to_z})};
  };
  expect_same_solid({wall(2.03, 1, 3.17, 2, 6), wall(2.03, 3.17, 5, 2, 6)}, {wall(2.03, 1, 5, 2, 6)});
  expect_same_solid({wall(2.03, 1, 5, 2, 4.05), wall(2.03, 1, 5, 4.05, 6)}, {wall(2.03, 1, 5, 2, 6)});
  // A plate askew, cut across.
  const auto askew = [](double from, double to) {
    const double turn = 0.5, middle = 0.5 * (from + to);
    Shape s;
    s.form = BoxShape{{to - from, 0.62, 9}};
    s.center = Vec3d{2.6 + middle * std::cos(turn), 3.2 + middle * std::sin(turn), 4.2};
    s.rotate_axis = {0, 0, 1}, s.rotate_angle = turn * 180 / std::numbers::pi;
    return Collider{"askew", make_region(s, 0.01, {})};
  };
  expect_same_solid({askew(-5, 0.012), askew(0.012, 5)}, {askew(-5, 5)});
}

/// The part of a quadratic B-spline further than d along an axis.
double kernel_beyond(double d) {
  double sum = 0;
  constexpr int parts = 3000;
  for (int i = 0; i < parts; ++i) {
    const double x = std::abs(-1.5 + (i + 0.5) * 3 / parts);
    if (-1.5 + (i + 0.5) * 3 / parts > d) sum += (x < 0.5 ? 0.75 - x * x : 0.5 * (1.5 - x) * (1.5 - x)) * 3 / parts;
  }
  return sum;
}

// The floor and the wall of a tub take all of a node's kernel but the part beyond both, however the
// tub is put together. Beside the corner each half of a cell has a point.
TEST(Obstacles, InTheCornerOfATubBothFacesTakeTheirPart) {
  for (const bool of_boxes : {false, true})
    for (const double off : {0.0, 0.025, 0.05, 0.085}) {
      World<float> w = world_of(false);
      const double left = 2 + off, bottom = 3 + off;
      if (of_boxes) {
        w.colliders = {{"floor", box({-9, -9, -9}, {9, bottom, 9})}, {"wall", box({-9, -9, -9}, {left, 9, 9})}};
      } else {
        const auto part = [](const Vec3d& low, const Vec3d& high) {
          Shape s;
          s.form = BoxShape{high - low};
          s.center = (low + high) * 0.5;
          return s;
        };
        Shape s;
        s.form = BooleanShape{BooleanShape::Op::difference,
                              {part({-9, -9, -9}, {9, 9, 9}), part({left, bottom, -20}, {20, 20, 20})}};
        w.colliders = {{"tub", make_region(s, 0.01, {})}};
      }
      lay_blocks(w, {-1, 4, 2}, {4, 3, 2});
      Obstacles obstacles;
      obstacles.prepare(w);
      int beside = 0;
      for (std::size_t b = 0; b < w.grid.blocks.size(); ++b) {
        std::array<double, block_nodes> taken{};
        for (const ObstacleNode& o : obstacles.at(b)) taken[o.node] += static_cast<double>(o.taken);
        for (int n = 0; n < block_nodes; ++n) {
          const Vec3d p = w.node_position(w.grid.blocks[b] * block_width + node_offset(n));
          const double open = kernel_beyond((left - p.x) / w.dx) * kernel_beyond((bottom - p.y) / w.dx);
          EXPECT_NEAR(taken[static_cast<std::size_t>(n)], 1 - open, 0.01) << of_boxes << ' ' << off;
        }
        for (const SurfacePoint& p : obstacles.points(b)) {
          const Vec3d at = w.node_position(w.grid.blocks[b] * block_width) + static_cast<Vec3d>(p.at) * w.dx;
          if (std::abs(at.x - left) > 0.5 * w.dx || std::abs(at.y - bottom) > 0.5 * w.dx) continue;
          EXPECT_LT(p.area, 0.51f);
          ++beside;
        }
      }
      EXPECT_GE(beside, 16);  // in 8 cells along the corner, on both faces
    }
}

TEST(Obstacles, TheCacheTellsWhatANewOneTells) {
  for (const int threads : {1, 5}) {
    const ThreadLimit limit(threads);
    World<float> w = world_of(true);
    Obstacles kept;
    const std::pair<Vec3i, Vec3i> grids[]{{{-2, 3, 0}, {3, 3, 3}}, {{-1, 3, 1}, {5, 3, 4}}, {{3, 4, 2}, {3, 5, 4}},
                                          {{-2, 3, 0}, {1, 1, 1}}, {{0, 0, 0}, {0, 0, 0}},  {{-2, 3, 0}, {8, 6, 6}},
                                          {{-2, 3, 0}, {3, 3, 3}}};
    std::size_t nodes = 0;
    for (const auto& [first, count] : grids) {
      lay_blocks(w, first, count);
      kept.prepare(w);
      Obstacles fresh;
      fresh.prepare(w);
      EXPECT_TRUE(kept.any());
      for (std::size_t b = 0; b < w.grid.blocks.size(); ++b) {
        ASSERT_EQ(kept.at(b).size(), fresh.at(b).size());
        for (std::size_t i = 0; i < kept.at(b).size(); ++i) EXPECT_TRUE(same(kept.at(b)[i], fresh.at(b)[i]));
        nodes += kept.at(b).size();
      }
    }
    EXPECT_GT(nodes, 1000u);
    w.colliders.clear();
    kept.prepare(w);
    EXPECT_FALSE(kept.any());
    for (std::size_t b = 0; b < w.grid.blocks.size(); ++b) EXPECT_TRUE(kept.at(b).empty());
  }
}

}  // namespace
}  // namespace dreampm::obstacles_test
