// Walls with a boundary layer: what a liquid that slides along them loses.
#include <gtest/gtest.h>

#include <numbers>

#include "worlds.h"

namespace dreampm::skin_friction_test {
namespace {
using namespace test;

constexpr double dx = 0.01, spacing = dx / 2, speed = 2, density = 1000, viscosity = 1e-3;
const Vec3i cells{16, 12, 8};
const double area = cells.x * cells.z * dx * dx;
constexpr double rounding = 1e-8;  // N s; a step of water gives the floor 1.7e-5

/// A layer of matter four cells deep that slides along the floor, which has a boundary layer or
/// not, without an end.
struct Layer {
  World<float> world = empty_world<float>(dx, cells, WallType::open);
  std::unique_ptr<Backend<float>> backend = make_cpu_backend();
  std::vector<ParticleSeed> seeds;

  explicit Layer(bool skin, std::string_view material = "newtonian", WallType type = WallType::slip,
                 Vec3d velocity = {speed, 0, 0}) {
    world.walls[2] = {type, 0, skin};
    world.periodic = {true, false, true};
    Values v = material == "newtonian"
                   ? values_of(material, {{"density", density}, {"viscosity", viscosity}, {"bulk_modulus", 1e6}})
                   : values_of(material, {{"density", density}});
    add_set(world, material, v, spacing);
    seeds = lattice({{}, {cells.x * dx, 4 * dx, cells.z * dx}}, spacing, [=](const Vec3d&) { return velocity; });
    begin(world, *backend, {seeds});
  }
  StepSums step() { return dreampm::step<float>(world, *backend, nullptr); }
};

TEST(SkinFriction, IsTheShearOfASmoothWall) {
  for (const WallType type : {WallType::slip, WallType::separate}) {
    Layer layer(true, "newtonian", type);
    const StepSums r = layer.step();
    const double nu = viscosity / density;
    const double want = -wall_shear(speed * wall_node_height * dx / nu) * density * speed * speed * area * r.dt;
    std::printf("c_f %.4f, impulse %.4g N s, wanted %.4g\n", 2 * wall_shear(speed * wall_node_height * dx / nu),
                r.grid.walls[2].impulse.x, want);
    EXPECT_NEAR(r.grid.walls[2].impulse.x, want, 0.01 * std::abs(want));
    EXPECT_NEAR(r.grid.walls[2].impulse.z, 0, 1e-6 * std::abs(want));
    // The work of friction turns to heat: its impulse times the sliding.
    EXPECT_NEAR(r.grid.walls[2].work, r.grid.walls[2].impulse.x * speed, 0.01 * std::abs(want) * speed);
  }
}

TEST(SkinFriction, TheSumsKnowOfIt) {
  Layer layer(true);
  double momentum = speed * density * 4 * dx * area, given = 0;
  const double start = momentum;
  for (int i = 0; i < 200; ++i) {
    Motion<float> motion;
    const StepSums r = dreampm::step<float>(layer.world, *layer.backend, &motion, 0);
    given += r.grid.walls[2].impulse.x;
    momentum = balance(layer.world, motion).momentum.x;
  }
  EXPECT_LT(given, -1e-4 * start);
  EXPECT_NEAR(momentum, start + given, 1e-5 * start);
}

TEST(SkinFriction, ASlipperyWallTakesNothing) {
  Layer layer(false);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(layer.step().grid.walls[2].impulse.x, 0, rounding);
}

TEST(SkinFriction, IsOfLiquids) {
  Layer layer(true, "elastic");
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(layer.step().grid.walls[2].impulse.x, 0, rounding);
}

TEST(SkinFriction, WhatLeavesAWallIsFree) {
  Layer layer(true, "newtonian", WallType::separate, {speed, 1, 0});
  EXPECT_NEAR(layer.step().grid.walls[2].impulse.x, 0, rounding);
}

/// The part of its momentum that a layer of honey, `deep` cells deep, loses to the wall, in steps
/// that the solver chooses or of `dt`; `stages` is what those take.
double lost_by_honey(int deep, double depth, double thick, double time, double dt = 0, int stages = 0) {
  const double h = depth / deep;
  World<float> w = empty_world<float>(h, {8, deep + 8, 8}, WallType::open);
  w.walls[2] = {WallType::slip, 0, true};
  w.periodic = {true, false, true};
  w.settings.fps = 1 / time;
  w.settings.fixed_dt = dt;
  add_set(w, "newtonian", values_of("newtonian", {{"density", density}, {"viscosity", thick}, {"bulk_modulus", 1e6}}),
          h / 2);
  const auto backend = make_cpu_backend();
  begin(w, *backend, {lattice({{}, {8 * h, depth, 8 * h}}, h / 2, [](const Vec3d&) { return Vec3d{speed, 0, 0}; })});
  double lost = 0;
  EXPECT_EQ(w.viscous_stages, stages);
  while (w.frame == 1)
    lost -= step<float>(w, *backend, nullptr).grid.walls[2].impulse.x / (speed * density * depth * 64 * h * h);
  return lost;
}

/// Returns the momentum that viscosity takes from a layer that stands still on a wall from now on;
/// exact for a free surface at its top.
double lost_to_no_slip(double depth, double thick, double time) {
  double lost = 1;
  for (int n = 1; n < 20; n += 2) {
    const double k2 = std::pow(n * std::numbers::pi / 2, 2);
    lost -= 2 / k2 * std::exp(-k2 * thick / density * time / (depth * depth));
  }
  return lost;
}

// Honey sticks.
TEST(SkinFriction, HoldsHoneyAsViscousFlowDoes) {
  constexpr double honey = 10, time = 0.05, depth = 0.04;
  const double want = lost_to_no_slip(depth, honey, time);
  const double coarse = lost_by_honey(4, depth, honey, time), fine = lost_by_honey(8, depth, honey, time);
  std::printf("lost to the wall: %.4f, %.4f of the momentum with 4 and 8 cells, exact %.4f\n", coarse, fine, want);
  EXPECT_NEAR(fine, want, 0.05 * want);
  EXPECT_LT(std::abs(fine - want), 0.5 * std::abs(coarse - want));
}

// The wall is one among the forces of a stage. In long steps there are few transfers, whose own
// diffusion makes up for the node's distance from the wall in short ones: more cells are needed.
TEST(SkinFriction, HoldsWhatIsSubCycledAsViscousFlowDoes) {
  constexpr double thick = 200, time = 0.0025, depth = 0.04;
  const double want = lost_to_no_slip(depth, thick, time);
  const double coarse = lost_by_honey(16, depth, thick, time, 1.25e-4, 9);
  const double fine = lost_by_honey(32, depth, thick, time, 6.25e-5, 12);
  std::printf("lost to the wall: %.4f, %.4f of the momentum with 16 and 32 cells, exact %.4f\n", coarse, fine, want);
  EXPECT_NEAR(fine, want, 0.05 * want);
  EXPECT_LT(std::abs(fine - want), 0.6 * std::abs(coarse - want));
  const double few = lost_by_honey(8, depth, thick, time, 2.5e-4, 6);
  const double many = lost_by_honey(8, depth, thick, time, 1e-5);
  std::printf("with 8 cells: %.4f in 10 steps of 6 stages, %.4f in 250 explicit ones\n", few, many);
  EXPECT_LT(few, many);
  EXPECT_LT(many, want);
}

}  // namespace
}  // namespace dreampm::skin_friction_test
