// Matter that comes in and goes out while the rest of it stays on a device: the same bits as on the
// host, and little that travels.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <limits>
#include <type_traits>

#include <solver/mixed_world.h>
#include "counting_device.h"
#include "dreampm/backend/gpu/flow_kernels.h"
#include "dreampm/backend/gpu/gpu.h"
#include "dreampm/backend/gpu/host_device.h"
#include "dreampm/backend/gpu/memory_need.h"
#include "dreampm/base/error.h"
#include "dreampm/math/rng.h"
#include "dreampm/solver/emit.h"
#include "dreampm/solver/solver.h"
#include "dreampm/state/take_out.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu_test {
namespace {
using namespace test;

std::unique_ptr<Backend<float>> flow_gpu(gpu::ThreadOrder order = gpu::ThreadOrder::rising) {
  return make_gpu_backend("gpu", gpu::make_host_device(order));
}

template <class Array>
void expect_same_bits(const Array& got, const Array& want, std::string_view what) {
  ASSERT_EQ(got.size(), want.size()) << what;
  using T = typename Array::value_type;
  if (want.empty()) return;
  for (std::size_t i = 0; i < want.size(); ++i)
    ASSERT_EQ(std::memcmp(&got[i], &want[i], sizeof(T)), 0) << what << " [" << i << "]";
}

/// Every list, column and node of two worlds.
void expect_same_matter(const World<float>& got, const World<float>& want) {
  ASSERT_EQ(got.sets.size(), want.sets.size());
  expect_same_bits(got.particle_blocks, want.particle_blocks, "particle_blocks");
  expect_same_bits(got.grid.blocks.all(), want.grid.blocks.all(), "grid.blocks");
  for (std::size_t s = 0; s < want.sets.size(); ++s) {
    const ParticleSet<float>&a = got.sets[s], &b = want.sets[s];
    expect_same_bits(a.block_start, b.block_start, "block_start");
    visit_fields(a, b, [&]<class F>(const F& field, const auto& its, const auto& other) {
      if constexpr (F::use.carried) {
        if constexpr (std::is_arithmetic_v<typename std::remove_cvref_t<decltype(its)>::value_type>) {
          expect_same_bits(its, other, field.name);
        } else {
          ASSERT_EQ(its.size(), other.size()) << field.name;
          for (std::size_t c = 0; c < its.size(); ++c) expect_same_bits(its[c], other[c], field.name);
        }
      }
    });
  }
  visit_nodes(got.grid, want.grid,
              [](const auto& field, const auto& its, const auto& other) { expect_same_bits(its, other, field.name); });
}

/// Worlds that touch all that an insertion and a sort do.
World<float> flow_world(std::string_view name, std::vector<std::vector<ParticleSeed>>& seeds) {
  World<float> w = mixed_world<float>("newtonian", seeds);
  if (name == "stages") {
    // Liquid alone, whose stress has fields of its own.
    w.sets.pop_back(), seeds.pop_back();
    w.sets[0].values.set("viscosity", 2000);
    w.settings.fixed_dt = 0;
    w.walls[2] = {.type = WallType::separate, .skin_friction = true};
    return w;
  }
  w.sets[1].transfer = {1, 0.97, 0};  // keeps velocities
  if (name == "periodic") {
    w.periodic = {true, false, true};
    w.set_domain({20, 20, 12});
    w.colliders.clear();
    for (const std::size_t side : {0, 1, 4, 5}) w.walls[side] = {WallType::open, 0};
  }
  add_set(w, "snow", soft("snow"), mixed_spacing);
  w.sets[2].name = "later";
  seeds.emplace_back();
  return w;
}

/// Anywhere in a part of the domain.
std::vector<ParticleSeed> anywhere(const World<float>& w, std::uint32_t first, std::uint32_t count, const Vec3d& from,
                                   const Vec3d& to) {
  const Box3d box = w.domain();
  std::vector<ParticleSeed> seeds;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const auto at = [&](std::uint64_t axis) { return uniform(axis, i); };
    const Vec3d part = from + (to - from) * Vec3d{at(0), at(1), at(2)};
    seeds.push_back({i, box.min + part * box.size(), {at(3), -at(4), at(5)}, Mat3d::diagonal(at(6), -at(7), 1)});
  }
  return seeds;
}

void expect_same_stats(const PassStats& got, const PassStats& want) {
  EXPECT_EQ(got.wave_speed, want.wave_speed);
  EXPECT_EQ(got.viscosity, want.viscosity);
  EXPECT_EQ(got.j_min, want.j_min);
  EXPECT_EQ(got.j_max, want.j_max);
}

