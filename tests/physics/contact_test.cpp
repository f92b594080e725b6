// Contact of a velocity with a wall: who may leave, who is held, and Coulomb's cone.
#include "dreampm/physics/contact.h"

#include <gtest/gtest.h>

#include "dreampm/physics/node.h"

namespace dreampm {
namespace {

const Vec3d up{0, 1, 0};
const Vec3d down_and_along{3, -2, 4}, away{3, 2, 4};

void expect_near(const Vec3d& got, const Vec3d& want) { EXPECT_LT(length(got - want), 1e-14); }

TEST(Contact, OpenChangesNothing) { expect_near(contact(down_and_along, up, WallType::open, 0.5), down_and_along); }

TEST(Contact, StickTakesEverything) {
  expect_near(contact(down_and_along, up, WallType::stick, 0.0), {});
  expect_near(contact(away, up, WallType::stick, 0.0), {});
}

TEST(Contact, SeparateLetsGo) {
  expect_near(contact(away, up, WallType::separate, 0.5), away);
  expect_near(contact(down_and_along, up, WallType::separate, 0.0), {3, 0, 4});
}

TEST(Contact, SlipHoldsBothWays) {
  expect_near(contact(away, up, WallType::slip, 0.0), {3, 0, 4});
  expect_near(contact(down_and_along, up, WallType::slip, 0.0), {3, 0, 4});
  // Only a pressed contact rubs.
  expect_near(contact(away, up, WallType::slip, 0.5), {3, 0, 4});
}

TEST(Contact, CoulombTakesFrictionTimesTheNormalVelocity) {
  // |tangential| 5, pressed with 2: friction 0.5 takes 1.
  for (const WallType type : {WallType::separate, WallType::slip}) {
    expect_near(contact(down_and_along, up, type, 0.5), Vec3d{3, 0, 4} * 0.8);
    expect_near(contact(down_and_along, up, type, 2.5), {});
    expect_near(contact(down_and_along, up, type, 7.0), {});
  }
}

TEST(Contact, WorksForAnyNormal) {
  const Vec3d n = normalized(Vec3d{1, 2, -2});
  const Vec3d v{-1, -3, 2};
  const Vec3d got = contact(v, n, WallType::separate, 0.1);
  EXPECT_NEAR(dot(got, n), 0, 1e-15);
  const Vec3d tangential = v - n * dot(v, n);
  EXPECT_NEAR(length(got), length(tangential) + 0.1 * dot(v, n), 1e-14);
  EXPECT_NEAR(dot(got, tangential), length(got) * length(tangential), 1e-14);
}

TEST(BoxContact, ActsOnAndBehindEachPlaneOnly) {
  BoxWalls<double> walls{{0, 0, 0}, {8, 8, 8}, {}, {}};
  for (auto& t : walls.type) t = WallType::separate;
  const Vec3d v{-1, 1, 0.5};
  const auto at = [&](int i, int j, int k) {
    const int n[3] = {i, j, k};
    return box_contact(v, n, walls);
  };
  expect_near(at(4, 4, 4), v);
  expect_near(at(1, 7, 7), v);
  expect_near(at(0, 4, 4), {0, 1, 0.5});
  expect_near(at(-1, 4, 4), {0, 1, 0.5});
  expect_near(at(8, 4, 4), v);  // leaves to the inside
  expect_near(at(4, 8, 4), {-1, 0, 0.5});
  expect_near(at(0, 9, 8), {0, 0, 0});
  walls.type[0] = WallType::stick;
  expect_near(at(0, 4, 4), {});
  walls.type[0] = WallType::open;
  expect_near(at(0, 4, 4), v);
}

}  // namespace
}  // namespace dreampm
