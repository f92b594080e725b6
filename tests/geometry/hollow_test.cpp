// How full a hollow is: cups whose filling is known.
#include "dreampm/geometry/hollow.h"

#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/geometry/sample.h"

namespace dreampm::hollow_test {
namespace {

using Op = BooleanShape::Op;
constexpr double spacing = 0.01, dx = 2 * spacing, particle = spacing * spacing * spacing;
constexpr Vec3d up{0, 1, 0};

Shape of(auto form) {
  Shape s;
  s.form = form;
  return s;
}
Shape box(const Vec3d& low, const Vec3d& high) {
  Shape s = of(BoxShape{high - low});
  s.center = (low + high) * 0.5;
  return s;
}
Shape ball(const Vec3d& center, double radius) {
  Shape s = of(SphereShape{radius});
  s.center = center;
  return s;
}
Shape combination(Op op, std::vector<Shape> parts) { return of(BooleanShape{op, std::move(parts)}); }
/// The hollow of a container where it stands.
PlacedHollow hollow_in(const Shape& container) { return *hollow_of(*make_region(container, 0.01, {})); }
PlacedHollow about(const Shape& shape) {
  ContainerShape c;
  c.hollow = {shape};
  c.wall = 0.05, c.cut = 0;
  return hollow_in(of(c));
}
/// Particles as a body of that shape has them.
std::vector<Vec3d> particles(const Shape& shape) {
  return sample_region(*make_region(shape, spacing, {}), spacing, Pattern::jitter, 1);
}

// Walls that fall between grid points.
const Vec3d low{0.003, 0.004, 0.007}, high{0.317, 0.288, 0.259};
constexpr double cup_volume = 0.314 * 0.284 * 0.252;

TEST(Hollow, ACupHoldsItsVolume) {
  const HollowCells cup = hollow_cells(about(box(low, high)), dx, up);
  EXPECT_NEAR(cup.volume / cup_volume, 1, 0.005);
  EXPECT_NEAR(cup.reachable / cup_volume, 1, 0.005);
  EXPECT_DOUBLE_EQ(cup.spill, high.y);
}

TEST(Hollow, FullToTheBrimIsAll) {
  const HollowCells cup = hollow_cells(about(box(low, high)), dx, up);
  const Fill full = fill_of(cup, particles(box(low, high)), particle);
  EXPECT_GE(full.filled / cup.reachable, 0.98);
  EXPECT_LE(full.filled / cup.reachable, 1.0 + 1e-6);
  EXPECT_EQ(full.leaked, 0);
  EXPECT_TRUE(full.pockets.empty());
}

TEST(Hollow, HalfFullIsHalf) {
  const HollowCells cup = hollow_cells(about(box(low, high)), dx, up);
  for (const double part : {0.25, 0.5, 0.75}) {
    const Vec3d level{high.x, low.y + part * (high.y - low.y), high.z};
    const Fill fill = fill_of(cup, particles(box(low, level)), particle);
    // The level is known to half a cell.
    EXPECT_NEAR(fill.filled / cup.reachable, part, 0.5 * dx / (high.y - low.y) + 0.01);
    EXPECT_TRUE(fill.pockets.empty()) << "the air above is no pocket";
  }
  EXPECT_EQ(fill_of(cup, {}, particle).filled, 0);
}

TEST(Hollow, ABellIsAPocket) {
  // A cup with a bell in it that opens downward, whose inside stays dry.
  const Vec3d bell_low{0.1, 0.1, 0.08}, bell_high{0.22, 0.22, 0.2};
  const Shape dry = box({0.12, 0.1, 0.1}, {0.2, 0.2, 0.18});
  const Shape bell = combination(Op::difference, {box(bell_low, bell_high), dry});
  const Shape room = combination(Op::difference, {box(low, high), bell});
  const HollowCells cup = hollow_cells(about(room), dx, up);
  constexpr double inside = 0.08 * 0.1 * 0.08, metal = 0.12 * 0.12 * 0.12 - inside;
  EXPECT_NEAR(cup.reachable / (cup_volume - metal), 1, 0.01) << "it can be reached, from below";
  const Fill fill = fill_of(cup, particles(combination(Op::difference, {room, dry})), particle);
  ASSERT_EQ(fill.pockets.size(), 1u);
  EXPECT_NEAR(fill.pockets[0].volume / inside, 1, 0.15);
  EXPECT_NEAR(length(fill.pockets[0].at - Vec3d{0.16, 0.15, 0.14}), 0, 0.5 * dx);
  EXPECT_NEAR((fill.filled + fill.pockets[0].volume) / cup.reachable, 1, 0.01);
}

TEST(Hollow, ACavityOfItsOwnCannotBeReached) {
  const Vec3d top{0.3, 0.3, 0.3};
  const Shape two = combination(Op::unite, {box({0, 0, 0}, top), box({0.4, 0, 0}, {0.6, 0.2, 0.2})});
  const HollowCells cells = hollow_cells(about(two), dx, up);
  EXPECT_NEAR(cells.volume / (0.027 + 0.008), 1, 0.01);
  EXPECT_NEAR(cells.reachable / 0.027, 1, 0.01);
  const auto joined_by = [&](double width) {
    const Shape tunnel = box({0.29, 0.05, 0.05}, {0.41, 0.05 + width, 0.05 + width});
    return hollow_cells(about(combination(Op::unite, {two, tunnel})), dx, up).reachable;
  };
  EXPECT_NEAR(joined_by(3 * dx) / 0.035, 1, 0.02);
  EXPECT_LT(joined_by(1.2 * dx), 0.028) << "a passage of one cell is none";
}

TEST(Hollow, WhatStandsInItTakesRoom) {
  const auto post = make_region(box({0.1, -1, 0.1}, {0.2, 1, 0.2}), spacing, {});
  const HollowCells cup = hollow_cells(about(box(low, high)), dx, up, std::vector{post});
  EXPECT_NEAR(cup.reachable / (cup_volume - 0.01 * 0.284), 1, 0.01);
}

TEST(Hollow, LiquidOutsideAndBelowTheRimHasLeaked) {
  const HollowCells cup = hollow_cells(about(box(low, high)), dx, up);
  const double side = high.x + 0.05;
  std::vector<Vec3d> points = particles(box({side + 0.05, low.y, low.z}, {side + 0.15, low.y + 0.1, low.z + 0.1}));
  EXPECT_NEAR(fill_of(cup, points, particle).leaked, 0.001, 1e-4);
  EXPECT_EQ(fill_of(cup, points, particle).filled, 0);
  for (Vec3d& p : points) p.y += 1;
  EXPECT_EQ(fill_of(cup, points, particle).leaked, 0) << "above the rim it has only missed";
  const std::vector<Vec3d> at_wall{{high.x + 0.4 * dx, 0.1, 0.1}};
  EXPECT_EQ(fill_of(cup, at_wall, particle).leaked, 0) << "surfaces are known to half a cell";
}

TEST(Hollow, ATippedCupHoldsUpToItsLowestRim) {
  ContainerShape c;
  c.hollow = {box({0, 0, 0}, {0.2, 0.4, 0.3})};
  c.wall = 0.05, c.cut = 0;
  Shape tipped = of(c);
  constexpr double degrees = 20;
  tipped.rotate_axis = {0, 0, 1}, tipped.rotate_angle = degrees;
  const HollowCells cup = hollow_cells(hollow_in(tipped), dx, up);
  // The wedge between the rim's corner and the level through it stays empty.
  const double wedge = 0.5 * 0.2 * 0.2 * std::tan(degrees * std::numbers::pi / 180) * 0.3;
  EXPECT_NEAR(cup.reachable / (0.024 - wedge), 1, 0.03);
  EXPECT_NEAR(cup.volume / 0.024, 1, 0.01);
}

TEST(Hollow, ABallIsReachedThroughItsMouth) {
  ContainerShape c;
  c.hollow = {ball({0, 0, 0}, 0.2)};
  c.wall = 0.05, c.cut = 0.04;
  const HollowCells cells = hollow_cells(hollow_in(of(c)), dx, up);
  EXPECT_NEAR(cells.reachable / cells.volume, 1, 0.01);
  c.cut = 0.0003;  // the mouth is 2.2 cm wide, just over a cell
  EXPECT_EQ(hollow_cells(hollow_in(of(c)), dx, up).reachable, 0);
}

}  // namespace
}  // namespace dreampm::hollow_test
