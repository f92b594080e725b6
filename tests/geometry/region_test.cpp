#include "dreampm/geometry/region.h"

#include <gtest/gtest.h>

#include <array>
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
  for (const Shape& shape : {turned, ball, at(BoxShape{{2, 4, 6}}, {1, 0.3, 0}), of(CylinderShape{1, 4}),
                             of(BooleanShape{BooleanShape::Op::difference, {turned, ball}})}) {
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
