#include "dreampm/geometry/region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "dreampm/base/error.h"

using namespace dreampm;

namespace {

std::shared_ptr<const Region> make(const Shape& shape) { return make_region(shape, 0.01, {}); }
Shape of(auto form) {
  Shape s;
  s.form = form;
  return s;
}
Shape at(auto form, Vec3d center) {
  Shape s = of(form);
  s.center = center;
  return s;
}
constexpr double pi = std::numbers::pi;

TEST(Region, DistancesOfPrimitivesAreExact) {
  const auto box = make(at(BoxShape{{2, 4, 6}}, {1, 0, 0}));
  EXPECT_DOUBLE_EQ(box->distance({1, 0, 0}), -1);
  EXPECT_DOUBLE_EQ(box->distance({5, 0, 0}), 3);
  EXPECT_DOUBLE_EQ(box->distance({5, 6, 0}), 5);  // 3-4-5 from an edge
  const auto ball = make(of(SphereShape{2}));
  EXPECT_DOUBLE_EQ(ball->distance({0, 3, 4}), 3);
  const auto can = make(of(CylinderShape{1, 4}));
  EXPECT_DOUBLE_EQ(can->distance({0, 1.5, 0}), -0.5);
  EXPECT_DOUBLE_EQ(can->distance({4, 6, 0}), 5);
  const auto plane = make(of(PlaneShape{{0, 1, 0}, {0, 2, 0}}));
  EXPECT_DOUBLE_EQ(plane->distance({7, 0.25, -3}), -0.75);
}

/// Points about a shape, on its faces, beyond edges and inside.
std::vector<Vec3d> points_about(const Box3d& box) {
  std::vector<Vec3d> all;
  const Vec3d size = box.size();
  for (int i = -3; i <= 9; ++i)
    for (int j = -3; j <= 9; ++j)
      for (int k = -3; k <= 9; ++k)
        all.push_back(box.min + Vec3d{i / 6.0 * size.x, j / 6.0 * size.y, k / 6.01 * size.z});
  return all;
}

TEST(Region, ManyDistancesAtOnceHaveTheBitsOfOne) {
  Shape turned = at(BoxShape{{2, 4, 6}}, {1, 0.3, 0});
  turned.rotate_axis = {1, 2, 3}, turned.rotate_angle = 25;
  const Shape ball = at(SphereShape{1.5}, {0.5, 0.5, 2});
  for (const Shape& shape :
       {turned, ball, at(BoxShape{{2, 4, 6}}, {1, 0.3, 0}), of(CylinderShape{1, 4}),
        of(BooleanShape{BooleanShape::Op::difference, {turned, ball}}),
        of(ContainerShape{.hollow = {turned}, .wall = 0.2, .cut = {}}),
        of(ContainerShape{.hollow = {ball}, .wall = 0.2, .cut = {}, .form = ContainerShape::Form::shell})}) {
    const auto region = make(shape);
    const std::vector<Vec3d> points = points_about(region->bounds());
    std::array<std::vector<double>, 3> columns;
    for (const Vec3d& p : points)
      for (int a = 0; a < 3; ++a) columns[static_cast<std::size_t>(a)].push_back(p[a]);
    std::vector<double> found(points.size());
    region->distances({{columns[0].data(), columns[1].data(), columns[2].data()}, points.size()}, found.data());
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(found[i], region->distance(points[i]));
  }
}

TEST(Region, NormalsOfBoxesAreTheGradientsOfTheirDistances) {
  for (const Shape& shape : {of(BoxShape{{2, 4, 6}}), of(BoxShape{{1, 0.1, 0.1}})}) {
    const auto region = make(shape);
    for (const Vec3d& p : points_about(region->bounds()))
      EXPECT_EQ(region->normal(p), region->Region::normal(p)) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(Region, VolumesMatchTheFormulas) {
  EXPECT_NEAR(region_volume(*make(of(BoxShape{{1, 0.5, 0.3}})), 0.01), 0.15, 0.15e-3);
  EXPECT_NEAR(region_volume(*make(of(SphereShape{0.5})), 0.01), pi / 6, 1e-3 * pi / 6);
  EXPECT_NEAR(region_volume(*make(of(CylinderShape{0.5, 0.7})), 0.01), 0.175 * pi, 1e-3);
}

TEST(Region, RotatedAboutItsOwnCenterThenMoved) {
  Shape s = at(BoxShape{{2, 4, 6}}, {10, 0, 0});
  s.rotate_axis = {0, 0, 1}, s.rotate_angle = 90;
  const auto box = make(s);
  EXPECT_EQ(box->bounds().min, (Vec3d{8, -1, -3}));
  EXPECT_EQ(box->bounds().max, (Vec3d{12, 1, 3}));
  EXPECT_NEAR(box->distance({13, 0, 0}), 1, 1e-12);
  s.rotate_angle = 45;
  EXPECT_NEAR(make(s)->bounds().max.x, 10 + 3 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(region_volume(*make(s), 0.05), 48, 0.1);
}

TEST(Region, RotationTurnsCounterClockwiseAboutTheAxis) {
  Shape pair = of(BooleanShape{
      BooleanShape::Op::unite,
      {at(SphereShape{0.1}, {1, 0, 0}), at(SphereShape{0.1}, {-1, 0, 0}), at(SphereShape{0.3}, {0.5, 0, 0})}});
  pair.rotate_angle = 90;  // about y: +x goes to -z
  EXPECT_LT(make(pair)->distance({0, 0, -0.5}), 0);
  EXPECT_GT(make(pair)->distance({0, 0, 0.5}), 0);
}

TEST(Region, BooleansCombine) {
  using Op = BooleanShape::Op;
  const Shape a = of(BoxShape{{2, 2, 2}}), b = at(BoxShape{{2, 2, 2}}, {1, 0, 0});
  const auto unite = make(of(BooleanShape{Op::unite, {a, b}})), both = make(of(BooleanShape{Op::intersection, {a, b}})),
             less = make(of(BooleanShape{Op::difference, {a, b}}));
  EXPECT_NEAR(region_volume(*unite, 0.05), 12, 0.05);
  EXPECT_NEAR(region_volume(*both, 0.05), 4, 0.05);
  EXPECT_NEAR(region_volume(*less, 0.05), 4, 0.05);
  EXPECT_EQ(unite->bounds().max.x, 2);
  EXPECT_EQ(both->bounds().min.x, 0);
  EXPECT_NEAR(less->normal({-0.05, 0, 0.1}).x, 1, 1e-9);  // the cut face looks at what was taken away
}

Shape box(const Vec3d& low, const Vec3d& high) { return at(BoxShape{high - low}, (low + high) * 0.5); }

// A hollow that ends at the height of its block has no wall there, and none is felt: beside the
// mouth and above it the nearest place is the rim.
TEST(Region, AHollowFlushWithItsBlockIsOpen) {
  const Shape block = box({0.08, 0.1, 0.08}, {0.32, 0.3, 0.32});
  const auto cup =
      make(of(BooleanShape{BooleanShape::Op::difference, {block, box({0.1, 0.12, 0.1}, {0.3, 0.3, 0.3})}}));
  for (const double y : {0.27, 0.2999, 0.3, 0.3000001}) {
    EXPECT_NEAR(cup->distance({0.14, y, 0.2}), std::min(0.04, y - 0.12), 1e-6) << y;
    EXPECT_NEAR(cup->normal({0.14, y, 0.2}).x, 1, 1e-3) << y;
  }
  EXPECT_NEAR(cup->distance({0.13, 0.34, 0.2}), 0.05, 1e-9) << "3-4-5 from the rim";
  EXPECT_NEAR(cup->normal({0.13, 0.34, 0.2}).y, 0.8, 1e-9);
  EXPECT_NEAR(cup->distance({0.09, 0.295, 0.2}), -0.005, 1e-9) << "the rim itself is as it was";
  EXPECT_NEAR(region_volume(*cup, 0.01), 0.24 * 0.24 * 0.2 - 0.2 * 0.2 * 0.18, 2e-5);
  // A slot from side to side, by a cutter that ends at both.
  const auto slot =
      make(of(BooleanShape{BooleanShape::Op::difference, {block, box({0.08, 0.2, 0.16}, {0.32, 0.3, 0.24})}}));
  for (const double x : {0.0801, 0.08, 0.07}) EXPECT_GT(slot->distance({x, 0.26, 0.2}), 0.039) << x;
  for (const double y : {0.29, 0.3, 0.31}) EXPECT_GT(slot->distance({0.2, y, 0.2}), 0.039) << y;
}

// A window that is as thick as its wall: it ends at the outer face of the block and at that of the
// room. Parts of a union that touch are one, too.
TEST(Region, AWindowAsThickAsItsWallIsOpenOnBothSides) {
  using Op = BooleanShape::Op;
  const Shape block = box({0, 0, 0}, {1, 1, 1}), room = box({0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}),
              window = box({0.9, 0.3, 0.3}, {1, 0.7, 0.7});
  const Shape cutters[] = {of(BooleanShape{Op::difference, {block, room, window}}),
                           of(BooleanShape{Op::difference, {block, window, room}}),
                           of(BooleanShape{Op::difference, {block, of(BooleanShape{Op::unite, {room, window}})}})};
  for (const Shape& s : cutters) {
    const auto house = make(s);
    for (const double x : {0.8, 0.9, 0.95, 1.0, 1.05}) EXPECT_GT(house->distance({x, 0.5, 0.5}), 0.049) << x;
    EXPECT_NEAR(house->distance({0.9, 0.35, 0.5}), 0.05, 1e-4);
    EXPECT_NEAR(house->distance({0.95, 0.28, 0.5}), -0.02, 1e-9);
  }
  const auto wall = make(of(BooleanShape{Op::unite, {box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})}}));
  for (const double x : {0.8, 1.0, 1.2}) EXPECT_NEAR(wall->distance({x, 0.4, 0.5}), -0.4, 1e-9) << x;
}

TEST(Region, NormalsPointOutward) {
  const auto box = make(of(BoxShape{{2, 2, 2}}));
  EXPECT_NEAR(box->normal({1.5, 0.2, 0}).x, 1, 1e-9);
  const Vec3d n = make(at(SphereShape{1}, {0, 5, 0}))->normal({0, 4.5, 0.5});
  EXPECT_NEAR(n.y, -std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(n.z, std::sqrt(0.5), 1e-9);
}

TEST(Region, RefusesWhatCannotBe) {
  EXPECT_THROW(make(of(SphereShape{-1})), InputError);
  EXPECT_THROW(make(of(BoxShape{{1, 0, 1}})), InputError);
  EXPECT_THROW(make(of(PlaneShape{{}, {0, 0, 0}})), InputError);
  EXPECT_THROW(make(of(PointsShape{"a.ply", 1})), InputError);
  EXPECT_THROW(make(of(MeshShape{"a.ply", {}, {}})), InputError);
  EXPECT_THROW(make(of(BooleanShape{})), InputError);
  EXPECT_THROW(make(at(SphereShape{1}, {0, std::numeric_limits<double>::quiet_NaN(), 0})), InputError);
  EXPECT_THROW(region_volume(*make(of(PlaneShape{})), 0.1), InputError);
}

}  // namespace
