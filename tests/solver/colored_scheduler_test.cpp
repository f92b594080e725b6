// Neighboring tasks run in the order of their colors and never at once, whichever thread runs
// them.
#include "dreampm/backend/cpu/colored_scheduler.h"

#include <gtest/gtest.h>

#include <thread>

#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"

namespace dreampm::colored_scheduler_test {
namespace {

/// Blocks of a box of `count` blocks from block `first` on, some missing; periodic along x and y
/// where asked.
struct Scene {
  World<float> world;
  std::vector<Vec3i> blocks;
  std::vector<std::uint32_t> work;

  Scene(const Vec3i& first, const Vec3i& count, bool periodic) {
    world.low = first * block_width, world.high = (first + count) * block_width;
    world.periodic = {periodic, periodic, false};
    for (int i = 0; i < count.x * count.y * count.z; ++i) {
      if (uniform(7, static_cast<std::uint64_t>(i)) < 0.2) continue;
      blocks.push_back(first + Vec3i{i / (count.y * count.z), i / count.z % count.y, i % count.z});
      work.push_back(static_cast<std::uint32_t>(100 * uniform(8, static_cast<std::uint64_t>(i))));
    }
  }
  bool beside(const Vec3i& a, const Vec3i& b) const {
    for (int n = 0; n < 27; ++n)
      if (n != 13 && world.wrapped(a + Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}) == b) return !(a == b);
    return false;
  }
};

/// Runs all tasks; for every pair beside each other, which came first: 1 the one with the lower
/// index.
std::vector<int> order_of_pairs(const Scene& s, ColoredScheduler& scheduler, int threads) {
  const ThreadLimit limit(threads);
  std::atomic<int> clock = 0, meetings = 0;
  std::vector<std::atomic<int>> began(s.blocks.size()), ended(s.blocks.size());
  scheduler.begin();
  parallel_region([&](ThreadTeam& team) {
    scheduler.run(team, [&](std::size_t task) {
      EXPECT_EQ(began[task], 0) << "twice";
      began[task] = ++clock;
      for (int i = 0; i < 50; ++i) std::this_thread::yield();
      ended[task] = ++clock;
    });
  });
  std::vector<int> first;
  for (std::size_t a = 0; a < s.blocks.size(); ++a)
    for (std::size_t b = a + 1; b < s.blocks.size(); ++b) {
      if (!s.beside(s.blocks[a], s.blocks[b])) continue;
      const bool forward = ended[a] < began[b];
      if (!forward && !(ended[b] < began[a])) ++meetings;
      first.push_back(forward);
    }
  EXPECT_EQ(meetings, 0) << "two beside each other worked at once";
  for (const auto& e : ended) EXPECT_GT(e, 0) << "never worked";
  return first;
}

/// The order that ColoredScheduler says beforehand.
std::vector<int> expected_order_of_pairs(const Scene& s, const ColoredScheduler& scheduler) {
  std::vector<std::size_t> turn(s.blocks.size(), s.blocks.size());
  EXPECT_EQ(scheduler.by_color().size(), s.blocks.size());
  for (std::size_t i = 0; i < scheduler.by_color().size(); ++i) turn.at(scheduler.by_color()[i]) = i;
  std::vector<int> first;
  for (std::size_t a = 0; a < s.blocks.size(); ++a) {
    EXPECT_LT(turn[a], s.blocks.size()) << "a task without a turn";
    for (std::size_t b = a + 1; b < s.blocks.size(); ++b)
      if (s.beside(s.blocks[a], s.blocks[b])) first.push_back(turn[a] < turn[b]);
  }
  return first;
}

TEST(ColoredScheduler, NeighborsKeepTheSameOrderForAnyThreads) {
  for (const bool periodic : {false, true})
    for (ColoredScheduler scheduler; const Vec3i& count : {Vec3i{5, 4, 3}, Vec3i{1, 2, 6}, Vec3i{4, 3, 3}}) {
      const Scene scene({-3, 1, 2}, count, periodic);
      scheduler.prepare(scene.world, scene.blocks, scene.work);
      const std::vector<int> alone = order_of_pairs(scene, scheduler, 1);
      EXPECT_GT(alone.size(), 3u);
      EXPECT_EQ(expected_order_of_pairs(scene, scheduler), alone);
      for (int round = 0; round < 5; ++round)
        for (const int threads : {2, 3}) EXPECT_EQ(order_of_pairs(scene, scheduler, threads), alone) << "x " << count.x;
    }
}

// Columns of blocks as tasks, in a domain that is periodic along them and holds no block 0.
TEST(ColoredScheduler, TasksThatReachThroughZKeepTheirOrder) {
  Scene scene({-3, 1, 40}, {5, 4, 1}, true);
  scene.world.periodic[2] = true;
  scene.world.high.z += 2 * block_width;
  ColoredScheduler scheduler;
  scheduler.prepare(scene.world, scene.blocks, scene.work);
  const std::vector<int> inside = order_of_pairs(scene, scheduler, 1);
  EXPECT_GT(inside.size(), 10u);
  std::vector<Vec3i> flat = scene.blocks;
  for (Vec3i& place : flat) place.z = 0;
  scheduler.prepare(scene.world, flat, scene.work);
  for (const int threads : {1, 2}) EXPECT_EQ(order_of_pairs(scene, scheduler, threads), inside);
}

TEST(ColoredScheduler, OtherMatterDoesNotChangeTheOrder) {
  const Scene all({0, 0, 0}, {5, 4, 3}, false);
  Scene part = all;
  // Without the first blocks: indices move, places do not.
  part.blocks.erase(part.blocks.begin(), part.blocks.begin() + 7);
  part.work.erase(part.work.begin(), part.work.begin() + 7);
  const auto pairs = [](const Scene& s, std::size_t from) {
    ColoredScheduler scheduler;
    scheduler.prepare(s.world, s.blocks, s.work);
    const std::vector<int> first = order_of_pairs(s, scheduler, 1);
    std::vector<int> kept;
    std::size_t i = 0;
    for (std::size_t a = 0; a < s.blocks.size(); ++a)
      for (std::size_t b = a + 1; b < s.blocks.size(); ++b)
        if (s.beside(s.blocks[a], s.blocks[b])) {
          if (a >= from) kept.push_back(first[i]);
          ++i;
        }
    return kept;
  };
  EXPECT_EQ(pairs(all, 7), pairs(part, 0));
}

}  // namespace
}  // namespace dreampm::colored_scheduler_test
