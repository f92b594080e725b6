// The cpu backend against the reference, and what must not change a bit: threads, output, place in
// space, a copy.
#include <gtest/gtest.h>

#include <cstring>

#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/base/parallel.h"
#include "dreampm/contact/obstacles.h"
#include "dreampm/math/rng.h"
#include "mixed_world.h"

namespace dreampm::backend_test {
namespace {
using namespace test;

/// Runs the world's matter with both backends, on every instruction set: moved by more than a cell
/// it lies in the same places.
void expect_alike(const World<float>& born, const std::vector<std::vector<ParticleSeed>>& seeds,
                  std::string_view name) {
  const auto after = [&](Backend<float>& backend) {
    World<float> w = born;
    begin(w, backend, seeds);
    advance(w, backend, 200);
    return positions_by_id(w);
  };
  const auto want = after(*make_reference_backend<float>());
  double moved = 0;
  for (const auto& set : seeds)
    for (const ParticleSeed& n : set) moved = std::max(moved, length(want[n.id] - n.position) / born.dx);
  EXPECT_GT(moved, 1) << name;
  for (const std::string_view isa : cpu_instruction_sets()) {
    const auto got = after(*make_cpu_backend(isa));
    double sum = 0;
    for (std::size_t i = 0; i < want.size(); ++i) sum += length2(got[i] - want[i]) / (born.dx * born.dx);
    const double rms = std::sqrt(sum / static_cast<double>(want.size()));
    std::printf("%s on %s: %.2e cells rms\n", std::string(name).c_str(), std::string(isa).c_str(), rms);
    EXPECT_LE(rms, 1e-5) << name << " on " << isa;
  }
}

TEST(Backend, CpuFollowsTheReferenceForEveryMaterialAndInstructionSet) {
  for (const MaterialInfo& m : material_infos()) {
    std::vector<std::vector<ParticleSeed>> seeds;
    const World<float> w = mixed_world<float>(m.name, seeds);
    expect_alike(w, seeds, m.name);
  }
}

// Particles near a wall of 0.6 cells get their exact distance, each backend by its own loop. Those
// that start inside of the wall are put out of it by that distance.
TEST(Backend, CpuFollowsTheReferenceAtAThinWall) {
  for (const std::string_view name : {"newtonian", "sand"}) {
    std::vector<std::vector<ParticleSeed>> seeds;
    World<float> w = mixed_world<float>(name, seeds);
    Shape plate;
    plate.form = BoxShape{{0.3, 0.6 * w.dx, 0.3}};
    plate.rotate_axis = {1, 0, 2}, plate.rotate_angle = 10;
    plate.center = Vec3d{0.16, 0.115, 0.1};
    w.colliders = {{"plate", make_region(plate, w.dx, {}), WallType::separate, 0.4}};
    Obstacles obstacles;
    World<float> full = w;
    for (std::size_t s = 0; s < seeds.size(); ++s) insert(full, s, seeds[s]);
    obstacles.prepare(full);
    EXPECT_TRUE(obstacles.any_thin());
    expect_alike(w, seeds, name);
  }
}

// Sides, types and friction of walls, in lanes and node by node; what the wall gives is what the
// nodes won.
TEST(Backend, WallsInLanesDoWhatTheyDoToOneNode) {
  const NodeLoops<float> plain = plain_node_loops<float>();
  const KernelTables tables = available_kernels();
  for (int t = 0; t < tables.count; ++t)
    for (const WallType type : {WallType::separate, WallType::slip, WallType::stick})
      for (const auto& [friction, gaps] : {std::pair{0.0f, false}, {0.4f, false}, {0.4f, true}})
        for (int side = 0; side < 6; ++side)
          for (int plane = -1; plane <= block_width; ++plane) {
            SCOPED_TRACE(testing::Message()
                         << tables.tables[t]->isa << ", type " << static_cast<int>(type) << ", friction " << friction
                         << (gaps ? " with gaps" : "") << ", side " << side << ", plane " << plane);
            BoxWalls<float> walls{{-9, -9, -9}, {9, 9, 9}, {}, {}};
            (side % 2 == 0 ? walls.low : walls.high)[side / 2] = plane;
            for (int s = 0; s < 6; ++s) walls.type[s] = type, walls.friction[s] = friction;
            std::uint64_t count = 0;
            Node<float> before[block_nodes], one[block_nodes], lanes[block_nodes];
            const auto number = [&] { return static_cast<float>(2 * uniform(7, count++) - 1); };
            for (Node<float>& n : before) n = {number(), number(), number(), 1.5f + number()};
            before[21] = {};
            std::copy(std::begin(before), std::end(before), one),
                std::copy(std::begin(before), std::end(before), lanes);
            alignas(64) float approach[block_nodes];
            for (int n = 0; n < block_nodes; ++n) approach[n] = 0.25f * static_cast<float>(n % 4);
            ImpulseSum by_one, by_lanes;
            plain.box_contact(one, walls, side, gaps ? approach : nullptr, by_one);
            tables.tables[t]->node_loops().box_contact(lanes, walls, side, gaps ? approach : nullptr, by_lanes);
            ImpulseSum won;
            int held = 0;
            for (int n = 0; n < block_nodes; ++n) {
              const Node<float>&a = before[n], &b = lanes[n];
              EXPECT_TRUE(b.x == one[n].x && b.y == one[n].y && b.z == one[n].z && b.m == a.m) << "node " << n;
              const Vec3d from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
              Vec3d slid = to;
              const bool touched =
                  side % 2 == 0 ? node_offset(n)[side / 2] <= plane : node_offset(n)[side / 2] >= plane;
              if (gaps && touched) {
                // Matter comes nearer no faster than its gap allows, and does no work by that.
                const double onto = from[side / 2] * inward_of(side), let = static_cast<double>(approach[n]);
                const double now = to[side / 2] * inward_of(side);
                EXPECT_NEAR(now, onto < 0 ? std::max(onto, -let) : type == WallType::separate ? onto : 0, 1e-6);
                slid[side / 2] = std::max(now, 0.0) * inward_of(side);
              }
              won.add(static_cast<Vec3d>(node_offset(n)), static_cast<double>(a.m), from, to, slid);
              held += !(a.x == b.x && a.y == b.y && a.z == b.z);
            }
            const int layers = std::clamp(side % 2 == 0 ? plane + 1 : block_width - plane, 0, block_width);
            EXPECT_LE(held, 16 * layers);
            EXPECT_GE(held, (gaps ? 2 : 4) * layers);
            for (const ImpulseSum& given : {by_one, by_lanes}) {
              EXPECT_LE(length(given.impulse - won.impulse), 1e-4);
              EXPECT_LE(length(given.angular - won.angular), 1e-3);
              EXPECT_NEAR(given.work, won.work, 1e-4);
            }
          }
}

// Images in lanes and node by node: what they do, to which nodes, and that momentum and energy are
// what these won.
TEST(Backend, ImagesInLanesDoWhatTheyDoToOneNode) {
  const NodeLoops<float> plain = plain_node_loops<float>();
  const KernelTables tables = available_kernels();
  struct Blocks {
    Node<float> ghosts[block_nodes], walls[block_nodes], inners[block_nodes];
  };
  for (int t = 0; t < tables.count; ++t)
    for (const WallType type : {WallType::separate, WallType::slip, WallType::stick})
      for (int side = 0; side < 6; ++side) {
        SCOPED_TRACE(testing::Message() << tables.tables[t]->isa << ", type " << static_cast<int>(type) << ", side "
                                        << side);
        std::uint64_t count = 0;
        const auto number = [&] { return static_cast<float>(2 * uniform(11, count++) - 1); };
        Blocks before;
        for (auto* nodes : {&before.ghosts, &before.walls, &before.inners})
          for (Node<float>& n : *nodes) n = {number(), number(), number(), 1.5f + number()};
        // A plane's third node has nothing behind, its sixth nothing before the wall.
        const int axis = axis_of(side);
        before.ghosts[node_in_plane(axis, 2)] = before.inners[node_in_plane(axis, 5)] = {};
        constexpr std::uint16_t closed = 0xfeef;  // Matter does not touch the wall at two of the nodes.
        const auto run = [&](const NodeLoops<float>& loops, Blocks& b, ImpulseSum& folding, ImpulseSum& reflecting,
                             double& gained) {
          const MirrorPlanes<float> planes{b.ghosts, b.walls, b.inners, side, type, closed};
          const std::uint16_t folded = loops.fold_ghosts(planes, folding);
          gained = loops.reflect_ghosts(planes, folded, reflecting);
          return folded;
        };
        Blocks one = before, lanes = before;
        ImpulseSum one_fold, one_reflect, fold, reflect;
        double one_gained = 0, gained = 0;
        const std::uint16_t folded = run(plain, one, one_fold, one_reflect, one_gained);
        EXPECT_EQ(run(tables.tables[t]->node_loops(), lanes, fold, reflect, gained), folded);
        EXPECT_EQ(std::memcmp(&one, &lanes, sizeof one), 0);
        ImpulseSum won_inside, won_behind;
        double energy = 0;
        for (int n = 0; n < plane_nodes; ++n) {
          const int at = node_in_plane(axis, n);
          const bool presses = Vec3<float>{before.walls[at].x, before.walls[at].y, before.walls[at].z}[axis] *
                                   static_cast<float>(inward_of(side)) <
                               0;
          EXPECT_EQ((folded >> n & 1) != 0,
                    n != 2 && n != 5 && n != 4 && n != 8 && (type != WallType::separate || presses))
              << "node " << n;
          const auto win = [&](ImpulseSum& impulses, const Node<float>& from, const Node<float>& to) {
            const Vec3d v{from.x, from.y, from.z}, w{to.x, to.y, to.z};
            impulses.add(static_cast<Vec3d>(node_offset(at)), static_cast<double>(from.m), v, w, {});
            return 0.5 * static_cast<double>(from.m) * (dot(w, w) - dot(v, v));
          };
          win(won_inside, before.inners[at], lanes.inners[at]);
          energy += win(won_behind, before.ghosts[at], lanes.ghosts[at]);
        }
        const auto near = [](const ImpulseSum& a, const ImpulseSum& b) {
          EXPECT_LE(length(a.impulse - b.impulse), 1e-5);
          EXPECT_LE(length(a.angular - b.angular), 1e-4);
          EXPECT_EQ(a.work, 0);
        };
        near(one_fold, won_inside), near(fold, won_inside), near(one_reflect, won_behind), near(reflect, won_behind);
        EXPECT_NEAR(one_gained, energy, 1e-5);
        EXPECT_NEAR(gained, energy, 1e-5);
      }
}

TEST(Backend, ThreadsDoNotChangeABit) {
  for (const MaterialInfo& m : material_infos()) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadLimit limit(threads);
      const auto cpu = make_cpu_backend();
      hashes.push_back(state_hash(ran<float>(m.name, *cpu, 100)));
    }
    for (const auto h : hashes) EXPECT_EQ(h, hashes[0]) << m.name;
  }
}

