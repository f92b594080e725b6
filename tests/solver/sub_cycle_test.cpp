// Viscosity beyond the explicit limit, in stages: as the explicit one, with every sum kept.
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/base/parallel.h"
#include "mixed_world.h"

namespace dreampm::sub_cycle_test {
namespace {
using namespace test;

constexpr double cell = 0.01, unit = viscosity_factor * cell * cell;  // unit/nu: an explicit step

TEST(SubCycle, StagesReachAsFarAsTheStepAndNoFurtherThanTheyMust) {
  const auto stages = [](double steps) { return stages_of(steps, cell, unit, 0); };
  EXPECT_EQ(stages(1), 0) << "explicit";
  EXPECT_EQ(stages(3), 2);
  EXPECT_EQ(stages(3.01), 3);
  EXPECT_EQ(stages(210), 20);
  for (int s = 3; s < 40; ++s) {
    EXPECT_EQ(stages(dt_of_stages(s, 1)), s);
    EXPECT_EQ(stages(1.001 * dt_of_stages(s, 1)), s + 1);
  }
}

TEST(SubCycle, ContactTakesStagesOfItsOwn) {
  EXPECT_EQ(stages_of(1, cell, unit, 2), 0) << "explicit steps take it implicitly";
  EXPECT_EQ(stages_of(3, cell, unit, 0), 2);
  EXPECT_EQ(stages_of(3, cell, unit, 1), 3);
  EXPECT_EQ(stages_of(4.2, cell, unit, 1), 3);
  EXPECT_EQ(stages_of(4.2, cell, unit, 2), 4);
  // 2 over the rates of both: 2/0.15 and stage_drag.
  EXPECT_NEAR(euler_dt(cell, unit, 1), 2 / (2 + viscosity_factor * stage_drag), 1e-12);
}

/// The bound for a viscosity at which an explicit step is 1/ratio of what sound allows.
StepBound bound(double ratio, int contacts = 0, double dt_max = 1) {
  const double wave = 0.5 * cell / 10;
  return stable_dt(0.5, cell,
                   {.speed = 1, .wave = 9 / wave_margin, .viscosity = ratio * unit / wave, .contacts = contacts}, 1,
                   dt_max);
}

/// Returns the cost of a second of motion, in steps without stages.
double cost(const StepBound& b, double ratio, int contacts = 0) {
  return (1 + stage_cost * stages_of(b.dt, cell, ratio * unit / (0.5 * cell / 10), contacts)) / b.dt;
}

TEST(SubCycle, AStepIsExplicitWhereThatIsCheaperAndStagedWhereNot) {
  const double wave = 0.5 * cell / 10;
  EXPECT_DOUBLE_EQ(bound(0.9).dt, wave);
  EXPECT_DOUBLE_EQ(bound(2).dt, wave / 2) << "two steps cost less than one with two stages";
  EXPECT_EQ(bound(2).limiter, Limiter::viscosity);
  EXPECT_DOUBLE_EQ(bound(2.8).dt, wave) << "two stages";
  EXPECT_EQ(bound(2.8).limiter, Limiter::wave);
  EXPECT_DOUBLE_EQ(bound(3.2).dt, 3 * wave / 3.2) << "a third stage costs more than it brings";
  EXPECT_EQ(bound(3.2).limiter, Limiter::viscosity);
  EXPECT_DOUBLE_EQ(bound(6).dt, wave);
  EXPECT_DOUBLE_EQ(bound(1000).dt, wave * 210 / 1000);
  EXPECT_EQ(bound(1000).limiter, Limiter::viscosity);
}

/// The rest of a frame, or a hair less than it, leaves nothing for another step.
TEST(SubCycle, TheEndOfAFrameIsOneStep) {
  const SignalSpeeds f{.speed = 1, .wave = 9 / wave_margin, .viscosity = 100 * unit / (0.5 * cell / 10), .contacts = 1};
  const double all = stable_dt(0.5, cell, f, 1).dt;
  for (double left = all; left > all / 1000; left *= 0.99) EXPECT_EQ(stable_dt(0.5, cell, f, left).dt, left);
}

/// A step that the user bounds has stages only where they are worth it at that length.
TEST(SubCycle, TheUsersLongestStepCountsInTheChoice) {
  const double ratio = 10, wave = 0.5 * cell / 10, limit = wave / ratio;
  const auto capped = [&](double steps) { return bound(ratio, 0, steps * limit); };
  EXPECT_DOUBLE_EQ(capped(0.5).dt, 0.5 * limit);
  EXPECT_EQ(capped(0.5).limiter, Limiter::user);
  for (const double steps : {1.1, 2.0, 2.5}) {
    EXPECT_DOUBLE_EQ(capped(steps).dt, limit) << "two stages would cost 2.6 steps";
    EXPECT_EQ(capped(steps).limiter, Limiter::viscosity);
  }
  EXPECT_DOUBLE_EQ(capped(2.7).dt, 2.7 * limit) << "two stages";
  EXPECT_EQ(capped(2.7).limiter, Limiter::user);
  EXPECT_DOUBLE_EQ(capped(50).dt, bound(ratio).dt);
  for (const int contacts : {0, 1, 2})
    for (double steps = 0.1; steps < 20; steps *= 1.01) {
      const StepBound b = bound(ratio, contacts, steps * limit);
      EXPECT_LE(b.dt, steps * limit);
      EXPECT_LE(cost(b, ratio, contacts), 1 / std::min(limit, steps * limit) * (1 + 1e-9)) << "of explicit steps";
      EXPECT_GE(cost(b, ratio, contacts), cost(bound(ratio, contacts), ratio, contacts) * (1 - 1e-9));
    }
}

TEST(SubCycle, MoreViscosityIsNeverCheaper) {
  for (const int contacts : {0, 1, 2}) {
    double before = 0;
    for (double ratio = 1; ratio < 500; ratio *= 1.003) {
      const double now = cost(bound(ratio, contacts), ratio, contacts);
      EXPECT_GE(now, before * (1 - 1e-9)) << ratio;
      EXPECT_LE(now, ratio / (0.5 * cell / 10) * (1 + 1e-9)) << "dearer than explicit steps at " << ratio;
      before = now;
    }
  }
}

/// A ball of a very viscous liquid that turns, shears and flies, far from all walls.
template <class R>
World<R> ball(std::vector<std::vector<ParticleSeed>>& seeds, double viscosity, const Field& field) {
  World<R> w = empty_world<R>(0.02, {64, 64, 64}, WallType::open);
  add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}, {"viscosity", viscosity}, {"relaxation", 0}}),
          0.01);
  const Vec3d middle{0.64, 0.64, 0.64};
  seeds.assign(1, {});
  for (ParticleSeed n : lattice({middle - Vec3d{0.1, 0.1, 0.1}, middle + Vec3d{0.1, 0.1, 0.1}}, 0.01, field))
    if (length(n.position - middle) < 0.1) n.id = static_cast<std::uint32_t>(seeds[0].size()), seeds[0].push_back(n);
  w.settings.fps = 100;
  w.settings.fixed_dt = 5e-4;
  return w;
}

