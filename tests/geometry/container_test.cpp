// Containers: the box or the wall about a hollow, and its mouth.
#include "dreampm/geometry/container.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/base/error.h"

namespace dreampm::container_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double pi = std::numbers::pi;

Shape of(auto form) {
  Shape s;
  s.form = form;
  return s;
}
Shape at(auto form, const Vec3d& center) {
  Shape s = of(form);
  s.center = center;
  return s;
}
ContainerShape about(const Shape& hollow, double wall) {
  ContainerShape c;
  c.hollow = {hollow};
  c.wall = wall;
  return c;
}
/// The hollow of a container where it stands.
PlacedHollow hollow_in(const Shape& container) { return *hollow_of(*make_region(container, 0.01, {})); }
ContainerParts parts(const ContainerShape& c, double voxel = 0.01) { return container_parts(c, voxel, {}, 0); }

TEST(Container, IsTheGrownBoxWithoutItsHollow) {
  ContainerShape cup = about(of(BoxShape{{0.4, 0.5, 0.6}}), 0.05);
  cup.cut = 0.1;
  const ContainerParts p = parts(cup);
  EXPECT_NEAR(length(p.box.min - Vec3d{-0.25, -0.3, -0.35}), 0, 1e-12);
  EXPECT_NEAR(length(p.box.max - Vec3d{0.25, 0.15, 0.35}), 0, 1e-12);
  EXPECT_NEAR(p.mouth, 0.24, 1e-9);
  EXPECT_NEAR(region_volume(*p.hollow, 0.01), 0.4 * 0.4 * 0.6, 1e-4);
  EXPECT_NEAR(region_volume(*p.solid, 0.01), 0.5 * 0.45 * 0.7 - 0.4 * 0.4 * 0.6, 1e-4);
  EXPECT_LT(p.solid->distance({0, -0.29, 0}), 0) << "the bottom";
  EXPECT_GT(p.solid->distance({0, 0.149, 0}), 0) << "the mouth";
  cup.cut.reset();
  EXPECT_NEAR(parts(cup).box.max.y, 0.25 - default_cut * 0.5, 1e-12);
  cup.cut = 0;
  EXPECT_NEAR(parts(cup).mouth, 0.24, 1e-9) << "a flat top is a mouth without a cut";
}

TEST(Container, AShellFollowsItsHollow) {
  ContainerShape bowl = about(of(SphereShape{0.2}), 0.03);
  bowl.form = ContainerShape::Form::shell;
  bowl.cut = 0.2;
  const ContainerParts p = parts(bowl);
  EXPECT_NEAR(p.mouth, pi * 0.04, 1e-3);
  const auto half_ball = [](double r) { return 2.0 / 3 * pi * r * r * r; };
  EXPECT_NEAR(region_volume(*p.hollow, 0.01), half_ball(0.2), 1e-4);
  EXPECT_NEAR(region_volume(*p.solid, 0.005), half_ball(0.23) - half_ball(0.2), 1e-4);
  EXPECT_NEAR(p.solid->distance({0, -0.215, 0}), -0.015, 1e-12) << "in the middle of the wall";
  EXPECT_NEAR(p.solid->distance({0, -0.25, 0}), 0.02, 1e-12);
}

TEST(Container, UpTurnsTheHollow) {
  // A flask: wide below, with a thin neck. Upside down its flat bottom becomes the mouth.
  const Shape flask = of(BooleanShape{
      BooleanShape::Op::unite, {at(BoxShape{{0.4, 0.2, 0.4}}, {0, 0, 0}), at(BoxShape{{0.1, 0.4, 0.1}}, {0, 0.2, 0})}});
  ContainerShape c = about(flask, 0.02);
  c.cut = 0.05;
  EXPECT_NEAR(parts(c).mouth, 0.01, 1e-4);
  c.up = {0, -3, 0};
  EXPECT_NEAR(parts(c).mouth, 0.16, 1e-3);
  c.up = {1, 0, 0};  // lies on its side
  EXPECT_NEAR(parts(c).mouth, 0.4 * 0.2, 1e-3);
  EXPECT_NEAR(parts(c).box.size().x, 0.5 + 0.04, 1e-9);
  EXPECT_NEAR(parts(c).box.size().y, 0.4 + 0.02 - 0.05, 1e-9);
}