TEST(Backend, LookingDoesNotChangeABit) {
  const auto a = make_cpu_backend(), b = make_cpu_backend();
  std::vector<std::vector<ParticleSeed>> seeds;
  World<float> w = mixed_world<float>("newtonian", seeds);
  w.settings.fps = 1000;
  World<float> v = w;
  begin(w, *a, seeds), begin(v, *b, seeds);
  Motion<float> motion;
  advance(w, *a, 100);
  advance(v, *b, 100, &motion);
  ASSERT_EQ(motion.sets.size(), 2u);
  EXPECT_EQ(motion.sets[0].velocity.size(), v.sets[0].size());
  EXPECT_EQ(state_hash(w), state_hash(v));
}

// Matter, walls and collider 1,200 blocks away from the origin, on every set and with every
// material.
TEST(Backend, PlaceInSpaceDoesNotChangeABit) {
  const Vec3i far{4800, -4800, 4800};
  for (const std::string_view isa : cpu_instruction_sets())
    for (const MaterialInfo& m : material_infos()) {
      const auto a = make_cpu_backend(isa), b = make_cpu_backend(isa);
      std::vector<std::vector<ParticleSeed>> seeds;
      World<float> w = mixed_world<float>(m.name, seeds), v = w;
      v.low = v.low + far, v.high = v.high + far;
      begin(w, *a, seeds), begin(v, *b, seeds);
      advance(w, *a, 100), advance(v, *b, 100);
      EXPECT_EQ(state_hash(w), state_hash(v)) << m.name << " on " << isa;
    }
}

