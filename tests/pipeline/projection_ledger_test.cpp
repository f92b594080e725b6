// The ledger of the projection: what falls, strikes, comes to rest and leaves.
#include <gtest/gtest.h>

#include <cmath>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/pipeline/strict.h"
#include "dreampm/run/engine.h"
#include "dreampm/run/ledger_row.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"

namespace dreampm::projection_ledger_test {
namespace {

/// A block of water above a floor, with rows at the ends of frames.
struct Course {
  explicit Course(const std::vector<std::string>& overrides = {}, int frames = 40) {
    const auto parsed = scene::parse_scene_text(
        "dreampm: 1\nname: block\nspace: {max: [0.4, 0.5, 0.2], spacing: 0.01}\ntime: {fps: 24, frames: 60, solver: "
        "projection}\nmaterials: {water: {type: newtonian, preset: water}}\nbodies: {block: {material: water, shape: "
        "{box: {min: [0.1, 0.2, 0], max: [0.3, 0.4, 0.2]}}, sample: {pattern: jitter}}}\n",
        "block.yaml", {.variant = {}, .overrides = overrides, .assets = {}});
    if (!parsed.ok()) throw std::runtime_error(parsed.text());
    const InitialState start = assemble(parsed.scene, "block.yaml");
    engine = std::make_unique<Engine<float>>(as_world<float>(start.world), make_cpu_backend());
    engine->begin(start.seeds);
    rows.push_back(row({}));
    while (engine->world().frame < frames) {
      FrameSums sums;
      StepSums step;
      do sums.add(step = engine->step(), 1e-3);
      while (!step.frame_done);
      rows.push_back(row(sums));
    }
  }
  LedgerRow row(const FrameSums& sums) {
    return ledger_row(engine->world(), engine->backend(), engine->motion(), sums,
                      rows.empty() ? nullptr : &rows.back());
  }
  double at(std::size_t frame, const std::string& column) const { return ledger_number(rows.at(frame), column); }
  double change(std::size_t frame, const std::string& column) const {
    return at(frame, column) - at(frame - 1, column);
  }

