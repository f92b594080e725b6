// Periodic axes: the seam must not be there.
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/base/parallel.h"
#include "worlds.h"

namespace dreampm::periodic_test {
namespace {
using namespace test;

constexpr double dx = 0.02, spacing = 0.01;

/// A box of `blocks` blocks, periodic on all axes.
template <class R>
World<R> torus(const Vec3i& blocks) {
  World<R> w = empty_world<R>(dx, blocks * block_width, WallType::open);
  w.periodic = {true, true, true};
  return w;
}

template <class R>
Vec3d period(const World<R>& w) {
  return static_cast<Vec3d>(w.high - w.low) * w.dx;
}

/// The shortest way from a to b on the torus.
Vec3d way(const Vec3d& a, const Vec3d& b, const Vec3d& length_of) {
  Vec3d d = b - a;
  for (int i = 0; i < 3; ++i) d[i] -= length_of[i] * std::round(d[i] / length_of[i]);
  return d;
}

template <class R>
void expect_inside(const World<R>& w) {
  for (const Vec3d& p : positions_by_id(w))
    for (int a = 0; a < 3; ++a) {
      ASSERT_GE(p[a], 0);
      ASSERT_LE(p[a], period(w)[a]);
    }
}

template <class R>
void fly(Backend<R>& backend, const Vec3i& blocks, double allowed) {
  World<R> w = torus<R>(blocks);
  add_set(w, "elastic", values_of("elastic", {{"youngs_modulus", 1e4}}), spacing);
  add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), spacing);
  const Vec3d v{3, -1.7, -2.2}, length_of = period(w);
  const Field field = [&](const Vec3d&) { return v; };
  // Across a corner of the domain from the start: it is wrapped.
  std::vector<std::vector<ParticleSeed>> seeds{lattice({{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}}, spacing, field)};
  seeds.push_back(lattice({{0.03, 0.03, 0.03}, {0.05, 0.05, 0.05}}, spacing, field, 8));
  const double dt = 5e-4;
  w.settings.fps = 1 / dt;
  w.settings.fixed_dt = dt;
  begin(w, backend, seeds);
  const Balance start = balance(w, initial_velocities(w, seeds));
  Motion<R> motion;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    step(w, backend, &motion);
    if (i % 40 == 0) expect_inside(w);
  }
  const Balance end = balance(w, motion);
  EXPECT_DOUBLE_EQ(end.mass, start.mass);
  EXPECT_LT(length(end.momentum - start.momentum), allowed * length(start.momentum)) << blocks.x;
  const auto x = positions_by_id(w);
  double worst = 0;
  for (const auto& set : seeds)
    for (const ParticleSeed& b : set)
      worst = std::max(worst, length(way(b.position + v * (n * dt), x[b.id], length_of)) / dx);
  // Every step rounds the position once.
  EXPECT_LT(worst, allowed * n) << blocks.x << blocks.y << blocks.z;
  EXPECT_EQ(w.left, 0u);
}

TEST(Periodic, FreeFlightDoesNotSeeTheSeam) {
  for (const Vec3i& blocks : {Vec3i{3, 4, 5}, Vec3i{2, 2, 2}, Vec3i{1, 2, 3}, Vec3i{1, 1, 1}}) {
    fly<double>(*make_reference_backend<double>(), blocks, 1e-13);
    fly<float>(*make_cpu_backend(), blocks, 1e-5);
  }
}

/// A liquid and an elastic block that collide, everything shifted by `shift` before it is wrapped.
template <class R>
World<R> collision(const Vec3i& blocks, const Vec3d& shift, std::vector<std::vector<ParticleSeed>>& seeds) {
  World<R> w = torus<R>(blocks);
  w.settings.fps = 200;
  w.settings.fixed_dt = 2e-4;
  add_set(w, "elastic", values_of("elastic", {{"youngs_modulus", 1e4}}), spacing);
  add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), spacing);
  const Vec3d length_of = period(w);
  seeds = {lattice({{0.02, 0.02, 0.02}, {0.08, 0.07, 0.08}}, spacing,
                   [](const Vec3d& p) { return Vec3d{1 - 2 * p.y, 1, 0.5}; })};
  seeds.push_back(lattice(
      {{0.09, 0.02, 0.01}, {0.15, 0.1, 0.06}}, spacing, [](const Vec3d& p) { return Vec3d{-2, -1 + 3 * p.z, 0.7}; },
      static_cast<std::uint32_t>(seeds[0].size())));
  for (auto& set : seeds)
    for (ParticleSeed& n : set) n.position += shift * length_of;
  return w;
}