TEST(Container, StandsWhereItsBoxIsPut) {
  ContainerShape c = about(at(SphereShape{0.2}, {7, 8, 9}), 0.03);
  Shape cup = at(c, {1, 2, 3});
  const auto region = make_region(cup, 0.01, {});
  EXPECT_NEAR(length(region->bounds().center() - Vec3d{1, 2, 3}), 0, 1e-12);
  const PlacedHollow hollow = hollow_in(cup);
  EXPECT_NEAR(hollow.mouth.y, region->bounds().max.y, 1e-12);
  EXPECT_NEAR(hollow.region->bounds().min.y, region->bounds().min.y + 0.03, 1e-12);
  cup.rotate_axis = {0, 0, 1}, cup.rotate_angle = 90;
  const PlacedHollow tipped = hollow_in(cup);
  EXPECT_NEAR(length(tipped.normal - Vec3d{-1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(tipped.mouth.x, make_region(cup, 0.01, {})->bounds().min.x, 1e-12);
}

TEST(Container, BoundsAreThoseOfWhatIsThere) {
  constexpr double tolerance = 1e-3;
  Shape turned = of(CylinderShape{0.1, 0.6});
  turned.rotate_axis = {0, 0, 1}, turned.rotate_angle = 30;
  const auto region = make_region(turned, 0.01, {});
  const Box3d tight = tight_bounds(*region, tolerance);
  EXPECT_NEAR(tight.max.y, 0.3 * std::cos(pi / 6) + 0.1 * std::sin(pi / 6), tolerance);
  EXPECT_NEAR(tight.min.x, -(0.3 * std::sin(pi / 6) + 0.1 * std::cos(pi / 6)), tolerance);
  EXPECT_NEAR(tight.max.z, 0.1, tolerance);
  const Shape half =
      of(BooleanShape{BooleanShape::Op::difference, {of(SphereShape{0.3}), at(BoxShape{{1, 1, 1}}, {0, 0.5, 0})}});
  EXPECT_NEAR(tight_bounds(*make_region(half, 0.01, {}), tolerance).max.y, 0, tolerance);
}

TEST(Container, RefusesWhatIsNone) {
  const auto refused = [](ContainerShape c) { return [c] { parts(c); }; };
  ContainerShape c = about(of(SphereShape{0.2}), 0.03);
  c.cut = 0;
  EXPECT_THAT(refused(c), ThrowsMessage<InputError>(HasSubstr("its opening is closed: 0 m below its highest point")));
  c.cut = 0.4;
  EXPECT_THAT(refused(c),
              ThrowsMessage<InputError>(HasSubstr("a cut of 0.4 m leaves nothing of a hollow that is 0.4 m")));
  c.cut.reset();
  EXPECT_NO_THROW(parts(c));
  c.wall = 0;
  EXPECT_THAT(refused(c), ThrowsMessage<InputError>(HasSubstr("the wall of a container is 0")));
  c.wall = 0.03, c.up = {};
  EXPECT_THAT(refused(c), ThrowsMessage<InputError>(HasSubstr("wants a direction")));
  EXPECT_THAT(refused(about(of(PlaneShape{}), 0.1)), ThrowsMessage<InputError>(HasSubstr("must end somewhere")));
  const Shape nothing = of(BooleanShape{BooleanShape::Op::intersection,
                                        {at(SphereShape{0.1}, {0, 0, 0}), at(SphereShape{0.1}, {0.5, 0, 0})}});
  EXPECT_THAT(refused(about(nothing, 0.1)), ThrowsMessage<InputError>(HasSubstr("encloses nothing")));
  EXPECT_THAT(refused(ContainerShape{}), ThrowsMessage<InputError>(HasSubstr("wants one shape")));
  EXPECT_EQ(hollow_of(*make_region(of(SphereShape{1}), 0.1, {})), nullptr);
}

}  // namespace
}  // namespace dreampm::container_test
