// Large steps of liquids by a projection.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"
#include "dreampm/solver/projection/pressure.h"
#include "dreampm/solver/projection/projection.h"
#include "mixed_world.h"

namespace dreampm::projection_test {
namespace {
using namespace test;

constexpr double spacing = 0.01, dx = 0.02;

/// Water in a box of `cells` cells between walls.
template <class R>
World<R> water(const Vec3i& cells) {
  World<R> w = empty_world<R>(dx, {});
  w.set_domain(cells);
  w.gravity = {0, -9.81, 0};
  w.settings.fps = 24, w.settings.cfl = 2, w.settings.solver = SolverKind::projection;
  add_set(w, "newtonian", values_of("newtonian", {{"bulk_modulus", 1e5}}), spacing);
  w.sets[0].carries_motion = true;
  return w;
}

/// A lattice, each particle off its place by up to a quarter of the spacing: on a lattice alone the
/// particles of a cell fall together.
std::vector<ParticleSeed> jittered(const Box3d& box, const Field& velocity) {
  std::vector<ParticleSeed> seeds = lattice(box, spacing, velocity);
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> off(-0.25 * spacing, 0.25 * spacing);
  for (ParticleSeed& s : seeds) s.position += Vec3d{off(dice), off(dice), off(dice)};
  return seeds;
}

template <class R>
struct Flow {
  World<R> world;
  Projection<R> solver;
  Motion<R> motion;
  Flow(World<R> w, const std::vector<ParticleSeed>& seeds) : world(std::move(w)) { solver.begin(world, {seeds}); }
  void to_frame(int frame) {
    while (world.frame < frame) solver.step(world, motion, 1e30, nullptr);
  }
  /// m/s, rms over all particles.
  double speed() const {
    double sum = 0;
    const auto& set = world.sets[0];
    for (std::size_t p = 0; p < set.size(); ++p)
      for (const auto& v : set.own_velocity) sum += static_cast<double>(v[p] * v[p]);
    return std::sqrt(sum / static_cast<double>(set.size()));
  }
  /// The mean density of the cells that have liquid on all sides, over that at rest.
  double density_inside() const {
    MacGrid<R> grid;
    grid.lay(world);
    particles_to_grid(world, projection_kernels<R>("auto"), grid);
    find_depths(grid, 0);
    double sum = 0;
    int cells = 0;
    for (const CellRows::Row& row : grid.cells.rows()) {
      const RowPlaces at(row);
      for (std::size_t l = 0; l < row_cells; ++l) {
        bool inside = grid.depth[at.own + l] > R(0);
        for (std::size_t a = 0; a < 3; ++a)
          for (const std::size_t beside : {at.low[a] + l, at.high[a] + l}) inside = inside && grid.depth[beside] > R(0);
        if (inside) sum += static_cast<double>(grid.density[at.own + l]), ++cells;
      }
    }
    return sum / cells;
  }
  Vec3d center() const {
    Vec3d sum{};
    ParticleSetView<R>(world, 0).for_each([&](std::size_t, const Vec3d& x) { sum += x; });
    return sum / static_cast<double>(world.particles());
  }
};

template <class R>
class ProjectionStep : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ProjectionStep, Precisions);

TYPED_TEST(ProjectionStep, AFallIsExact) {
  using R = TypeParam;
  Flow<R> run(water<R>({16, 64, 16}), jittered({{0.1, 0.9, 0.1}, {0.2, 1.0, 0.2}}, still()));
  const Vec3d start = run.center();
  run.to_frame(6);
  const double t = run.world.time, fallen = start.y - run.center().y;
  EXPECT_NEAR(fallen, 0.5 * 9.81 * t * t, 0.05 * dx);
  EXPECT_LT(run.world.step, 40u);
}

TYPED_TEST(ProjectionStep, WhatFlowsIntoACellFlowsOut) {
  using R = TypeParam;
  // A block thrown into a corner.
  Flow<R> run(water<R>({16, 16, 16}),
              jittered({{0, 0, 0}, {0.16, 0.2, 0.16}}, [](const Vec3d& x) { return Vec3d{-1, x.x * 4, x.y * 5}; }));
  MacGrid<R> grid;
  grid.lay(run.world);
  particles_to_grid(run.world, projection_kernels<TypeParam>("auto"), grid);
  find_free_velocities(grid, {0, -0.1, 0});
  find_depths(grid, 0);
  PressureSolver<R> solver;
  solver.begin(grid.cells, 16);
  fill_matrix(grid, solver.matrix());
  solver.set_up();
  const double norm = solver.norm_of_right_side();
  EXPECT_GT(norm, 1);
  solver.solve(grid.impulse, 1e-5, norm, 60);
  apply_pressure(grid, {});
  // The right side of the velocities after the pressure: what still flows in.
  grid.free = grid.velocity;
  fill_matrix(grid, solver.matrix());
  EXPECT_LT(solver.norm_of_right_side(), 2e-5 * norm);
}

TYPED_TEST(ProjectionStep, StillWaterStaysStillAndKeepsItsDepth) {
  using R = TypeParam;
  Flow<R> run(water<R>({12, 16, 12}), jittered({{0, 0, 0}, {0.24, 0.2, 0.24}}, still()));
  const double before = run.center().y;
  run.to_frame(49);  // 2 s
  EXPECT_LT(run.speed(), 2e-3);
  EXPECT_NEAR(run.center().y, before, 0.03 * dx);
  // Pressure grows by rho g h.
  const auto at = [&](int depth) {
    const Vec3i cell = run.world.low + Vec3i{6, 10 - depth, 6};
    const auto b = run.world.grid.blocks.find(block_of(cell));
    return static_cast<double>(
        run.world
            .cell_pressure[static_cast<std::size_t>(b * block_nodes + node_index(cell.x & 3, cell.y & 3, cell.z & 3))]);
  };
  EXPECT_NEAR(at(9) - at(3), 1000 * 9.81 * 6 * dx, 0.01 * 1000 * 9.81 * 6 * dx);
}

TYPED_TEST(ProjectionStep, MatterLeavesASeparateWallAndNotOneThatSlips) {
  using R = TypeParam;
  for (const WallType type : {WallType::separate, WallType::slip}) {
    World<R> w = water<R>({16, 12, 12});
    w.gravity = {}, w.walls[0].type = type;
    Flow<R> run(std::move(w),
                jittered({{0, 0.08, 0.08}, {0.08, 0.16, 0.16}}, [](const Vec3d&) { return Vec3d{1, 0, 0}; }));
    const Vec3d start = run.center();
    run.to_frame(3);
    const double gone = run.center().x - start.x;
    if (type == WallType::separate)
      EXPECT_NEAR(gone, run.world.time, 0.05 * dx);
    else
      EXPECT_LT(gone, 0.9 * run.world.time);
  }
}

TYPED_TEST(ProjectionStep, ASplashKeepsItsVolume) {
  using R = TypeParam;
  Flow<R> run(water<R>({16, 24, 16}), jittered({{0, 0, 0}, {0.12, 0.24, 0.32}}, still()));
  double densest = 0, loosest = 2;
  for (int frame = 2; frame <= 37; ++frame) {
    run.to_frame(frame);
    // From the pressure of the step before; twice where matter leaves a wall.
    EXPECT_LE(run.solver.pressure_iterations(), 24);
    EXPECT_LE(run.solver.density_iterations(), 3);
    const double inside = run.density_inside();
    densest = std::max(densest, inside), loosest = std::min(loosest, inside);
  }
  EXPECT_LT(densest, 1.02);
  EXPECT_GT(loosest, 0.98);
  EXPECT_EQ(run.world.particles(), 12u * 24 * 32);
}

/// A ball off the nodes in water at rest.
template <class R>
World<R> water_around_a_ball(double radius) {
  World<R> w = water<R>({16, 20, 16});
  w.colliders.push_back({"ball", sphere({0.163, 0.157, 0.161}, radius), WallType::separate});
  return w;
}

TEST(CutCells, OpenPartsAddUpToTheRoomOutsideOfABall) {
  const double radius = 0.09;
  const World<double> w = water_around_a_ball<double>(radius);
  World<double> laid = w;
  Projection<double> solver;
  solver.begin(laid, {jittered({{0, 0, 0}, {0.32, 0.32, 0.32}}, still())});
  MacGrid<double> grid;
  CutCells<double> cut;
  grid.lay(laid);
  cut.cut(laid, grid);
  double filled = 0, closed = 0;
  for (const CellRows::Row& row : grid.cells.rows()) {
    const auto [first, last] = grid.lanes_within(row);
    for (int l = first; l < last; ++l) {
      const std::size_t at = RowPlaces(row).own + static_cast<std::size_t>(l);
      filled += 1 - grid.room[at];
      if (row.first.x == grid.low.x + 8) closed += 1 - grid.open[0][at];
    }
  }
  constexpr double pi = 3.14159265358979;
  EXPECT_NEAR(filled * dx * dx * dx, 4.0 / 3 * pi * radius * radius * radius, 0.03 * filled * dx * dx * dx);
  // Faces at x = 0.16, 3 mm beside the ball's middle.
  const double slice = pi * (radius * radius - 0.003 * 0.003);
  EXPECT_NEAR(closed * dx * dx, slice, 0.03 * slice);
}

TEST(CutCells, WaterAroundABallStaysStillAndNoneIsWithin) {
  const double radius = 0.06;
  World<float> w = water_around_a_ball<float>(radius);
  std::vector<ParticleSeed> seeds = jittered({{0, 0, 0}, {0.32, 0.3, 0.32}}, still());
  std::erase_if(seeds, [&](const ParticleSeed& s) { return w.colliders[0].distance(s.position) < 0.1 * spacing; });
  for (std::size_t i = 0; i < seeds.size(); ++i) seeds[i].id = static_cast<std::uint32_t>(i);
  const std::size_t count = seeds.size();
  Flow<float> run(std::move(w), seeds);
  run.to_frame(37);
  EXPECT_LT(run.speed(), 4e-3);
  EXPECT_EQ(run.world.particles(), count);
  double deepest = 0;
  ParticleSetView<float>(run.world, 0).for_each([&](std::size_t, const Vec3d& x) {
    deepest = std::min(deepest, run.world.colliders[0].distance(x));
  });
  EXPECT_GT(deepest, -0.01 * dx);
}

TEST(Viscosity, WhatTurnsAsAWholeStaysAsItIsAndWhatShearsLosesWhatItMakesOfHeat) {
  const auto changed = [](const Field& velocity, double* heat) {
    World<double> w = water<double>({20, 20, 20});
    w.gravity = {};
    std::vector<ParticleSeed> seeds = jittered({{0.1, 0.1, 0.1}, {0.3, 0.2, 0.3}}, velocity);
    for (ParticleSeed& s : seeds)
      for (int a = 0; a < 3; ++a) {
        Vec3d step{};
        step[a] = 1e-3;
        const Vec3d slope = (velocity(s.position + step) - velocity(s.position - step)) * 500.0;
        for (int c = 0; c < 3; ++c) s.gradient(c, a) = slope[c];
        s.velocity = velocity(s.position);
      }
    Flow<double> run(std::move(w), seeds);
    MacGrid<double> grid;
    grid.lay(run.world);
    particles_to_grid(run.world, projection_kernels<double>("auto"), grid);
    find_free_velocities(grid, {});
    find_depths(grid, 0);
    const auto before = grid.free;
    Viscosity<double> viscosity;
    const ViscousSolve solved = viscosity.solve(run.world, grid, {}, {}, 10, 1000);
    double most = 0, kinetic = 0;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t f = 0; f < before[a].size(); ++f) {
        if (!is_known(before[a][f])) continue;
        most = std::max(most, std::abs(grid.free[a][f] - before[a][f]));
        kinetic += grid.sums[a][f].weight * (before[a][f] * before[a][f] - grid.free[a][f] * grid.free[a][f]) / 2;
      }
    if (heat) *heat = solved.heat / (kinetic / 8);  // 8 particles a cell
    return most;
  };
  EXPECT_LT(changed([](const Vec3d& x) { return Vec3d{-(x.z - 0.2), 0, x.x - 0.2}; }, nullptr), 1e-4);
  double heat = 0;
  EXPECT_GT(changed([](const Vec3d& x) { return Vec3d{x.y - 0.15, 0, 0}; }, &heat), 0.02);
  EXPECT_NEAR(heat, 1, 0.2) << "of what the faces lost";
}