Vec3d turning(const Vec3d& p) {
  const Vec3d r = p - Vec3d{0.64, 0.64, 0.64};
  return {-3 * r.y + 0.2, 3 * r.x + 0.1, 0.05};
}

TEST(SubCycle, MomentaAreKeptAndWhatIsLostOfTheMotionIsHeat) {
  std::vector<std::vector<ParticleSeed>> seeds;
  const Field field = [](const Vec3d& p) { return turning(p) + Vec3d{4 * (p.y - 0.64), 0, 2 * (p.x - 0.64)}; };
  World<double> w = ball<double>(seeds, 500, field);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, seeds);
  const Balance start = balance(w, initial_velocities(w, seeds));
  ASSERT_GE(w.viscous_stages, 3);
  Motion<double> motion;
  double heat = 0;
  for (int n = 0; n < 100; ++n) {
    const StepSums r = step(w, *backend, &motion, 0);
    EXPECT_GE(r.pass.energy.viscous, 0) << "step " << n;
    heat += r.pass.energy.viscous;
  }
  const Balance end = balance(w, motion);
  EXPECT_LT(length(end.momentum - start.momentum), 1e-13 * length(start.momentum));
  EXPECT_LT(length(end.angular - start.angular), 1e-13 * length(start.angular));
  const double lost = start.kinetic + start.elastic - end.kinetic - end.elastic;
  EXPECT_GT(lost, 0.1 * start.kinetic) << "shear must have been slowed";
  EXPECT_NEAR(heat / lost, 1, 0.1) << "the rest is the transfer's";
}

