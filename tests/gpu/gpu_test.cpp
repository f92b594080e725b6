// The kernels of a device on the host, thread after thread, against the reference; and what must
// not change a bit: the order of threads and blocks, the number of the host's own threads, a copy.
#include "dreampm/backend/gpu/gpu.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>
#include <utility>

#include <solver/mixed_world.h>
#include "counting_device.h"
#include "dreampm/backend/gpu/host_device.h"
#include "dreampm/backend/gpu/memory_need.h"
#include "dreampm/base/parallel.h"

namespace dreampm::gpu_test {
namespace {
using namespace test;
using gpu::ThreadOrder;

std::unique_ptr<Backend<float>> host_gpu(ThreadOrder order = ThreadOrder::rising) {
  return make_gpu_backend("gpu", gpu::make_host_device(order));
}

template <class R>
World<R> after(World<R> world, const std::vector<std::vector<ParticleSeed>>& seeds, Backend<R>& backend, int steps) {
  begin(world, backend, seeds);
  advance(world, backend, steps);
  Motion<R> motion;
  backend.download(world, motion, MatterFields::all);
  return world;
}

/// Root of the mean square of the distances of particles [cells].
double distance(const World<float>& world, const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += length2(a[i] - b[i]) / (world.dx * world.dx);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

// Two bodies thrown at each other, at walls and over a ball, against the reference in double. Nodes
// that hold a millionth of a particle are rounded, and decide when matter meets the ball: from then
// on places differ by what such a node moves.
TEST(Gpu, FollowsTheReferenceForEveryMaterial) {
  for (const MaterialInfo& m : material_infos()) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> got = mixed_world<float>(m.name, seeds);
    World<double> want = mixed_world<double>(m.name, seeds);
    const auto gpu = host_gpu();
    const auto reference = make_reference_backend<double>();
    begin(got, *gpu, seeds), begin(want, *reference, seeds);
    Motion<float> motion;
    const auto apart = [&](int steps) {
      advance(got, *gpu, steps), advance(want, *reference, steps);
      gpu->download(got, motion, MatterFields::particles);
      return distance(got, positions_by_id(got), positions_by_id(want));
    };
    const double before = apart(60), after = apart(140);
    std::printf("%s: %.1e cells rms before they meet the ball, %.1e in the end\n", std::string(m.name).c_str(), before,
                after);
    EXPECT_LE(before, 2e-5) << m.name;
    EXPECT_LE(after, 5e-4) << m.name;
    double moved = 0;
    const auto places = positions_by_id(want);
    for (const auto& set : seeds)
      for (const ParticleSeed& n : set) moved = std::max(moved, length(places[n.id] - n.position) / want.dx);
    EXPECT_GT(moved, 1) << m.name;
  }
}

/// The mixed world; or its liquid over a ball that moves, along a wall with a boundary layer, under
/// force fields, its viscosity in stages: "staged" with the rest, or "alone".
World<float> world_of(std::string_view name, std::vector<std::vector<ParticleSeed>>& seeds) {
  if (name != "alone" && name != "staged") return mixed_world<float>(name, seeds);
  World<float> w = mixed_world<float>("newtonian", seeds);
  if (name == "alone") w.sets.pop_back(), seeds.pop_back();
  w.sets[0].values.set("viscosity", 2000);
  w.settings.fixed_dt = 0, w.settings.damping = 1;
  w.walls[2] = {.type = WallType::separate, .skin_friction = true};
  w.colliders[0].twist.velocity = {-0.3, 0.1, 0};
  w.colliders[0].type = WallType::stick;
  w.fields.push_back({"pull", Attractor{.point = {0.1, 0.1, 0.1}, .strength = 0.05, .radius = 0.05}, {}});
  w.fields.push_back({"hand", Brush{.point = {0.12, 0.1, 0.1}, .radius = 0.06, .velocity = {0, 1, 0}}, {}});
  return w;
}

/// The mixed world, whose ball is free: it moves with what it meets, and does not turn about z.
template <class R>
World<R> with_a_body(std::vector<std::vector<ParticleSeed>>& seeds) {
  World<R> w = mixed_world<R>("newtonian", seeds);
  const Vec3d center{0.2, 0.06, 0.1};
  Collider& ball = w.colliders[0];
  ball.rigid = true, ball.twist.center = center;
  RigidBody body;
  body.mass = 0.3, body.center = center, body.inertia = Mat3d::identity() * 3e-4, body.locked[5] = true;
  w.rigid.push_back(body);
  CollisionShape& shape = w.collision.emplace_back();
  shape.shape.form = SphereShape{0.05}, shape.shape.center = center;
  return w;
}

// Its velocity and spin are unknowns of contact.
TEST(Gpu, ABodyMovesAsInTheReference) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> got = with_a_body<float>(seeds);
  World<double> want = with_a_body<double>(seeds);
  const auto gpu = host_gpu();
  const auto reference = make_reference_backend<double>();
  begin(got, *gpu, seeds), begin(want, *reference, seeds);
  advance(got, *gpu, 150), advance(want, *reference, 150);
  const Twist &a = got.colliders[0].twist, &b = want.colliders[0].twist;
  std::printf("velocity %.6f %.6f %.6f m/s, off by %.1e; spin %.5f %.5f %.5f, off by %.1e\n", b.velocity.x,
              b.velocity.y, b.velocity.z, length(a.velocity - b.velocity), b.spin.x, b.spin.y, b.spin.z,
              length(a.spin - b.spin));
  EXPECT_GT(length(b.velocity - Vec3d{0, -9.81 * 150 * 2e-4, 0}), 0.05);
  EXPECT_LE(length(a.velocity - b.velocity), 2e-3 * length(b.velocity));
  EXPECT_LE(length(a.spin - b.spin), 0.02 * length(b.spin) + 1e-6);
  EXPECT_EQ(a.spin.z, 0);
}

// A race would show where threads come in another order.
TEST(Gpu, TheOrderOfThreadsDoesNotChangeABit) {
  for (const char* name : {"newtonian", "viscoplastic", "snow", "alone", "staged", "body"}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    const World<float> world = std::string_view(name) == "body" ? with_a_body<float>(seeds) : world_of(name, seeds);
    std::vector<std::uint64_t> hashes;
    for (const auto& [order, threads] : {std::pair{ThreadOrder::rising, 1}, std::pair{ThreadOrder::falling, 3},
                                         std::pair{ThreadOrder::scattered, 2}}) {
      const ThreadLimit limit(threads);
      hashes.push_back(state_hash(after<float>(world, seeds, *host_gpu(order), 80)));
    }
    for (const auto h : hashes) EXPECT_EQ(h, hashes[0]) << name;
  }
}

// Of the plain kernels, of those with every term, and of stages of viscosity, frozen: what changes
// them changes what a device computes, too.
TEST(Gpu, BitsAreFrozen) {
  enum { plain = 1, alone = 2 };
  const auto hash = [](const char* name, int kind, double viscosity = 0) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> world = mixed_world<float>(name, seeds);
    if (kind == plain) world.colliders.clear();
    if (kind == plain || kind == alone) world.sets.pop_back(), seeds.pop_back();
    if (viscosity > 0) world.sets[0].values.set("viscosity", viscosity), world.settings.fixed_dt = 0;
    return state_hash(after<float>(world, seeds, *host_gpu(), kind == alone ? 140 : 60));
  };
  EXPECT_EQ(hash("newtonian", plain), 17765759702501597210u);
  EXPECT_EQ(hash("newtonian", 0), 14598355296064186103u);
  EXPECT_EQ(hash("newtonian", plain, 2000), 12583454041320183817u);
  EXPECT_EQ(hash("newtonian", alone), 8475831038081412336u);
  EXPECT_EQ(hash("snow", plain), 9726423966129269251u);
  EXPECT_EQ(hash("sand", 0), 11932556601037948927u);
}