/// Drops of one particle, thrown about in a wide and flat box: blocks with few particles, in more
/// pencils than are taken by their colors.
World<float> spray(std::vector<std::vector<ParticleSeed>>& seeds) {
  World<float> w = empty_world<float>(0.02, {112, 112, 10});
  w.gravity = {0, -9.81, 0};
  w.settings.fps = 100;
  w.settings.fixed_dt = 2e-4;
  add_set(w, "newtonian", soft("newtonian"), mixed_spacing);
  seeds.assign(1, {});
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const auto at = [&](std::uint64_t axis) { return uniform(axis, i); };
    seeds[0].push_back(
        {i, {2.24 * at(0), 2.24 * at(1), 0.2 * at(2)}, {4 * at(3) - 2, 4 * at(4) - 2, 4 * at(5) - 2}, {}});
  }
  return w;
}

TEST(Backend, SprayFollowsTheReferenceOnAnyNumberOfThreads) {
  std::vector<std::vector<ParticleSeed>> seeds;
  const World<float> born = spray(seeds);
  const auto after = [&](Backend<float>& backend) {
    World<float> w = born;
    begin(w, backend, seeds);
    advance(w, backend, 100);
    return w;
  };
  const World<float> reference = after(*make_reference_backend<float>());
  EXPECT_GT(reference.particle_blocks.size(), 1500u);
  const auto want = positions_by_id(reference);
  for (const std::string_view isa : cpu_instruction_sets()) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 5}) {
      const ThreadLimit limit(threads);
      const World<float> w = after(*make_cpu_backend(isa));
      hashes.push_back(state_hash(w));
      const auto got = positions_by_id(w);
      double sum = 0;
      for (std::size_t i = 0; i < want.size(); ++i) sum += length2(got[i] - want[i]) / (w.dx * w.dx);
      EXPECT_LE(std::sqrt(sum / static_cast<double>(want.size())), 1e-5) << isa;
    }
    for (const auto h : hashes) EXPECT_EQ(h, hashes[0]) << isa;
  }
}

