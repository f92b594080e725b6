// The instrument: that it counts what it says, and that its scenes are what they are called.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "bench/bench.h"
#include "bench/course.h"
#include "bench/operations.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/particle_view.h"

namespace dreampm {
namespace {

TEST(Counted, CountsWhatDependsOnTheParticle) {
  OperationCount n;
  const Counted a(2.0f, &n), b(3.0f, &n), same(5.0f), zero;
  EXPECT_EQ((a * b + a).v, 8);
  EXPECT_EQ(n.multiplications, 1u);
  EXPECT_EQ(n.additions, 1u);
  EXPECT_EQ(mul_add(a, b, same).v, 11);
  EXPECT_EQ(n.multiply_adds, 1u);
  EXPECT_EQ((a / same).v, 0.4f);  // times 1/5, which is the same for all
  EXPECT_EQ(n.multiplications, 2u);
  EXPECT_EQ((a / b).v, 2.0f / 3);
  EXPECT_EQ(n.divisions, 1u);
  EXPECT_EQ(sqrt(b * same).v, std::sqrt(15.0f));
  EXPECT_EQ(n.roots, 1u);
  EXPECT_EQ(n.slots(true), 7u);
  EXPECT_EQ(n.slots(false), 8u);
  // A value that is the same for all is worked out once, and one that is exactly zero never.
  EXPECT_EQ((same * same + same).v, 30);
  EXPECT_EQ((zero * a + b - zero).v, 3);
  EXPECT_EQ(mul_add(zero, a, b).v, 3);
  EXPECT_EQ(n.slots(true), 7u);
  EXPECT_EQ(max(a, b).v, 3);
  EXPECT_EQ(select(a < b, a, b).v, 2);
  EXPECT_EQ(n.comparisons, 3u);
  EXPECT_EQ(n.slots(true), 7u);
}

TEST(Counted, ALawGivesTheSameNumbers) {
  Materials::for_each([]<class M>() {
    Values values;
    values.with_defaults(M::info.params);
    if (M::info.find("bulk_modulus") && !values.has("bulk_modulus")) values.set("bulk_modulus", 1e5);
    const auto law = M::template Law<float>::from(values);
    OperationCount n;
    typename M::template State<float> plain;
    typename M::template State<Counted> counted;
    for (int c = 0; c < state_columns<M>; ++c) {
      plain[c] = static_cast<float>(M::template State<float>::rest[c]);
      counted[c] = Counted(plain[c], &n);
    }
    StrainIncrement<float> at{{}, 1e-4f, 1.01f, 1e-4f};
    StrainIncrement<Counted> there{{}, Counted(1e-4f), Counted(1.01f, &n), 1e-4f};
    for (int k = 0; k < 9; ++k) {
      at.gradient.m[k] = 0.003f * static_cast<float>(k - 5);
      there.gradient.m[k] = Counted(at.gradient.m[k], &n);
    }
    const float want = law.advance(plain, at).energy;
    const Counted got = law.advance(counted, there).energy;
    EXPECT_NEAR(got.v, want, 1e-4f * std::abs(want) + 1e-6f) << M::info.name;
    EXPECT_GT(n.slots(true), 20u) << M::info.name;
  });
}

TEST(Bench, AStepHasAtLeastTheWorkOfItsStencils) {
  std::map<std::string, double> work;
  for (const MaterialInfo& m : material_infos()) {
    const Course course(column_scene(m, {4, 4, 4}), {});
    const OperationCount n = operations_of(course.world());
    // Gather and scatter: three components of 27 nodes each way, at one operation each, is less
    // than any way of doing it.
    EXPECT_GT(n.slots(true), 2u * 27 * 3) << m.name;
    EXPECT_LT(n.slots(true), 10000u) << m.name;
    work[std::string(m.name)] = static_cast<double>(n.slots(true));
    // Read and written once: a position and the state.
    EXPECT_GT(bytes_moved_of(course.world()), 2 * 16) << m.name;
  }
  // The same particles and nodes: a law without stretches, one with them, one that clamps them and
  // hardens.
  EXPECT_GT(work["elastic"], 50 + work["neo_hookean"]);
  EXPECT_GT(work["snow"], 50 + work["elastic"]);
}

TEST(Bench, TheColumnMovesATwentiethOfACellAStep) {
  for (const char* name : {"newtonian", "snow"}) {
    const Course course(column_scene(*find_material(name), {8, 8, 4}), {});
    EXPECT_EQ(course.world().particles(), 8u * 8 * 8 * 4);
    const Timing t = course.run({}, {3, 0, {}});
    EXPECT_EQ(t.windows.size(), 3u);
    EXPECT_GT(t.steps_per_sort, 14) << name;
    EXPECT_LT(t.steps_per_sort, 23) << name;
    double shares = 0;
    for (const auto& [stage, share] : t.stages) {
      EXPECT_GT(share, 0) << stage;
      shares += share;
    }
    EXPECT_EQ(t.stages.size(), 3u);
    EXPECT_LE(shares, 1);
  }
}

/// The places of a world's first set, by id.
std::map<std::uint32_t, Vec3d> places(const World<float>& world) {
  std::map<std::uint32_t, Vec3d> all;
  const ParticleSetView<float> set(world, 0);
  set.for_each([&](std::size_t p, const Vec3d& x) { all[set.id(p)] = x; });
  return all;
}

TEST(Bench, ACourseBringsHomeWhatADeviceMoved) {
  ASSERT_EQ(::setenv("DREAMPM_CUDA", STAND_IN, 1), 0);
  const BenchScene scene = column_scene(*find_material("snow"), {4, 4, 4});
  const auto there = places(Course(scene, {"cuda"}).world()), here = places(Course(scene, {}).world());
  ASSERT_EQ(there.size(), scene.seeds[0].size());
  double apart = 0, moved = 0;
  for (const ParticleSeed& s : scene.seeds[0]) {
    apart = std::max(apart, length(there.at(s.id) - here.at(s.id)));
    moved = std::max(moved, length(there.at(s.id) - s.position));
  }
  // A sort's distance; a step is a twentieth of a cell.
  EXPECT_GT(moved, 0.5 * bench_dx);
  EXPECT_LT(apart, 0.002 * bench_dx);
}

TEST(Bench, MemoryIsWhatTheProcessTook) {
  const Course course(column_scene(*find_material("newtonian"), {40, 40, 20}), {});
  // Position, state and id at least; and no more than the arrays of a few steps.
  EXPECT_GT(course.memory_per_particle(), 20);
  EXPECT_LT(course.memory_per_particle(), 300);
  EXPECT_GT(bytes_per_particle(course.world()), 20);
}

TEST(Bench, DropletsShareNoNode) {
  const BenchScene scene = droplets_scene(*find_material("newtonian"), 30);
  const auto& all = scene.seeds.at(0);
  ASSERT_EQ(all.size(), 8u * 30);
  std::set<std::array<int, 3>> nodes;
  for (std::size_t d = 0; d < 30; ++d) {
    std::set<std::array<int, 3>> own;
    for (std::size_t p = 8 * d; p < 8 * (d + 1); ++p) {
      const Vec3d cells = all[p].position * (1 / scene.world.dx);
      const auto first = [&](int a) { return static_cast<int>(std::floor(cells[a] - 0.5)); };
      for (int n = 0; n < 27; ++n) own.insert({first(0) + n / 9, first(1) + n / 3 % 3, first(2) + n % 3});
      for (int a = 0; a < 3; ++a) {
        EXPECT_GT(cells[a], 0);
        EXPECT_LT(cells[a], scene.world.high[a]);
      }
    }
    for (const auto& n : own) EXPECT_TRUE(nodes.insert(n).second);
  }
}

TEST(Bench, ColumnsHaveAboutAsManyParticlesAsAsked) {
  EXPECT_EQ(column_cells(1 << 20), (Vec3i{64, 64, 32}));
  for (const double n : {1000.0, 8192.0, 65536.0, 100000.0, 4e6}) {
    const Vec3i c = column_cells(static_cast<std::uint64_t>(n));
    EXPECT_NEAR(8.0 * c.x * c.y * c.z / n, 1, 0.15) << n;
    EXPECT_NEAR(static_cast<double>(c.x) / c.z, 2, 0.5) << n;
  }
}

}  // namespace
}  // namespace dreampm