  std::unique_ptr<Engine<float>> engine;
  std::vector<LedgerRow> rows;
};

TEST(ProjectionLedger, KnowsWhatEnergyAnImpactTook) {
  const Course run;
  const double fall = -run.rows.front().gravity;  // g x is below 0
  double projected = 0, transferred = 0;
  for (std::size_t f = 1; f < run.rows.size(); ++f) {
    const double most = std::abs(fall) + run.at(f, "kinetic");
    // In a fall nothing is lost.
    if (f < 4) {
      EXPECT_NEAR(run.at(f, "dissipated_projection"), 0, 1e-3 * most) << f;
    }
    EXPECT_GT(run.at(f, "dissipated_transfer"), -1e-3 * most) << f;
    projected += run.at(f, "dissipated_projection"), transferred += run.at(f, "dissipated_transfer");
  }
  const double lost = run.at(0, "kinetic") + run.at(0, "gravity") - run.at(39, "kinetic") - run.at(39, "gravity");
  EXPECT_GT(lost, 0);
  // Matter that is too dense is moved up.
  EXPECT_NEAR(projected + transferred, lost, 0.15 * lost);
  EXPECT_GT(projected, 0.3 * lost);
  EXPECT_GT(transferred, 0.05 * lost);
}

TEST(ProjectionLedger, WallsGiveWhatMomentumLacks) {
  const Course run;
  double walls = 0, gravity = 0;
  for (std::size_t f = 1; f < run.rows.size(); ++f)
    walls += run.at(f, "wall_impulse_y"), gravity -= run.at(f, "body_impulse_y");
  const double weight = 39 * 9.81 * run.at(0, "mass") / 24;
  EXPECT_NEAR(gravity, weight, 0.02 * weight);  // but for half a step
  const double change = run.at(39, "momentum_y") - run.at(0, "momentum_y");
  EXPECT_NEAR(walls, change + gravity, 0.02 * gravity);
}

TEST(ProjectionLedger, MomentumClosesWithSandAndJellyInTheWater) {
  const Course run(
      {"materials.sand={type: sand}", "materials.jelly={type: elastic, density: 800, youngs_modulus: 2.0e4}",
       "bodies.block.shape={box: {min: [0, 0, 0], max: [0.4, 0.15, 0.2]}}",
       "bodies.lump={material: sand, shape: {box: {min: [0.05, 0.2, 0.05], max: [0.15, 0.3, 0.15]}}}",
       "bodies.cube={material: jelly, shape: {box: {min: [0.25, 0.2, 0.05], max: [0.35, 0.3, 0.15]}}}"},
      25);
  double walls = 0, gravity = 0;
  for (std::size_t f = 1; f < run.rows.size(); ++f) {
    walls += run.at(f, "wall_impulse_y"), gravity -= run.at(f, "body_impulse_y");
    for (const LedgerCell& cell : ledger_cells({.projection = true}))
      if (const std::string name = cell.name(); name != "frame" && name != "limiter") {
        EXPECT_FALSE(std::isnan(run.at(f, name))) << name << " of frame " << f + 1;
      }
  }
  EXPECT_NEAR(walls, run.at(24, "momentum_y") - run.at(0, "momentum_y") + gravity, 0.03 * gravity);
}

TEST(ProjectionLedger, WhatJellyGetsFromWaterIsNotLost) {
  // A stream takes a cube along, without gravity.
  const Course run(
      {"gravity=[0, 0, 0]", "materials.jelly={type: elastic, density: 1000, youngs_modulus: 2.0e4}",
       "bodies.block.shape={difference: [{box: {min: [0.05, 0.1, 0.02], max: [0.25, 0.3, 0.18]}}, {box: {min: "
       "[0.1, 0.15, 0.05], max: [0.2, 0.25, 0.15]}}]}",
       "bodies.block.velocity=[0.4, 0, 0]",
       "bodies.cube={material: jelly, shape: {box: {min: [0.1, 0.15, 0.05], max: [0.2, 0.25, 0.15]}}}"},
      4);
  double projected = 0, transferred = 0;
  for (std::size_t f = 1; f < run.rows.size(); ++f)
    projected += run.at(f, "dissipated_projection"), transferred += run.at(f, "dissipated_transfer");
  const double lost = run.at(0, "kinetic") - run.at(3, "kinetic") - run.at(3, "elastic");
  EXPECT_GT(lost, 0);
  EXPECT_NEAR(projected + transferred, lost, 0.25 * lost);
}

TEST(ProjectionLedger, VolumeIsThatOfTheCells) {
  const Course run;
  const double rest = 0.2 * 0.2 * 0.2;
  EXPECT_NEAR(run.at(0, "volume"), rest, 1e-9);
  for (std::size_t f = 1; f < run.rows.size(); ++f) EXPECT_NEAR(run.at(f, "volume"), rest, 0.03 * rest) << f;
  EXPECT_NE(run.at(39, "volume"), rest);
  EXPECT_LT(std::abs(run.at(39, "swollen")), 0.01);
}

// A sheet on the floor, which flows fast under a column 42 cells deep.
TEST(ProjectionLedger, ADeepDamBreakKeepsItsVolume) {
  const Course run({"space={max: [1.2, 0.9, 0.048], spacing: 0.006}",
                    "bodies.block={material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.5, 0.048]}}, sample: "
                    "{pattern: jitter}}"},
                   13);
  double steps = 0;
  for (std::size_t f = 1; f < run.rows.size(); ++f) {
    EXPECT_NEAR(run.at(f, "swollen"), 0, 0.0015) << f;
    steps += run.at(f, "substeps");
  }
  EXPECT_LT(steps, 120);
}

TEST(ProjectionLedger, MatterThatLeavesIsNoLossOfTransfers) {
  const Course run({"space.walls.x_max.type=open", "space.walls.x_min.type=open"});
  EXPECT_LT(run.at(39, "mass"), 0.8 * run.at(0, "mass"));
  const double fall = std::abs(run.at(0, "gravity"));
  for (std::size_t f = 1; f < run.rows.size(); ++f) {
    EXPECT_EQ(ledger_breach(run.rows[f - 1], run.rows[f]), std::nullopt) << f;
    EXPECT_GT(run.at(f, "dissipated_transfer"), -1e-3 * fall) << f;
    EXPECT_LT(run.at(f, "dissipated_transfer"), 0.1 * fall) << f;
  }
}

}  // namespace
}  // namespace dreampm::projection_ledger_test