TEST(SubCycle, ATurningBallGoesOnTurning) {
  std::vector<std::vector<ParticleSeed>> seeds;
  double kinetic[2];
  for (const double viscosity : {0.0, 1000.0}) {
    World<float> w = ball<float>(seeds, viscosity, turning);
    const auto backend = make_cpu_backend();
    begin(w, *backend, seeds);
    EXPECT_EQ(w.viscous_stages, viscosity > 0 ? 4 : 0);
    Motion<float> motion;
    for (int n = 0; n < 200; ++n) step(w, *backend, &motion, 0);
    kinetic[viscosity > 0] = balance(w, motion).kinetic;
  }
  EXPECT_GT(kinetic[1], 0.99 * kinetic[0]) << "a rigid rotation has no rate of strain";
}

/// The mixed world with a first material so viscous that fixed steps need stages.
template <class R>
World<R> thick_world(std::vector<std::vector<ParticleSeed>>& seeds, double viscosity) {
  World<R> w = mixed_world<R>("newtonian", seeds);
  w.sets[0].values.set("viscosity", viscosity);
  return w;
}
template <class R>
World<R> thick_ran(Backend<R>& backend, int steps, double viscosity = 600, double dt = 2e-4) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<R> w = thick_world<R>(seeds, viscosity);
  w.settings.fixed_dt = dt;
  begin(w, backend, seeds);
  advance(w, backend, steps);
  return w;
}

double rms_distance(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b, double dx) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += length2(a[i] - b[i]) / (dx * dx);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(SubCycle, CpuFollowsTheReference) {
  const auto reference = make_reference_backend<float>();
  const World<float> w = thick_ran<float>(*reference, 200);
  EXPECT_GE(w.viscous_stages, 2);
  for (const std::string_view isa : cpu_instruction_sets()) {
    const auto cpu = make_cpu_backend(isa);
    const double rms = rms_distance(positions_by_id(thick_ran<float>(*cpu, 200)), positions_by_id(w), w.dx);
    std::printf("sub-cycled on %s: %.2e cells rms\n", std::string(isa).c_str(), rms);
    EXPECT_LE(rms, 1e-5) << isa;
  }
}

TEST(SubCycle, ThreadsAndPlaceDoNotChangeABit) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const auto cpu = make_cpu_backend();
    hashes.push_back(state_hash(thick_ran<float>(*cpu, 60)));
  }
  for (const auto h : hashes) EXPECT_EQ(h, hashes[0]);
}

// Contact depends on the step, so that halving an explicit one moves things too.
TEST(SubCycle, MovesAsManyExplicitStepsDo) {
  const auto backend = make_cpu_backend();
  // The limit of 600 Pa s in cells of 2 cm is 1e-4 s.
  const auto after = [&](double viscosity, double dt, bool stages) {
    const World<float> w = thick_ran<float>(*backend, static_cast<int>(std::lround(0.04 / dt)), viscosity, dt);
    EXPECT_EQ(w.viscous_stages > 0, stages);
    return positions_by_id(w);
  };
  const auto staged = after(600, 2e-4, true), fine = after(600, 8e-5, false);
  const double apart = rms_distance(staged, fine, 0.02), halved = rms_distance(after(600, 4e-5, false), fine, 0.02);
  const double thinner = rms_distance(staged, after(60, 2e-4, false), 0.02);
  std::printf("staged and explicit: %.3f cells rms; half the explicit step: %.3f; a tenth of the viscosity: %.3f\n",
              apart, halved, thinner);
  EXPECT_LT(apart, 1.5 * halved);
  EXPECT_LT(apart, 0.3 * thinner);
}