TEST(ProjectionBits, AreTheSameForAnyNumberOfThreads) {
  const auto hash = [](int threads) {
    std::uint64_t h = 0;
    ThreadArena(threads).run([&] {
      Flow<float> run(water<float>({16, 24, 16}), jittered({{0, 0, 0}, {0.12, 0.24, 0.32}}, still()));
      run.to_frame(7);
      h = state_hash(run.world);
    });
    return h;
  };
  const ThreadLimit four(4);
  const std::uint64_t one = hash(1);
  EXPECT_EQ(hash(2), one);
  EXPECT_EQ(hash(3), one);
}

TEST(ProjectionBits, AreTheSameForAnyInstructionSet) {
  // Beside a ball, with drops in the air, so that every way through the kernels is taken.
  const auto hash = [](Backend<float>& backend) {
    World<float> w = water<float>({16, 24, 16});
    Shape ball;
    ball.form = SphereShape{0.05};
    ball.center = Vec3d{0.2, 0.03, 0.16};
    w.colliders.push_back({"ball", make_region(ball, w.dx, {}), WallType::slip, 0});
    std::vector<ParticleSeed> seeds = jittered({{0, 0, 0}, {0.12, 0.24, 0.32}}, still());
    for (std::uint32_t n = 0; n < 7; ++n)
      seeds.push_back({100000 + n, {0.2 + 0.01 * n, 0.4, 0.1 + 0.03 * n}, {0, -1, 0.1 * n}, {}});
    Projection<float> solver(&backend);
    solver.begin(w, {seeds});
    Motion<float> motion;
    while (w.frame < 7) solver.step(w, motion, 1e30, nullptr);
    return state_hash(w);
  };
  const std::uint64_t plain = hash(*make_reference_backend<float>());
  for (const std::string_view isa : cpu_instruction_sets()) {
    EXPECT_EQ(projection_kernels<float>(isa).isa, isa);
    EXPECT_EQ(hash(*make_cpu_backend(isa)), plain) << isa;
  }
}

TEST(ProjectionBits, ACopyGoesOnAsTheWorldDoes) {
  Flow<float> run(water<float>({16, 24, 16}), jittered({{0, 0, 0}, {0.12, 0.24, 0.32}}, still()));
  run.to_frame(4);
  World<float> copy = run.world;
  run.to_frame(7);
  Projection<float> other;
  Motion<float> motion;
  while (copy.frame < 7) other.step(copy, motion, 1e30, nullptr);
  EXPECT_EQ(state_hash(copy), state_hash(run.world));
}

}  // namespace
}  // namespace dreampm::projection_test