TEST(Gpu, LookingDoesNotChangeABit) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = mixed_world<float>("newtonian", seeds);
  // By the plain kernels, which look too.
  w.colliders.clear(), w.sets.pop_back(), seeds.pop_back();
  World<float> v = w;
  const auto a = host_gpu(), b = host_gpu();
  begin(w, *a, seeds), begin(v, *b, seeds);
  Motion<float> motion, none;
  advance(w, *a, 50), advance(v, *b, 50, &motion);
  a->download(w, none, MatterFields::all), b->download(v, motion, MatterFields::all);
  EXPECT_EQ(motion.sets.at(0).velocity.size(), v.sets[0].size());
  EXPECT_EQ(state_hash(w), state_hash(v));
}

// What a particle gives is counted whole before it is spread: of one alone in its block, too.
TEST(Gpu, AParticleAloneKeepsItsMass) {
  for (const double spacing : {0.005, 0.01, 0.013, 0.02}) {
    World<float> w = empty_world<float>(2 * spacing, {40, 40, 40});
    w.settings.fixed_dt = 1e-4, w.settings.fps = 50;
    add_set(w, "newtonian", soft("newtonian"), spacing);
    const std::vector<std::vector<ParticleSeed>> seeds{{{0, Vec3d{20.3, 20.1, 19.9} * w.dx, {1, -0.5, 0.25}, {}}}};
    const auto gpu = host_gpu();
    begin(w, *gpu, seeds);
    GridStats last;
    for (int k = 0; k < 20; ++k) last = step<float>(w, *gpu, nullptr).grid;
    EXPECT_NEAR(last.mass, w.sets[0].mass, 1e-6 * w.sets[0].mass) << spacing;
    const ImpulseSum now = gpu->grid_momentum(w, NodesHold::momenta);
    EXPECT_LE(length(now.impulse * (1 / w.sets[0].mass) - Vec3d{1, -0.5, 0.25}), 1e-5) << spacing;
  }
}

