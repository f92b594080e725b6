// Contact of a velocity with a wall: who may leave, who is held, and Coulomb's cone.
#include "dreampm/physics/contact.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(WallShear, IsViscousFlowAtTheWallAndTheLogarithmFarFromIt) {
  for (const double re : {1e-6, 1e-3, 0.1, 1.0}) EXPECT_NEAR(wall_shear(re) * re, 1, 1e-3) << re;
  for (const double re : {1e5, 1e7, 1e9}) {
    const double u = 1 / std::sqrt(wall_shear(re)), y = re / u;
    EXPECT_NEAR(u, std::log(y) / 0.41 + 5.0, 0.01 * u) << re;
  }
}

TEST(WallShear, FallsWithReynoldsNumberAndIsAboveBothLimits) {
  double last = 1e30;
  for (double re = 1e-4; re < 1e10; re *= 1.3) {
    const double shear = wall_shear(re), u = 1 / std::sqrt(shear);
    EXPECT_LT(shear, last) << re;
    EXPECT_LE(u, std::sqrt(re) * (1 + 1e-12)) << "less friction than in viscous flow at " << re;
    EXPECT_NEAR(static_cast<double>(wall_shear(static_cast<float>(re))), shear, 1e-4 * shear) << re;
    last = shear;
  }
}

TEST(WallShear, OfHoneyTakesAsMuchAsViscousFlow) {
  // A layer of half a cell, moved at its middle: rho (dx/2) dv/dt = -rho nu v/(h dx), one implicit
  // step.
  const double nu = 1e-2, dx = 0.01, dt = 1e-4;
  EXPECT_NEAR(skin_drag(1e-3, nu, dx, dt / dx), stage_drag * nu * dt / (dx * dx), 1e-6);
}

TEST(BoxContact, ActsOnAndBehindEachPlaneOnly) {
  BoxWalls<double> walls{{0, 0, 0}, {8, 8, 8}, {}, {}};
  for (auto& t : walls.type) t = WallType::separate;
  const Vec3d v{-1, 1, 0.5};
  const auto at = [&](int i, int j, int k) {
    const Vec3d n{double(i), double(j), double(k)};
    Vec3d after = v;
    for (int side = 0; side < 6; ++side)
      if (walls.holds(side, n)) after = walls.contact(side, after);
    return after;
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

// A meeting of a solid and a liquid at a node.
struct Meeting {
  Vec3d liquid{0.3, -2, 0.1}, solid{-0.2, 0.5, 0};
  double m_liquid = 2, m_solid = 0.5;
  Vec3d momentum() const { return liquid * m_liquid + solid * m_solid; }
  void apply(const Vec3d& n, double diffusion) {
    dreampm::two_field_contact(liquid, m_liquid, solid, m_solid, n, slip_drag(diffusion, m_liquid, m_solid));
  }
};

TEST(Meeting, ALiquidThatFallsOnASolidMovesAlongWithItAndSlides) {
  Meeting m;
  const Vec3d before = m.momentum(), n{0, 1, 0};
  m.apply(n, 0);
  EXPECT_NEAR(m.liquid.y, m.solid.y, 1e-15);
  EXPECT_NEAR(m.liquid.y, before.y / 2.5, 1e-15);
  EXPECT_EQ(m.liquid.x, 0.3);
  EXPECT_EQ(m.solid.z, 0);
  expect_near(m.momentum(), before);
}

TEST(Meeting, TheyPartFreely) {
  Meeting m;
  m.liquid.y = 3;
  const Meeting before = m;
  m.apply({0, 1, 0}, 0);
  expect_near(m.liquid, before.liquid);
  expect_near(m.solid, before.solid);
}

TEST(Meeting, AViscousLiquidSticksAndAThinOneSlips) {
  Meeting thin, thick;
  const Vec3d before = thick.momentum(), n{0, 1, 0};
  thin.apply(n, 1e-7), thick.apply(n, 1e6);
  expect_near(thick.momentum(), before);
  EXPECT_NEAR(thick.liquid.x, thick.solid.x, 1e-6);
  EXPECT_NEAR(thin.liquid.x - thin.solid.x, 0.5, 1e-5);
  // One implicit step of the relaxation at the rate nu/dx^2 of the liquid: slip / (1 + a (1 +
  // m_l/m_s)).
  Meeting middle;
  middle.apply(n, 0.2);
  EXPECT_NEAR(middle.liquid.x - middle.solid.x, 0.5 / (1 + 0.2 * 5), 1e-15);
}

TEST(Meeting, WithoutANormalTheyMoveAsOne) {
  Meeting m;
  const Vec3d before = m.momentum();
  m.apply({0, 0, 0}, 0);
  expect_near(m.liquid, before / 2.5);
  expect_near(m.solid, before / 2.5);
}

}  // namespace
}  // namespace dreampm