// Into full blocks and new ones, into a set without matter, before the first step, after a sort and
// between sorts; more than go to a device at once.
TEST(GpuFlow, NewMatterComesInAsOnTheHost) {
  for (const char* name : {"mixed", "stages", "periodic"})
    for (const int steps : {0, 3, 25}) {
      SCOPED_TRACE(std::string(name) + " after " + std::to_string(steps));
      std::vector<std::vector<ParticleSeed>> seeds;
      World<float> w = flow_world(name, seeds);
      const auto gpu = flow_gpu(gpu::ThreadOrder::scattered);
      const auto host = make_reference_backend<float>();
      begin(w, *gpu, seeds);
      advance(w, *gpu, steps);
      EXPECT_EQ(!w.grid.stress[0].empty(), name == std::string("stages") && steps > 0);
      Motion<float> none;
      gpu->download(w, none, MatterFields::all);
      World<float> want = w;
      host->attach(want);
      std::uint32_t next = 10'000;
      for (const std::size_t s : {std::size_t{0}, w.sets.size() - 1, std::size_t{0}})
        for (const auto& [count, from, to] :
             {std::tuple{300u, Vec3d{0.1, 0.1, 0.1}, Vec3d{0.5, 0.7, 0.9}}, std::tuple{20u, Vec3d{}, Vec3d{1, 1, 1}},
              std::tuple{0u, Vec3d{}, Vec3d{1, 1, 1}}, std::tuple{1u, Vec3d{0.9, 0.9, 0.9}, Vec3d{1, 1, 1}}}) {
          const std::vector<ParticleSeed> more = anywhere(w, next, count, from, to);
          next += count;
          expect_same_stats(gpu->insert_particles(w, s, more), host->insert_particles(want, s, more));
          EXPECT_EQ(w.particles(), want.particles());
        }
      gpu->download(w, none, MatterFields::all);
      expect_same_matter(w, want);
      if (HasFailure()) return;
    }
}

TEST(GpuFlow, MoreMatterThanGoesAtOnce) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = flow_world("mixed", seeds);
  const auto gpu = flow_gpu(), host = make_reference_backend<float>();
  begin(w, *gpu, seeds);
  Motion<float> none;
  gpu->download(w, none, MatterFields::all);
  World<float> want = w;
  host->attach(want);
  const auto many = static_cast<std::uint32_t>(gpu::seeds_at_once + 1000);
  const auto more = anywhere(w, 10'000, many, {0.2, 0.2, 0.2}, {0.7, 0.9, 0.9});
  gpu->insert_particles(w, 1, more), host->insert_particles(want, 1, more);
  gpu->download(w, none, MatterFields::all);
  expect_same_matter(w, want);
}

std::shared_ptr<const Region> region_of(const Box3d& box) {
  Shape shape;
  shape.form = BoxShape{box.size()}, shape.center = box.center();
  return make_region(shape, 0.01, {});
}

// In boxes that lie in each other, in one that moves, at a collider; nodes at home and away.
TEST(GpuFlow, SinksTakeAsOnTheHost) {
  auto path = std::make_shared<MotionPath>();
  path->velocity = {1, 0, 0}, path->spin = {0, 0.3, 0};
  for (const char* name : {"mixed", "stages", "periodic"})
    for (const auto order : {gpu::ThreadOrder::rising, gpu::ThreadOrder::scattered}) {
      SCOPED_TRACE(name);
      std::vector<std::vector<ParticleSeed>> seeds;
      World<float> w = flow_world(name, seeds);
      const auto gpu = flow_gpu(order);
      begin(w, *gpu, seeds);
      advance(w, *gpu, 20);
      EXPECT_GT(w.drift, 0);
      w.sinks = {{"one", region_of({{0.05, 0.1, 0.02}, {0.12, 0.16, 0.1}})},
                 {"two", region_of({{0.09, 0.1, 0.02}, {0.24, 0.15, 0.14}})},
                 {"nothing", region_of({{0.36, 0.36, 0.02}, {0.4, 0.4, 0.1}})}};
      w.sinks.push_back({"goes", region_of({{0.1, 0.15, 0}, {0.15, 0.2, 0.2}}), {}, 0, {}, {}, path});
      if (!w.colliders.empty()) w.sinks.push_back({"ball", {}, 0});
      gpu->grid_update(w, w.dt_next);
      Motion<float> none;
      gpu->download(w, none, MatterFields::all);
      World<float> want = w;
      Regroup<float> regroup;
      GridFields<float> spare;
      regroup(want, spare);
      gpu->sort(w);
      gpu->download(w, none, MatterFields::all);
      expect_same_matter(w, want);
      EXPECT_EQ(w.left, want.left);
      EXPECT_EQ(w.drift, 0);
      ASSERT_EQ(w.sinks.size(), want.sinks.size());
      std::uint64_t taken = 0;
      for (std::size_t i = 0; i < w.sinks.size(); ++i) {
        EXPECT_EQ(w.sinks[i].taken, want.sinks[i].taken) << w.sinks[i].name;
        EXPECT_EQ(w.sinks[i].momentum, want.sinks[i].momentum) << w.sinks[i].name;
        EXPECT_EQ(w.sinks[i].angular, want.sinks[i].angular) << w.sinks[i].name;
        taken += w.sinks[i].taken;
      }
      EXPECT_GT(w.sinks[0].taken, 20u);
      EXPECT_GT(w.sinks[1].taken, 20u);
      EXPECT_EQ(w.sinks[2].taken, 0u);
      EXPECT_EQ(taken, w.left);
      if (HasFailure()) return;
    }
}