/// A mixed world after some steps, with all of its matter.
World<float> mixed_after(std::string_view name, Backend<float>& backend, int steps) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = mixed_world<float>(name, seeds);
  begin(w, backend, seeds);
  advance(w, backend, steps);
  Motion<float> none;
  backend.download(w, none, MatterFields::all);
  return w;
}

// A pass that gives more than was assumed is done again, with the units of one that assumed it.
// A pass that finds more than was assumed is done again: of a speed with the units as when it was
// known, of a mass, whose counts ran over, with those of all that a block holds.
TEST(Gpu, WhatWasAssumedTooSmallIsFound) {
  const auto gpu = host_gpu();
  const World<float> w = mixed_after("viscoplastic", *gpu, 3);
  const auto next = [&](const std::array<double, 4>& bounds) {
    World<float> copy = w;
    copy.scatter_bounds = bounds;
    const auto fresh = host_gpu();
    fresh->attach(copy);
    advance(copy, *fresh, 1);
    Motion<float> none;
    fresh->download(copy, none, MatterFields::all);
    return copy;
  };
  const std::array<double, 4> found = next(w.scatter_bounds).scatter_bounds;
  const World<float> want = next(found);
  std::array<double, 4> slow = found, light = found;
  slow[0] *= 1e-3, light[1] *= 1e-3;
  EXPECT_EQ(state_hash(next(slow)), state_hash(want));
  World<float> got = next(light);
  EXPECT_NEAR(got.scatter_bounds[1], want.scatter_bounds[1], 1e-5 * want.scatter_bounds[1]);
  double most = 0;
  for (std::size_t i = 0; i < want.grid.nodes.size(); ++i) {
    const Node<float>&a = got.grid.nodes[i], &b = want.grid.nodes[i];
    most = std::max(most, static_cast<double>(b.m));
    EXPECT_NEAR(a.m, b.m, 1e-6 * found[1]);
    EXPECT_NEAR(a.y, b.y, 1e-6 * found[0] * found[1]);
  }
  EXPECT_NEAR(most, found[1], 0.5 * found[1]);
}