template <class R>
void check_copy(Backend<R>& first, Backend<R>& second) {
  World<R> w = ran<R>("newtonian", first, 70);
  EXPECT_GT(w.drift, 0);  // between sorts: the copy must not need one
  World<R> copy = w;
  second.attach(copy);
  EXPECT_EQ(state_hash(copy), state_hash(w));
  advance(w, first, 80);
  advance(copy, second, 80);
  EXPECT_EQ(state_hash(copy), state_hash(w));
  EXPECT_EQ(copy.step, 150u);
}
TEST(Backend, ACopyWithAFreshBackendGoesTheSameWay) {
  check_copy<float>(*make_cpu_backend(), *make_cpu_backend());
  check_copy<double>(*make_reference_backend<double>(), *make_reference_backend<double>());
}

/// A backend that has run a world with another collider and other values.
template <class R>
void check_reuse(Backend<R>& used, Backend<R>& fresh) {
  std::vector<std::vector<ParticleSeed>> seeds;
  World<R> first = mixed_world<R>("newtonian", seeds);
  first.colliders[0].shape = sphere({0.2, 0.02, 0.1}, 0.08);
  first.sets[1].values.set("youngs_modulus", 4e4);
  begin(first, used, seeds);
  advance(first, used, 20);
  EXPECT_EQ(state_hash(ran<R>("newtonian", used, 60)), state_hash(ran<R>("newtonian", fresh, 60)));
}
TEST(Backend, KeepsNothingOfAnEarlierWorld) {
  check_reuse<float>(*make_cpu_backend(), *make_cpu_backend());
  check_reuse<double>(*make_reference_backend<double>(), *make_reference_backend<double>());
}

TEST(Backend, TheHashSeesOneBit) {
  const auto cpu = make_cpu_backend();
  World<float> w = ran<float>("newtonian", *cpu, 5);
  const auto before = state_hash(w);
  World<float> copy = w;
  copy.sets[0].u[1][17] = std::nextafter(copy.sets[0].u[1][17], 9.0f);
  EXPECT_NE(state_hash(copy), before);
  copy = w;
  copy.grid.nodes[copy.grid.nodes.size() / 2].m += 1e-3f;
  EXPECT_NE(state_hash(copy), before);
}

}  // namespace
}  // namespace dreampm::backend_test
