// Gravity that changes, and force fields, against exact solutions of the motion of a block without
// walls.
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/base/parallel.h"
#include "worlds.h"

namespace dreampm::forces_test {
namespace {
using namespace test;

constexpr double dx = 0.02, spacing = 0.01;

/// A block of 4 cells' width without walls, uniformly moving.
struct Block {
  World<double> world = empty_world<double>(dx, {100, 100, 100}, WallType::open);
  std::unique_ptr<Backend<double>> backend = make_reference_backend<double>();
  Balance last;
  Vec3d field_impulse{};
  double field_work = 0, fastest_in_cells = 0;

  void start(const Vec3d& center, const Vec3d& v, double youngs = 1e4, double half = 0.02) {
    add_set(world, "elastic", values_of("elastic", {{"youngs_modulus", youngs}}), spacing);
    const Vec3d h{half, half, half};
    begin(world, *backend, {lattice({center - h, center + h}, spacing, [=](const Vec3d&) { return v; })});
  }
  /// Steps to the end of the frame that starts now.
  void frame() {
    Motion<double> motion;
    while (true) {
      const StepSums r = step(world, *backend, &motion);
      field_impulse += r.grid.fields.impulse;
      field_work += r.grid.fields.work;
      fastest_in_cells = std::max(fastest_in_cells, r.grid.max_speed * r.dt / dx);
      if (r.frame_done) break;
    }
    last = balance(world, motion);
  }
  Vec3d velocity() const { return last.momentum / last.mass; }
  Vec3d center() const {
    Vec3d sum{};
    for (const Vec3d& x : positions_by_id(world)) sum += x;
    return sum / static_cast<double>(world.particles());
  }
};

TEST(Gravity, FollowsItsKeysExactly) {
  // Down, through nothing to sideways: the velocity is the integral of g, whatever the steps.
  Block b;
  b.world.gravity_keys = {{0.01, {0, -10, 0}}, {0.03, {4, 0, 0}}, {0.031, {4, 0, 2}}};
  b.world.settings.fps = 20;
  b.start({1, 1, 1}, {});
  b.frame();
  const Vec3d want = Vec3d{0, -10, 0} * 0.01 + Vec3d{2, -5, 0} * 0.02 + Vec3d{4, 0, 1} * 0.001 +
                     Vec3d{4, 0, 2} * (b.world.time - 0.031);
  EXPECT_GT(b.world.step, 3u);
  EXPECT_LT(length(b.velocity() - want), 1e-12);
  // Potential energy uses the gravity of the moment.
  EXPECT_NEAR(b.last.gravity, -b.last.mass * dot(Vec3d{4, 0, 2}, b.center()), 1e-12 * b.last.mass);
}

TEST(Fields, DragDecaysExactlyAtAnyRate) {
  for (const double rate : {0.0, 3.0, 200.0, 1e7}) {
    Block b;
    b.world.fields = {{"air", Drag{rate, {1, 0, 0}}, {}}};
    b.world.settings.fps = 50;
    b.start({1, 1, 1}, {3, 1, -2});
    b.frame();
    const Vec3d want = Vec3d{1, 0, 0} + Vec3d{2, 1, -2} * std::exp(-rate * b.world.time);
    EXPECT_LT(length(b.velocity() - want), 1e-12) << rate;
    EXPECT_LT(length(b.field_impulse / b.last.mass - (b.velocity() - Vec3d{3, 1, -2})), 1e-12) << rate;
  }
}

TEST(Fields, WindDecaysAsTheSquareLawSays) {
  for (const double k : {0.5, 1e8}) {
    Block b;
    b.world.fields = {{"gust", Wind{{5, 0, 0}, k}, {}}};
    b.world.settings.fps = 50;
    b.start({1, 1, 1}, {2, 0, 4});
    b.frame();
    const Vec3d r0{-3, 0, 4};
    EXPECT_LT(length(b.velocity() - (Vec3d{5, 0, 0} + r0 / (1 + k * 5 * b.world.time))), 1e-12) << k;
  }
}

TEST(Fields, ABlockCirclesAnAttractor) {
  const double distance = 0.4, radius = 0.1, strength = 2;
  const double a = strength * distance / std::pow(distance * distance + radius * radius, 1.5);
  const double period = 2 * std::numbers::pi * std::sqrt(distance / a);
  Block b;
  b.world.fields = {{"sun", Attractor{{1, 1, 1}, strength, radius}, {}}};
  b.world.settings.fps = 4 / period;
  b.start({1 + distance, 1, 1}, {0, 0, std::sqrt(a * distance)}, 3e4, 0.02);
  const Vec3d places[] = {{1, 1, 1 + distance}, {1 - distance, 1, 1}, {1, 1, 1 - distance}, {1 + distance, 1, 1}};
  for (const Vec3d& place : places) {
    b.frame();
    // The block is a tenth of its distance wide: the pull on it is not quite that on its center.
    EXPECT_LT(length(b.center() - place), 0.02 * distance);
  }
}

// Let go, and pressed to a wall, where a push of a dt in every step and stress that takes it back
// must not add up.
TEST(Fields, WorkIsWhatThePotentialLoses) {
  const double strength = 40, radius = 0.1;
  for (const double place : {1.0, 2.0 - 0.02}) {
    Block b;
    const Vec3d sun{3, 1, 1};
    b.world.walls.fill({WallType::slip});
    b.world.fields = {{"sun", Attractor{sun, strength, radius}, {}}};
    b.world.settings.fps = 20;
    b.start({place, 1, 1}, {});
    const auto potential = [&] {
      double sum = 0;
      for (const Vec3d& x : positions_by_id(b.world)) sum -= strength / std::hypot(length(x - sun), radius);
      return sum * b.world.sets[0].mass;
    };
    const double before = potential();
    b.frame();
    const double lost = before - potential(), a = place > 1.5 ? strength : strength / 4;
    const double dt = b.world.time / static_cast<double>(b.world.step);
    // The error is as large as an energy of half the square of a push in every step.
    const double squares = 0.5 * b.last.mass * a * a * dt * b.world.time;
    std::printf("work %.6g J, potential lost %.6g J, squares %.3g J\n", b.field_work, lost, squares);
    EXPECT_NEAR(b.field_work, lost, 0.1 * squares);
  }
}

TEST(Fields, NegativeStrengthPushes) {
  Block b;
  b.world.fields = {{"push", Attractor{{0.5, 1, 1}, -1, 0.05}, {}}};
  b.world.settings.fps = 1000;
  b.start({1, 1, 1}, {});
  b.frame();
  EXPECT_NEAR(b.velocity().x, 0.5 / std::pow(0.25 + 0.0025, 1.5) * 1e-3, 0.005 * 4e-3);
}

TEST(Fields, ABoxLimitsThem) {
  Block in, out;
  for (Block* b : {&in, &out}) {
    b->world.fields = {{"hall", Drag{1e6, {}}, Box3d{{0, 0, 0}, {0.5, 2, 2}}}};
    b->world.settings.fps = 100;
  }
  in.start({0.3, 1, 1}, {0, 1, 0});
  out.start({0.7, 1, 1}, {0, 1, 0});
  in.frame(), out.frame();
  EXPECT_LT(length(in.velocity()), 1e-12);
  EXPECT_LT(length(out.velocity() - Vec3d{0, 1, 0}), 1e-12);
}

// Matter at rest in a soft block: its wave speed alone would allow steps in which these fields move
// it over many cells.
TEST(Fields, StrongOnesKeepTheCourantBound) {
  const std::vector<AnyField> strong{Attractor{{1.2, 1, 1}, 1e3, 0.05}, Attractor{{1, 1, 1}, -1e3, 1e-3},
                                     Wind{{300, 0, 0}, 1e3}, Drag{1e5, {0, 200, 0}}};
  for (const AnyField& f : strong) {
    Block b;
    b.world.fields = {{"storm", f, {}}};
    b.world.settings.fps = 2000;
    b.start({1, 1, 1}, {}, 100);
    EXPECT_LT(b.world.dt_next, 0.1 * b.world.settings.cfl * dx / b.world.wave_speed)
        << "the first step knows of it too";
    b.frame();
    EXPECT_GT(length(b.field_impulse) + b.last.kinetic, 0);
    EXPECT_LE(b.fastest_in_cells, b.world.settings.cfl * (1 + 1e-9)) << Fields::Any(f).index();
    EXPECT_LT(b.world.step, 2000u);
  }
}

TEST(Fields, ThreadsDoNotChangeABit) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 3, 8}) {
    const ThreadLimit limit(threads);
    World<float> w = empty_world<float>(dx, {30, 30, 30});
    w.gravity_keys = {{0, {0, -9, 0}}, {0.01, {3, 0, 0}}};
    w.fields = {{"air", Drag{5, {}}, {}},
                {"gust", Wind{{2, 0, 1}, 3}, Box3d{{0, 0.1, 0}, {1, 1, 0.3}}},
                {"sun", Attractor{{0.3, 0.3, 0.3}, 0.1, 0.05}, {}}};
    w.settings.fps = 100;
    add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), spacing);
    const auto cpu = make_cpu_backend();
    begin(w, *cpu, {lattice({{0.05, 0.05, 0.05}, {0.4, 0.3, 0.35}}, spacing, still())});
    for (int i = 0; i < 60; ++i) step<float>(w, *cpu, nullptr);
    hashes.push_back(state_hash(w));
  }
  for (const auto h : hashes) EXPECT_EQ(h, hashes[0]);
}

}  // namespace
}  // namespace dreampm::forces_test