// Matter in a box stays on the device: a step brings its sums home, twice, and a sort the numbers
// of blocks, less than two columns of the particles.
TEST(Gpu, OnlySumsTravelInAStep) {
  const std::vector<const char*> matter[] = {{"newtonian"}, {"snow"}, {"newtonian", "snow"}};
  for (const auto& materials : matter) {
    SCOPED_TRACE(materials.front() + std::to_string(materials.size()));
    World<float> w = empty_world<float>(0.02, {24, 24, 24});
    std::vector<std::vector<ParticleSeed>> seeds;
    for (const char* material : materials) {
      add_set(w, material, soft(material), mixed_spacing);
      const double from = 0.02 * static_cast<double>(seeds.size());
      seeds.push_back(
          lattice({{from, 0.1, 0.1}, {0.32, 0.42, 0.34}}, mixed_spacing, [](const Vec3d&) { return Vec3d{2, -1, 0}; }));
    }
    auto counting = std::make_unique<Counting>(gpu::make_host_device());
    Counting& device = *counting;
    const auto gpu = make_gpu_backend("gpu", std::move(counting));
    begin(w, *gpu, seeds);
    advance(w, *gpu, 3);
    int sorts = 0;
    for (int k = 0; k < 40; ++k) {
      const double drift = w.drift;
      device.clear();
      advance(w, *gpu, 1);
      if (w.drift < drift) {
        ++sorts;
        EXPECT_LE(device.uploaded + device.downloaded, (materials.size() * w.particles() * sizeof(float)));
        continue;
      }
      EXPECT_EQ(device.uploaded, 0u);
      EXPECT_LE(device.downloaded, 4096u);
      EXPECT_EQ(device.downloads, 2);
      EXPECT_EQ(device.allocations, 0);
      EXPECT_LE(device.launches, materials.size() == 1 ? 20 : 26);
    }
    EXPECT_GE(sorts, 1);
  }
}

// Nor does anything go there for colliders at rest; for one that moves, its points and what lies
// around it.
TEST(Gpu, OnlyWhatCollidersChangeTravels) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = mixed_world<float>("newtonian", seeds);
  const auto run = [&](const char* name, std::size_t most) {
    World<float> copy = w;
    auto counting = std::make_unique<Counting>(gpu::make_host_device());
    Counting& device = *counting;
    const auto gpu = make_gpu_backend("gpu", std::move(counting));
    begin(copy, *gpu, seeds);
    advance(copy, *gpu, 3);
    std::size_t up = 0;
    for (int k = 0; k < 80; ++k) {
      const double drift = copy.drift;
      device.clear();
      advance(copy, *gpu, 1);
      if (copy.drift < drift) continue;
      up = std::max(up, device.uploaded);
      EXPECT_LE(device.downloads, 3) << name;  // a pass may be done again
    }
    std::printf("%s: %zu bytes go up in a step, of %zu of nodes\n", name, up,
                copy.grid.nodes.size() * sizeof(Node<float>));
    EXPECT_LE(up, most) << name;
  };
  run("at rest", 0);
  w.colliders[0].twist.velocity = {-0.3, 0.1, 0};
  run("moving", 160 << 10);
}

// Velocities of particles stay there until somebody reads them.
TEST(Gpu, MotionTravelsWhereItIsRead) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = mixed_world<float>("snow", seeds);
  auto counting = std::make_unique<Counting>(gpu::make_host_device());
  Counting& device = *counting;
  const auto gpu = make_gpu_backend("gpu", std::move(counting));
  begin(w, *gpu, seeds);
  Motion<float> motion;
  for (int k = 0; k < 3; ++k) step<float>(w, *gpu, &motion, -std::numeric_limits<double>::infinity());
  device.clear();
  const auto arrays = gpu->device_particles(w, motion, 1, {true, true, true});
  ASSERT_TRUE(arrays);
  EXPECT_EQ(device.downloaded, 0u);
  EXPECT_LE(device.uploaded, w.particle_blocks.size() * sizeof(Vec3i));
  EXPECT_EQ(device.launches, 1);
  gpu->download(w, motion, MatterFields::motion);
  EXPECT_GE(device.downloaded, w.particles() * (3 + 9 + 2) * sizeof(float));
  std::vector<Vec3f> velocity(arrays->size());
  arrays->velocity->download(velocity.data());
  EXPECT_EQ(velocity, motion.sets.at(1).velocity);
  // Once is enough.
  device.clear();
  gpu->download(w, motion, MatterFields::motion);
  EXPECT_EQ(device.downloaded, 0u);
  // What an edit changed is what readers see.
  motion.sets[1].velocity[0] = {1, 2, 3};
  gpu->upload(w, motion, MatterFields::motion);
  gpu->device_particles(w, motion, 1, {false, true, false})->velocity->download(velocity.data());
  EXPECT_EQ(velocity, motion.sets[1].velocity);
}