TEST(SubCycle, WhatWallsAndCollidersGiveInTheStagesIsBooked) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<double> w = thick_world<double>(seeds, 600);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, seeds);
  Motion<double> motion;
  Balance before = balance(w, initial_velocities(w, seeds));
  double most = 0;
  for (int n = 0; n < 200; ++n) {
    const StepSums r = step(w, *backend, &motion, 0);
    ASSERT_GT(w.viscous_stages, 0);
    const Balance now = balance(w, motion);
    const ImpulseSum contact = r.grid.contact();
    EXPECT_LT(length(now.momentum - before.momentum - contact.impulse - r.body.impulse), 1e-12) << "step " << n;
    EXPECT_LT(length(now.angular - before.angular - contact.angular - r.body.angular), 1e-12) << "step " << n;
    most = std::max(most, length(contact.impulse));
    before = now;
  }
  EXPECT_GT(most, 1e-3) << "nothing was touched";
}

/// A liquid of 200 Pa s, 8 cells deep, that shears in x above the floor or above a solid of four
/// cells.
struct Sheared {
  static constexpr double h = 0.005, deep = 8 * h;
  World<float> world = empty_world<float>(h, {8, 20, 8}, WallType::open);
  std::unique_ptr<Backend<float>> backend = make_cpu_backend();

  Sheared(bool on_solid, double dt) {
    world.walls[2] = {WallType::slip, 0, !on_solid};
    world.periodic = {true, false, true};
    world.settings.fps = 100;
    world.settings.fixed_dt = dt;
    add_set(world, "newtonian", values_of("newtonian", {{"density", 1000}, {"viscosity", 200}, {"bulk_modulus", 1e6}}),
            h / 2);
    const double bottom = on_solid ? 4 * h : 0;
    std::vector<std::vector<ParticleSeed>> seeds{
        lattice({{0, bottom, 0}, {8 * h, bottom + deep, 8 * h}}, h / 2,
                [=](const Vec3d& p) { return Vec3d{std::sin((p.y - bottom) / deep * std::numbers::pi / 2), 0, 0}; })};
    if (on_solid) {
      add_set(world, "elastic", values_of("elastic", {{"density", 1000}, {"youngs_modulus", 1e4}}), h / 2);
      const auto after = static_cast<std::uint32_t>(seeds[0].size());
      seeds.push_back(lattice({{}, {8 * h, bottom, 8 * h}}, h / 2, [](const Vec3d&) { return Vec3d{}; }, after));
    }
    begin(world, *backend, seeds);
    backend->grid_update(world, dt);
  }
  /// N s, along x.
  double momentum() const {
    double sum = 0;
    for (const Node<float>& n : world.grid.nodes) sum += static_cast<double>(n.m) * static_cast<double>(n.x);
    return sum;
  }
};

// Each halving of the time step brings the impulse on a wall or a solid in stages closer to that in
// many short steps, with particles where they are: by first order.
TEST(SubCycle, ViscousContactIsOneOfTheForcesOfAStage) {
  constexpr double time = 2.5e-4;
  for (const bool on_solid : {false, true}) {
    const auto taken = [&](int steps, int stages) {
      const double dt = time / steps;
      Sheared s(on_solid, dt);
      EXPECT_EQ(s.world.viscous_stages, steps < 100 ? stages : 0);
      s.world.viscous_stages = stages;
      const double start = s.momentum();
      GridStats found;
      for (int i = 0; i < steps; ++i) s.backend->sub_cycle(s.world, dt, found);
      return 1 - s.momentum() / start;
    };
    const double want = taken(200, 2), whole = taken(1, 6), quarters = taken(4, 3);
    std::printf("%s took %.5f of the momentum in one step, %.5f in four, %.5f in many\n",
                on_solid ? "a solid" : "the floor", whole, quarters, want);
    EXPECT_GT(want, 0.01);
    EXPECT_NEAR(whole, want, 0.1 * want);
    EXPECT_LT(std::abs(quarters - want), 0.5 * std::abs(whole - want));
  }
}

}  // namespace
}  // namespace dreampm::sub_cycle_test