// A sink over all of the space, then matter where there is none at all.
TEST(GpuFlow, ADrainMayTakeEverythingAndATapBeginAnew) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = flow_world("mixed", seeds);
  const auto gpu = flow_gpu();
  begin(w, *gpu, seeds);
  advance(w, *gpu, 10);
  const std::size_t all = w.particles();
  Sink sink{"all", region_of({{-1, -1, -1}, {2, 2, 2}})};
  w.sinks = {sink};
  gpu->grid_update(w, w.dt_next);
  gpu->sort(w);
  EXPECT_EQ(w.particles(), 0u);
  EXPECT_EQ(w.sinks[0].taken, all);
  EXPECT_EQ(w.left, all);
  EXPECT_TRUE(w.particle_blocks.empty());
  w.sinks.clear();
  Motion<float> none;
  gpu->download(w, none, MatterFields::all);
  World<float> want = w;
  const auto host = make_reference_backend<float>(), fresh = flow_gpu();
  host->attach(want);
  const auto more = anywhere(w, 10'000, 400, {0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
  gpu->insert_particles(w, 2, more), host->insert_particles(want, 2, more);
  gpu->download(w, none, MatterFields::all);
  expect_same_matter(w, want);
  // It goes on as a world does that never had other matter.
  want.scatter_bounds = w.scatter_bounds;
  fresh->attach(want);
  advance(w, *gpu, 20), advance(want, *fresh, 20);
  gpu->download(w, none, MatterFields::all), fresh->download(want, none, MatterFields::all);
  expect_same_matter(w, want);
  EXPECT_EQ(w.particles(), 400u);
}

/// A pool under a tap, with a drain in a corner of its floor.
World<float> pool(std::vector<std::vector<ParticleSeed>>& seeds) {
  World<float> w = empty_world<float>(0.02, {30, 20, 30});
  w.gravity = {0, -9.81, 0};
  w.settings.fps = 50;
  add_set(w, "newtonian", soft("newtonian"), mixed_spacing);
  seeds = {lattice({{0, 0, 0}, {0.6, 0.16, 0.6}}, mixed_spacing, still())};
  w.next_id = static_cast<std::uint32_t>(seeds[0].size());
  Emitter tap;
  tap.name = "tap", tap.shape = region_of({{0.4, 0.3, 0.4}, {0.48, 0.32, 0.48}});
  tap.speed = {{0, 1.0}}, tap.pool = 1'000'000;
  w.emitters.push_back(tap);
  w.sinks.push_back({"drain", region_of({{0, 0, 0}, {0.06, 0.03, 0.06}})});
  return w;
}

