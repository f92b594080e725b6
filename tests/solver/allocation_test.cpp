// A step takes no memory, but for sorts and the step after one: everything it needs lies ready from
// the steps before. Counted by an operator new and an mmap of this program alone.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include "dreampm/base/large_vector.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"
#include "dreampm/solver/projection/projection.h"
#include "worlds.h"

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  // aligned_alloc wants whole multiples.
  void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!p) throw std::bad_alloc();
  return p;
}
// Not inlined, or g++ finds that free() takes what operator new gave.
__attribute__((noinline)) void take_back(void* p) { std::free(p); }
}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t a) { return counted(size, static_cast<std::size_t>(a)); }
/// The allocator of large pages (base/large_vector.h).
extern "C" void* mmap(void* at, std::size_t size, int protection, int flags, int file, off_t from) noexcept {
  ++allocations;
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, protection, flags, file, from));
}
void operator delete(void* p) noexcept { take_back(p); }
void operator delete(void* p, std::size_t) noexcept { take_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { take_back(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { take_back(p); }

namespace dreampm {
namespace {
using namespace test;

TEST(Allocation, TheCounterSeesThreads) {
  const long before = allocations;
  parallel_for(2, 1, [](std::size_t) { delete new int(1); });
  EXPECT_GE(allocations - before, 2);
}

TEST(Allocation, TheCounterSeesLargePages) {
  const long before = allocations;
  const LargeVector<float> large(large_page);
  EXPECT_GE(allocations - before, 1);
}

/// A block of `name` beside walls of both kinds that mirror, thrown; where `two` with an elastic
/// one on top, in fields of their own.
World<float> thrown(std::string_view name, bool two, std::vector<std::vector<ParticleSeed>>& seeds) {
  const double dx = 0.02;
  World<float> w = empty_world<float>(dx, {20, 20, 10});
  w.walls[0] = {WallType::stick, 0};
  w.walls[1] = {WallType::slip, 0};
  w.gravity = {0, -9.81, 0};
  w.settings.fps = 50;
  const Field field = [](const Vec3d& p) { return Vec3d{1 - 3 * p.y, -1, -0.5}; };
  const auto add = [&](std::string_view material, const Box3d& box, std::uint32_t first) {
    Values v = values_of(material, {});
    if (find_material(material)->find("bulk_modulus") && !v.has("bulk_modulus")) v.set("bulk_modulus", 1e5);
    add_set<float>(w, material, v, dx / 2);
    seeds.push_back(lattice(box, dx / 2, field, first));
  };
  add(name, {{0, 0, 0}, {0.1, 0.2, 0.2}}, 0);
  if (two) add("elastic", {{0.02, 0.22, 0.02}, {0.1, 0.3, 0.18}}, static_cast<std::uint32_t>(seeds[0].size()));
  return w;
}

struct Found {
  long allocations = 0;
  int steps = 0, sorts = 0, stages = 0;
  double pushed = 0;  ///< by colliders [N s]
};

/// Steps after the first sort that are neither sorts nor follow one: there the grid has new blocks.
Found steps_between_sorts(World<float> w, const std::vector<std::vector<ParticleSeed>>& seeds) {
  const auto cpu = make_cpu_backend();
  begin(w, *cpu, seeds);
  Found found;
  bool after_sort = false;
  for (int i = 0; i < 240; ++i) {
    const double drift = w.drift;
    const long before = allocations;
    const StepSums report = step<float>(w, *cpu, nullptr);
    const long now = allocations - before;
    found.stages += report.stages;
    for (const ImpulseSum& p : report.grid.colliders) found.pushed += length(p.impulse);
    const bool sorted = w.drift < drift;
    if (!sorted && !after_sort && found.sorts > 0) found.allocations += now, ++found.steps;
    found.sorts += sorted;
    after_sort = sorted;
  }
  return found;
}

TEST(Allocation, AStepTakesNoMemory) {
  const ThreadLimit limit(2);
  for (const MaterialInfo& m : material_infos())
    for (const bool two : {false, true}) {
      std::vector<std::vector<ParticleSeed>> seeds;
      const World<float> w = thrown(m.name, two, seeds);
      const Found found = steps_between_sorts(w, seeds);
      EXPECT_EQ(found.allocations, 0) << m.name << (two ? " and a solid" : "");
      EXPECT_GE(found.sorts, 2) << m.name;
      EXPECT_GE(found.steps, 50) << m.name;
    }
}

TEST(Allocation, NorDoesAStepAmongCollidersAndForceFields) {
  const ThreadLimit limit(2);
  for (const bool thick : {false, true}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> w = thrown("newtonian", true, seeds);
    if (thick) w.sets[0].values.set("viscosity", 1e3);
    for (const WallType type : {WallType::separate, WallType::stick}) {
      Shape ball;
      ball.form = SphereShape{0.05};
      ball.center = Vec3d{type == WallType::stick ? 0.13 : 0.03, -0.01, 0.1};
      w.colliders.push_back({"ball", make_region(ball, w.dx, {}), type, 0.3});
    }
    w.fields.push_back({"gust", Wind{{3, 0, 0}, 0.5}, std::nullopt});
    w.fields.push_back({"pull", Attractor{{0.2, 0.1, 0.1}, 1, 0.05}, std::nullopt});
    w.settings.damping = 0.1;
    const Found found = steps_between_sorts(w, seeds);
    EXPECT_EQ(found.allocations, 0);
    EXPECT_GE(found.sorts, 2);
    EXPECT_GE(found.steps, 50);
    EXPECT_EQ(found.stages > 0, thick);
    EXPECT_GT(found.pushed, 0);
  }
}

/// Moves all matter together by 0.9 cells one way or another, and every particle by up to as much
/// again on its own.
void stir(World<float>& w, int round) {
  for (auto& set : w.sets)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t p = 0; p < set.size(); ++p) {
        const double own = uniform(3 * static_cast<std::uint64_t>(round) + a, set.id[p]);
        set.u[a][p] += static_cast<float>(round / 5 % 2 ? -0.9 * own : 0.9 * own);
      }
}

void expect_sorts_take_no_memory(Backend<float>& backend) {
  const ThreadLimit limit(2);
  for (const bool periodic : {false, true}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> w = thrown("snow", true, seeds);
    w.sets[0].transfer = {1, 0.97, 0};
    w.high = {20, 20, 12};
    w.periodic = {false, false, periodic};
    if (periodic) w.walls[4] = w.walls[5] = {WallType::open, 0};
    begin(w, backend, seeds);
    const World<float> start = w;
    long first = 0, taken = 0, fewest = 1 << 30, most = 0;
    // The same way again and again: after the first times it needs no more than it had.
    for (int lap = 0; lap < 5; ++lap) {
      w = start;
      taken = 0;
      for (int round = 0; round < 20; ++round) {
        stir(w, round);
        const long before = allocations;
        backend.sort(w);
        taken += allocations - before;
        fewest = std::min(fewest, static_cast<long>(w.grid.blocks.size()));
        most = std::max(most, static_cast<long>(w.grid.blocks.size()));
      }
      if (lap == 0) first = taken;
    }
    EXPECT_GT(first, 0);
    EXPECT_EQ(taken, 0) << periodic;
    EXPECT_GT(most, fewest) << "the grid has to change in this test";
  }
}

TEST(Allocation, ASortTakesNoMemory) {
  expect_sorts_take_no_memory(*make_reference_backend<float>());
  expect_sorts_take_no_memory(*make_cpu_backend());
}

TEST(Allocation, NorDoesAStepOfTheProjection) {
  const ThreadLimit limit(2);
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = thrown("newtonian", false, seeds);
  w.settings.solver = SolverKind::projection, w.settings.cfl = 2;
  w.sets[0].carries_motion = true;
  Projection<float> solver;
  Motion<float> motion;
  solver.begin(w, seeds);
  const World<float> start = w;
  // The same way again and again: after the first times it needs no more than it had.
  long first = 0, taken = 0;
  for (int lap = 0; lap < 4; ++lap) {
    w = start;
    taken = 0;
    for (int i = 0; i < 30; ++i) {
      const long before = allocations;
      solver.step(w, motion, 1e30, nullptr);
      taken += allocations - before;
    }
    if (lap == 0) first = taken;
  }
  EXPECT_GT(first, 0);
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace dreampm