// The step says where a particle's state is no number.
TEST(Gpu, StressThatIsNoNumberIsFound) {
  const auto gpu = host_gpu();
  World<float> w = mixed_after("snow", *gpu, 2);
  w.sets[0].state[0][5] = std::numeric_limits<float>::infinity();
  gpu->upload(w, {}, MatterFields::particles);
  EXPECT_THROW(advance(w, *gpu, 2), NumericalFailure);
}

TEST(Gpu, ACopyWithAFreshBackendGoesTheSameWay) {
  for (const char* name : {"viscoplastic", "alone", "staged"}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    const auto first = host_gpu(), second = host_gpu();
    World<float> w = after<float>(world_of(name, seeds), seeds, *first, 70);
    EXPECT_GT(w.drift, 0);  // between sorts: the copy must not need one
    EXPECT_EQ(w.viscous_stages > 0, std::string_view(name) != "viscoplastic");
    World<float> copy = w;
    second->attach(copy);
    advance(w, *first, 40), advance(copy, *second, 40);
    Motion<float> none;
    first->download(w, none, MatterFields::all), second->download(copy, none, MatterFields::all);
    EXPECT_EQ(state_hash(copy), state_hash(w)) << name;
  }
}

// What fits is said beforehand: no less than is taken.
TEST(Gpu, TakesNoMoreMemoryThanItSaysItNeeds) {
  for (const char* name : {"viscoplastic", "alone", "staged"}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> w = world_of(name, seeds);
    auto counting = std::make_unique<Counting>(gpu::make_host_device());
    const Counting& device = *counting;
    const auto gpu = make_gpu_backend("gpu", std::move(counting));
    begin(w, *gpu, seeds);
    // As it was asked for matter as it came, or since: blocks come and go.
    std::size_t needed = gpu::bytes_needed(w);
    Motion<float> motion;
    advance(w, *gpu, 60, &motion);
    needed = std::max(needed, gpu::bytes_needed(w));
    std::printf("%s: %.2f MB needed, %.2f MB taken\n", name, static_cast<double>(needed) / 1e6,
                static_cast<double>(device.taken) / 1e6);
    EXPECT_LE(device.taken, needed) << name;
    EXPECT_GE(device.taken, needed / 3) << name;
  }
}

// Whole numbers lose nothing: the momentum of a body that flies freely, turns and swings.
TEST(Gpu, MassAndMomentumStay) {
  World<float> w = empty_world<float>(0.02, {20, 20, 20});
  w.settings.fixed_dt = 2e-4, w.settings.fps = 50;
  add_set(w, "neo_hookean", soft("neo_hookean"), mixed_spacing);
  const Field spin = [](const Vec3d& p) { return Vec3d{1 - 20 * (p.y - 0.2), 0.5 + 20 * (p.x - 0.1), 0.3}; };
  const std::vector<std::vector<ParticleSeed>> seeds{
      lattice({{0.06, 0.16, 0.1}, {0.14, 0.24, 0.18}}, mixed_spacing, spin)};
  const double mass = w.sets[0].mass * 512;
  ASSERT_EQ(seeds[0].size(), 512u);
  // Returns what of its momentum and angular momentum is lost.
  const auto lost = [&](Backend<float>& backend) {
    World<float> moving = w;
    begin(moving, backend, seeds);
    const ImpulseSum start = backend.grid_momentum(moving, NodesHold::momenta);
    GridStats last;
    for (int k = 0; k < 300; ++k) last = step<float>(moving, backend, nullptr).grid;
    EXPECT_NEAR(last.mass, mass, 1e-6 * mass);
    const ImpulseSum now = backend.grid_momentum(moving, NodesHold::momenta);
    return std::array{length(now.impulse - start.impulse) / length(start.impulse),
                      length(now.angular - start.angular) / length(start.angular)};
  };
  const auto [momentum, spun] = lost(*host_gpu());
  const auto [float_momentum, float_spun] = lost(*make_reference_backend<float>());
  std::printf("lost: %.1e of the momentum, %.1e of its moment; in floats %.1e, %.1e\n", momentum, spun, float_momentum,
              float_spun);
  EXPECT_LE(momentum, 1e-6);
  EXPECT_LE(spun, 1e-6);
}

}  // namespace
}  // namespace dreampm::gpu_test