TEST(Periodic, ATranslatedSceneGoesTheSameWay) {
  for (const Vec3i& blocks : {Vec3i{3, 2, 2}, Vec3i{2, 1, 3}}) {
    const auto backend = make_reference_backend<double>();
    std::vector<Vec3d> plain;
    // By half a period, by less than a cell, and by several periods.
    for (const Vec3d& shift : {Vec3d{}, Vec3d{0.5, 0.5, 0.5}, Vec3d{5.0 / 24, -7.0 / 16, 2 + 7.0 / 24}}) {
      std::vector<std::vector<ParticleSeed>> seeds;
      World<double> w = collision<double>(blocks, shift, seeds);
      // The lattice of nodes must come to lie on itself.
      const Vec3d cells = shift * static_cast<Vec3d>(w.high);
      const Vec3d whole{std::round(cells.x), std::round(cells.y), std::round(cells.z)};
      for (auto& set : seeds)
        for (ParticleSeed& n : set) n.position += (whole - cells) * dx;
      begin(w, *backend, seeds);
      for (int i = 0; i < 300; ++i) step<double>(w, *backend, nullptr);
      auto x = positions_by_id(w);
      if (plain.empty()) {
        plain = x;
        continue;
      }
      double worst = 0;
      for (std::size_t i = 0; i < x.size(); ++i)
        worst = std::max(worst, length(way(plain[i] + whole * dx, x[i], period(w))) / dx);
      std::printf("shifted by %g cells: %.1e cells apart\n", whole.x, worst);
      EXPECT_LT(worst, 1e-12);  // sums run in another order
    }
  }
}

TEST(Periodic, MomentumIsKeptToRoundOff) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<double> w = collision<double>({3, 2, 1}, {0.1, 0.2, 0.3}, seeds);
  const auto backend = make_reference_backend<double>();
  begin(w, *backend, seeds);
  const Balance start = balance(w, initial_velocities(w, seeds));
  double worst = 0;
  Motion<double> motion;
  for (int i = 0; i < 1000; ++i)
    if (step(w, *backend, &motion).frame_done)
      worst = std::max(worst, length(balance(w, motion).momentum - start.momentum));
  EXPECT_LT(worst, 1e-13 * start.mass);  // kg times 1 m/s
  EXPECT_GT(std::abs(balance(w, motion).kinetic / start.kinetic - 1), 0.1) << "they did collide";
  expect_inside(w);
}

TEST(Periodic, CpuFollowsTheReferenceAndThreadsChangeNothing) {
  for (const Vec3i& blocks : {Vec3i{5, 3, 2}, Vec3i{3, 1, 4}}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    std::vector<Vec3d> want;
    {
      World<float> w = collision<float>(blocks, {0.3, 0.4, 0.5}, seeds);
      const auto reference = make_reference_backend<float>();
      begin(w, *reference, seeds);
      for (int i = 0; i < 200; ++i) step<float>(w, *reference, nullptr);
      want = positions_by_id(w);
    }
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      World<float> w = collision<float>(blocks, {0.3, 0.4, 0.5}, seeds);
      const auto cpu = make_cpu_backend();
      begin(w, *cpu, seeds);
      for (int i = 0; i < 100; ++i) step<float>(w, *cpu, nullptr);
      // A copy with a fresh backend goes on the same way.
      World<float> copy = w;
      const auto other = make_cpu_backend();
      other->attach(copy);
      for (int i = 0; i < 100; ++i) step<float>(copy, *other, nullptr), step<float>(w, *cpu, nullptr);
      EXPECT_EQ(state_hash(copy), state_hash(w));
      hashes.push_back(state_hash(w));
      const auto got = positions_by_id(w);
      double sum = 0;
      for (std::size_t i = 0; i < want.size(); ++i) sum += length2(way(want[i], got[i], period(w))) / (dx * dx);
      EXPECT_LE(std::sqrt(sum / static_cast<double>(want.size())), 1e-5);
    }
    for (const auto h : hashes) EXPECT_EQ(h, hashes[0]);
  }
}

