// The function step() itself, over a backend whose answers are fixed: the order of the phases, when
// they are due, the texts of failures, the clock, and the sums that are left to it.
#include <gtest/gtest.h>

#include "worlds.h"

namespace dreampm::step_test {
namespace {
using namespace test;

/// Answers every verb with fixed results, and notes the calls.
class Scripted final : public Backend<float> {
 public:
  GridStats grid;       ///< of grid_update
  GridStats staged;     ///< of sub_cycle
  double heat = 0;      ///< J, of sub_cycle
  Node<float> emptied;  ///< what node 0 lacks after the pass, as where matter left
  PassStats pass;
  std::vector<std::string> calls;
  double taken = 0, next = 0;  ///< s: the dt and dt_next of the pass
  bool sampled = false;

  std::string_view name() const override { return "scripted"; }
  std::string_view isa() const override { return "none"; }
  void attach(const World<float>&) override {}
  void sort(World<float>& w) override {
    calls.push_back("sort");
    w.drift = 0;
    if (w.sets.empty()) return;
    // One particle leaves.
    ++w.left;
    w.sets[0].id.pop_back();
  }
  void colliders_moved(const World<float>&) override { calls.push_back("colliders_moved"); }
  PassStats insert_particles(World<float>&, std::size_t, std::span<const ParticleSeed>) override { return {}; }
  PassStats state_bounds(const World<float>&) override { return {}; }
  void scatter_particles(World<float>&, const Motion<float>&) override {}
  GridStats grid_update(World<float>&, double) override {
    calls.push_back("grid_update");
    return grid;
  }
  double sub_cycle(World<float>&, double, GridStats& found) override {
    calls.push_back("sub_cycle");
    found = staged;
    return heat;
  }
  PassStats g2p2g(World<float>& w, double step, double after, Motion<float>* motion) override {
    calls.push_back("g2p2g");
    taken = step, next = after, sampled = motion != nullptr;
    if (!w.grid.nodes.empty()) w.grid.nodes[0] = w.grid.nodes[0] - emptied;
    return pass;
  }
};

using Calls = std::vector<std::string>;
constexpr double dt = 1.0 / 32;  // s

/// Half-way through frame 25 at 4 frames a second; steps of 1/32 s, so that sums of times are
/// exact.
World<float> running_world() {
  World<float> w = empty_world<float>(0.5, {8, 8, 8});
  w.settings.fps = 4;
  w.settings.dt_max = dt;
  w.step = 7;
  w.frame = 25;
  w.time = 6.125;
  w.dt_next = dt;
  return w;
}

std::string failure_of(World<float> w, Scripted& backend) {
  try {
    step<float>(w, backend, nullptr);
  } catch (const NumericalFailure& e) {
    return e.what();
  }
  return "none";
}

TEST(Step, ItsPhasesComeInTheirOrder) {
  World<float> w = running_world();
  Scripted backend;
  backend.grid.max_speed = backend.staged.max_speed = 4;  // a quarter of a cell in 1/32 s
  step<float>(w, backend, nullptr);
  EXPECT_EQ(backend.calls, (Calls{"grid_update", "g2p2g"}));
  EXPECT_EQ(w.drift, 0.25);
  EXPECT_EQ(backend.taken, dt);
  EXPECT_EQ(backend.next, w.dt_next);

  // The next one sub-cycles, and is due to sort: 0.75 and 0.25 cells are more than stencils reach.
  backend.calls.clear();
  w.viscous_stages = 3;
  w.drift = 0.75;
  step<float>(w, backend, nullptr);
  EXPECT_EQ(backend.calls, (Calls{"grid_update", "sub_cycle", "sort", "g2p2g"}));
  EXPECT_EQ(w.drift, 0.25);
}

TEST(Step, FailuresSayWhereWhatAndWhatHelps) {
  World<float> w = running_world();
  Scripted backend;
  backend.pass.finite = false;
  EXPECT_EQ(failure_of(w, backend), "step 7 at t = 6.125 s: a particle is no longer finite; lower time.cfl (now 0.5)");
  // The phases before it are asked first, each with its own words.
  backend.grid.max_speed = 16;
  EXPECT_EQ(
      failure_of(w, backend),
      "step 7 at t = 6.125 s: matter at 16 m/s would cross 1.00 cells in one step of 0.03125 s; lower time.cfl (now "
      "0.5)");
  EXPECT_EQ(backend.calls.back(), "grid_update");
  w.viscous_stages = 3;
  backend.staged.finite = false;
  EXPECT_EQ(failure_of(w, backend),
            "step 7 at t = 6.125 s: a grid velocity is no longer finite after 3 stages of viscosity; lower time.cfl "
            "(now 0.5)");
  w.settings.fixed_dt = dt;
  backend.grid.finite = false;
  EXPECT_EQ(failure_of(w, backend),
            "step 7 at t = 6.125 s: a grid velocity is no longer finite; lower time.dt, or give time.cfl instead");
  EXPECT_EQ(backend.calls.back(), "grid_update");
}

TEST(Step, AFrameEndsOnTimeAndIsSampled) {
  World<float> w = running_world();
  Scripted backend;
  Motion<float> motion;
  int steps = 0;
  for (bool done = false; !done; ++steps) {
    const StepSums sums = step(w, backend, &motion, 6.1875);
    done = sums.frame_done;
    // From the time of the sample on, and where the frame ends.
    EXPECT_EQ(backend.sampled, w.time >= 6.1875) << w.time;
    EXPECT_EQ(sums.dt, backend.taken);
  }
  EXPECT_EQ(steps, 4);
  EXPECT_EQ(w.time, 6.25);
  EXPECT_EQ(w.frame, 26);
  EXPECT_EQ(w.step, 11u);
  // The last pass had to know the first step of the next frame: a quarter of a second in eight.
  EXPECT_EQ(w.dt_next, dt);
  EXPECT_EQ(backend.next, dt);
  // Without a sample that is due only the end of a frame is looked at.
  for (bool done = false; !done;) {
    done = step(w, backend, &motion).frame_done;
    EXPECT_EQ(backend.sampled, done);
  }
}

TEST(Step, StagesGiveTheirHeatAndTheirRounding) {
  World<float> w = running_world();
  w.gravity = {0, -10, 0};
  add_set<float>(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), 0.5);
  w.sets[0].id = {0};
  Scripted backend;
  backend.grid.kinetic = backend.staged.kinetic = 8;
  backend.pass.energy.kinetic = 5;
  backend.pass.energy.viscous = 2;
  backend.heat = 1.5;
  World<float> other = w;
  other.viscous_stages = 4;
  const StepSums explicitly = step<float>(w, backend, nullptr), staged = step<float>(other, backend, nullptr);
  EXPECT_EQ(explicitly.stages, 0);
  EXPECT_EQ(explicitly.pass.energy.viscous, 2);
  EXPECT_EQ(staged.stages, 4);
  EXPECT_EQ(staged.pass.energy.viscous, 3.5);
  EXPECT_GT(explicitly.rounding, 0);
  EXPECT_DOUBLE_EQ(staged.rounding, 5 * explicitly.rounding);
  // The momentum that the grid did not give to the particles, and gravity on all of the mass.
  EXPECT_EQ(staged.transfer, 3);
  EXPECT_DOUBLE_EQ(staged.body.impulse.y, -10 * dt * w.sets[0].mass);
}

TEST(Step, WhatLeavesInASortTakesItsMomentumAlong) {
  for (const bool open : {false, true}) {
    World<float> w = running_world();
    if (open) w.walls[3].type = WallType::open;
    add_set<float>(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), 0.5);
    w.sets[0].id = {0, 1};
    w.grid.blocks.assign({{0, 0, 0}});
    w.grid.nodes.assign(block_nodes, {});
    w.grid.nodes[0] = {1, 2, 3, 4};  // velocities after grid_update: 4 kg at (1, 2, 3) m/s
    w.drift = 0.9;
    Scripted backend;
    backend.grid.max_speed = 4;
    // The pass leaves momenta there: (1, 2, 3) kg m/s, less what is gone.
    backend.emptied = {0, 1, 0, 0};
    const StepSums sums = step<float>(w, backend, nullptr);
    EXPECT_EQ(sums.left.impulse, (open ? Vec3d{3, 7, 9} : Vec3d{}));
    EXPECT_EQ(sums.left_mass, open ? w.sets[0].mass : 0);
    // It is missing in the pass, so nothing can be said of the transfer.
    EXPECT_EQ(sums.transfer, 0);
  }
}

}  // namespace
}  // namespace dreampm::step_test
