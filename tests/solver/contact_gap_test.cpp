// Solids and grains come to rest on what they touch, not a cell above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "worlds.h"

namespace dreampm::contact_gap_test {
namespace {
using namespace dreampm::test;

constexpr double dx = 0.02, edge = 0.06;

struct Fall {
  std::string_view material = "snow";
  WallType type = WallType::separate;
  double friction = 0;
  Shape floor = {};   ///< of a collider
  double ground = 0;  ///< its top [m]; 0: the wall of the box
  double spacing = 0.01;
  TransferRule<double> transfer = {};
};

/// How far the lowest particles come to rest from the floor [spacings].
struct Rest {
  double mean;   ///< of the lowest row
  double least;  ///< of all
};

/// A cube falls by 3 cm.
Rest rest_of(const Fall& fall) {
  World<float> w = empty_world<float>(dx, {12, 12, 12});
  w.gravity = {0, -9.81, 0};
  w.settings.fps = 1 / 0.4;
  w.settings.damping = 4;  // Jelly bounces.
  for (Wall& wall : w.walls) wall = {fall.type, fall.friction, false};
  if (fall.ground > 0) w.colliders = {{"floor", make_region(fall.floor, dx, {}), fall.type, fall.friction}};
  Values values = values_of(fall.material, {});
  if (fall.material == "sand") values = values_of(fall.material, {{"youngs_modulus", 1e6}});
  add_set(w, fall.material, values, fall.spacing);
  w.sets[0].transfer = fall.transfer;
  const Vec3d low{0.12 - edge / 2, fall.ground + 0.03, 0.12 - edge / 2};
  const std::vector<ParticleSeed> cube = lattice({low, low + Vec3d{edge, edge, edge}}, fall.spacing, still());
  const auto backend = make_cpu_backend();
  begin(w, *backend, {cube});
  while (w.frame == 1) step<float>(w, *backend, nullptr);
  const std::vector<Vec3d> x = positions_by_id(w);
  const auto away = [&](std::uint32_t id) {
    return (fall.ground > 0 ? w.colliders[0].shape->distance(x[id]) : x[id].y) / fall.spacing;
  };
  Rest rest{0, std::numeric_limits<double>::infinity()};
  int count = 0;
  for (const ParticleSeed& n : cube) {
    rest.least = std::min(rest.least, away(n.id));
    if (n.position.y < low.y + fall.spacing) rest.mean += away(n.id), ++count;
  }
  rest.mean /= count;
  return rest;
}

Shape block_below(double ground, double thickness = 1) {
  Shape s;
  s.form = BoxShape{{1, thickness, 1}};
  s.center = {0.12, ground - thickness / 2, 0.12};
  return s;
}

void expect_on_the_floor(const Fall& fall) {
  const Rest rest = rest_of(fall);
  SCOPED_TRACE(testing::Message() << fall.material << ", type " << static_cast<int>(fall.type) << ", friction "
                                  << fall.friction << ", ground " << fall.ground << ", spacing " << fall.spacing);
  EXPECT_LE(rest.mean, 0.75);
  EXPECT_GE(rest.least, 0.24);
}

TEST(ContactGap, ClosesOverEveryTypeOfWallAndCollider) {
  for (const std::string_view material : {"snow", "elastic", "sand"})
    for (const auto& [type, friction] :
         {std::pair{WallType::separate, 0.0}, {WallType::separate, 0.5}, {WallType::slip, 0.0}, {WallType::stick, 0.0}})
      for (const double ground : {0.0, 0.065})
        expect_on_the_floor({material, type, friction, block_below(ground), ground});
}

TEST(ContactGap, ClosesWhereverAColliderCutsTheCells) {
  for (const double ground : {0.06, 0.07, 0.075})
    for (const WallType type : {WallType::separate, WallType::stick})
      expect_on_the_floor({"snow", type, 0, block_below(ground), ground});
  expect_on_the_floor({"snow", WallType::separate, 0, block_below(0.065, 0.6 * dx), 0.065});  // thinner than a cell
  // Points of the far side, which take no part, have nodes in common with those that hold.
  for (const double friction : {0.0, 0.5})
    expect_on_the_floor({"snow", WallType::separate, friction, block_below(0.065, 1.2 * dx), 0.065});
  Shape ball;
  ball.form = SphereShape{0.1};
  ball.center = {0.12, -0.03, 0.12};
  const Rest rest = rest_of({"snow", WallType::separate, 0, ball, 0.07});
  EXPECT_LE(rest.least, 0.75);
  EXPECT_GE(rest.least, 0.24);
}

TEST(ContactGap, IsMeasuredInSpacings) {
  for (const double spacing : {0.02, 0.02 / 3})
    for (const double ground : {0.0, 0.065})
      expect_on_the_floor({"snow", WallType::separate, 0, block_below(ground), ground, spacing});
  expect_on_the_floor({"snow", WallType::separate, 0, {}, 0, 0.01, {1, 0.95, 1}});
}

}  // namespace
}  // namespace dreampm::contact_gap_test