TEST(Periodic, ALiquidThatFillsTheTorusSeesNoWall) {
  World<float> w = torus<float>({2, 3, 1});
  add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), spacing);
  const auto cpu = make_cpu_backend();
  w.settings.fps = 1000;
  begin(w, *cpu, {lattice({{}, period(w)}, spacing, still())});
  for (int i = 0; i < 500; ++i) step<float>(w, *cpu, nullptr);
  for (const float e : w.sets[0].state[0]) ASSERT_NEAR(e, 0, 1e-5);
}

TEST(Periodic, AColliderOnTheSeamStandsOnBothSides) {
  const auto after = [&](double center) {
    World<double> w = empty_world<double>(dx, {16, 12, 12}, WallType::separate);
    w.walls[0] = w.walls[1] = {WallType::open, 0};
    w.periodic = {true, false, false};
    Shape ball;
    ball.form = SphereShape{0.05};
    ball.center = Vec3d{center, 0.12, 0.12};
    w.colliders.push_back({"ball", make_region(ball, dx, {}), WallType::slip, 0});
    add_set(w, "elastic", values_of("elastic", {{"youngs_modulus", 1e4}}), spacing);
    const auto backend = make_reference_backend<double>();
    w.settings.fps = 1000;
    begin(w, *backend,
          {lattice({{0.12, 0.08, 0.08}, {0.2, 0.16, 0.16}}, spacing, [](const Vec3d&) { return Vec3d{3, 0, 0}; })});
    Vec3d impulse{};
    for (int i = 0; i < 300; ++i) impulse += step<double>(w, *backend, nullptr).grid.contact().impulse;
    EXPECT_LT(impulse.x, 0);
    return positions_by_id(w);
  };
  const auto low = after(0), high = after(0.32);
  for (std::size_t i = 0; i < low.size(); ++i) ASSERT_LT(length(low[i] - high[i]), 1e-9);
}

/// The rate [1/s] at which the kinetic energy of a Taylor-Green vortex on a torus decays, times its
/// exact time.
double vortex_decay(double viscosity) {
  const int blocks = 8;
  World<float> w = torus<float>({blocks, blocks, 1});
  const double side = blocks * 4 * dx, k = 2 * std::numbers::pi / side, speed = 0.5;
  add_set(
      w, "newtonian",
      values_of(
          "newtonian",
          {{"viscosity", viscosity * 1000}, {"bulk_modulus", 1e5}, {"gamma", -1}, {"tension", 1}, {"relaxation", 0}}),
      spacing);
  const std::vector<std::vector<ParticleSeed>> seeds{lattice({{}, period(w)}, spacing, [&](const Vec3d& p) {
    return Vec3d{speed * std::sin(k * p.x) * std::cos(k * p.y), -speed * std::cos(k * p.x) * std::sin(k * p.y), 0};
  })};
  w.settings.fps = 10;
  const auto cpu = make_cpu_backend();
  begin(w, *cpu, seeds);
  const double start = balance(w, initial_velocities(w, seeds)).kinetic;
  Motion<float> motion;
  while (!step(w, *cpu, &motion).frame_done) continue;
  const double rate = std::log(start / balance(w, motion).kinetic) / w.time;
  std::printf("Taylor-Green: energy decays at %.4f of the exact rate\n", rate / (4 * viscosity * k * k));
  return rate / (4 * viscosity * k * k);
}
TEST(Periodic, TaylorGreenVorticesDecayAsViscositySays) { EXPECT_NEAR(vortex_decay(0.02), 1, 0.05); }

}  // namespace
}  // namespace dreampm::periodic_test