// An insertion brings the nodes of the blocks that seeds reach, the places of matter in the tap and
// tables of numbers of blocks; a sort the places and nodes of blocks at the drain.
TEST(GpuFlow, OnlyTheBlocksOfEmittersAndSinksTravel) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = pool(seeds);
  auto counting = std::make_unique<Counting>(gpu::make_host_device());
  Counting& device = *counting;
  const auto gpu = make_gpu_backend("gpu", std::move(counting));
  const auto solver = make_solver<float>(w, *gpu);
  Motion<float> motion;
  begin(w, *gpu, seeds);
  const std::size_t start = w.particles();
  const std::size_t row = (4 + w.sets[0].state.size()) * sizeof(float);  // of a particle: id, place, state
  std::size_t came = 0, most_in = 0, most_out = 0;
  int insertions = 0, sorts = 0;
  for (int k = 0; k < 50; ++k) {
    device.clear();
    const Entered entered = emit(w, *gpu, *solver, motion);
    came += entered.particles;
    if (entered.particles > 0) ++insertions, most_in = std::max(most_in, device.uploaded + device.downloaded);
    device.clear();
    const double drift = w.drift;
    step<float>(w, *gpu, nullptr);
    if (w.drift < drift) ++sorts, most_out = std::max(most_out, device.uploaded + device.downloaded);
    EXPECT_EQ(w.particles(), start + came - w.sinks[0].taken);
  }
  const std::size_t matter = w.particles() * row;
  std::printf("%zu particles, %.2f MB: %.3f MB in the largest of %d insertions, %.3f MB in that of %d sorts\n",
              w.particles(), static_cast<double>(matter) / 1e6, static_cast<double>(most_in) / 1e6, insertions,
              static_cast<double>(most_out) / 1e6, sorts);
  EXPECT_GE(insertions, 3);
  EXPECT_GE(sorts, 5);
  EXPECT_GT(came, 100u);
  EXPECT_GT(w.sinks[0].taken, 50u);
  EXPECT_EQ(w.left, w.sinks[0].taken);
  EXPECT_EQ(w.emitters[0].born, came);
  // Most of either are tables of numbers of blocks, as in a sort without a drain.
  EXPECT_LE(most_in, matter / 8);
  EXPECT_LE(most_out, matter / 4);
  // All that is there is what came and did not go, each of them once.
  gpu->download(w, motion, MatterFields::all);
  std::vector<std::uint32_t> ids(w.sets[0].id.begin(), w.sets[0].id.end());
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
  EXPECT_EQ(ids.size(), start + came - w.sinks[0].taken);
  const double mass = step<float>(w, *gpu, nullptr).grid.mass;
  const auto sorted = [&] {
    device.clear();
    gpu->sort(w);
    return device.uploaded + device.downloaded;
  };
  std::size_t near = 0;
  for (const std::uint32_t b : blocks_at_sinks(w, false))
    near += w.sets[0].block_start[b + 1] - w.sets[0].block_start[b];
  const std::size_t draining = sorted();
  w.sinks.clear();
  const std::size_t plain = sorted();
  std::printf("%.3f MB of a sort are the drain's, near which %zu particles are\n",
              static_cast<double>(draining - plain) / 1e6, near);
  EXPECT_GT(draining, plain + 3 * sizeof(float) * near);
  EXPECT_LE(draining, plain + 6 * sizeof(float) * near);
  EXPECT_NEAR(mass, w.sets[0].mass * static_cast<double>(ids.size()), 1e-5 * mass);
}

// What does not fit is refused before anything is changed; the run goes on as if nobody had asked.
TEST(GpuFlow, MatterThatDoesNotFitLeavesTheRunWhole) {
  for (const int steps : {0, 25}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> w = flow_world("mixed", seeds);
    auto counting = std::make_unique<Counting>(gpu::make_host_device());
    Counting& device = *counting;
    const auto gpu = make_gpu_backend("gpu", std::move(counting)), plain = flow_gpu();
    begin(w, *gpu, seeds);
    advance(w, *gpu, steps);
    Motion<float> none;
    gpu->download(w, none, MatterFields::all);
    World<float> copy = w;
    plain->attach(copy);
    const std::size_t set = w.sets.size() - 1;
    device.limit = gpu::bytes_needed(w) * 3 / 2;
    try {
      gpu->insert_particles(w, set, anywhere(w, 10'000, 60'000, {}, {1, 1, 1}));
      FAIL() << "there is no room";
    } catch (const RunError& e) {
      EXPECT_NE(std::string(e.what()).find("need about"), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("MB are free"), std::string::npos) << e.what();
    }
    ParticleSeed nowhere{1, {0.1, std::numeric_limits<double>::quiet_NaN(), 0}, {}, {}};
    EXPECT_THROW(gpu->insert_particles(w, 0, {&nowhere, 1}), RunError);
    EXPECT_EQ(state_hash(w), state_hash(copy));
    const auto few = anywhere(w, 10'000, 100, {0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
    gpu->insert_particles(w, set, few), plain->insert_particles(copy, set, few);
    advance(w, *gpu, 20), advance(copy, *plain, 20);
    gpu->download(w, none, MatterFields::all), plain->download(copy, none, MatterFields::all);
    expect_same_matter(w, copy);
    EXPECT_EQ(state_hash(w), state_hash(copy));
  }
}

}  // namespace
}  // namespace dreampm::gpu_test
