// Matter that comes in and goes out, compared with its definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/region.h"
#include "dreampm/math/rng.h"
#include "dreampm/state/block_bounds.h"
#include "dreampm/state/regroup.h"

namespace dreampm {
namespace {

constexpr Vec3i blocks{6, 4, 5};

World<float> empty_world(const std::array<bool, 3>& periodic = {}) {
  World<float> w;
  w.dx = 0.5, w.origin = {3, -1, 2};
  w.low = Vec3i{-2, 1, 0} * block_width, w.high = w.low + blocks * block_width, w.periodic = periodic;
  for (const char* name : {"newtonian", "elastic"}) {
    ParticleSet<float> set;
    set.name = set.material = name;
    set.liquid = w.sets.empty();
    set.mass = 2, set.rest_volume = 1;
    w.sets.push_back(set);
  }
  w.sets[1].transfer = {1, 0.97, 0};
  return w;
}

/// Anywhere between `from` and `to` of the domain along x, [0, 1].
std::vector<ParticleSeed> scattered(const World<float>& w, std::uint32_t first, std::uint32_t count, double from,
                                    double to) {
  const Box3d box = w.domain();
  std::vector<ParticleSeed> seeds;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto at = [&](std::uint64_t axis) { return uniform(axis, first + i); };
    seeds.push_back(
        {first + i, box.min + Vec3d{from + (to - from) * at(0), at(1), at(2)} * box.size(), {at(3), at(4), at(5)}, {}});
  }
  return seeds;
}

/// A number of each particle that no other has, in every column that is not its place.
void mark(ParticleSet<float>& set) {
  for (std::size_t c = 0; c < set.state.size(); ++c)
    for (std::size_t p = 0; p < set.size(); ++p) set.state[c][p] = static_cast<float>(set.id[p] * 16 + c);
}

/// All columns of a particle, in bits that can be compared.
std::vector<float> row(const ParticleSet<float>& set, std::size_t p) {
  std::vector<float> all{static_cast<float>(set.id[p])};
  for (const auto* columns : {&set.u, &set.own_velocity})
    for (const auto& column : *columns)
      if (!column.empty()) all.push_back(column[p]);
  for (const auto& column : set.state) all.push_back(column[p]);
  return all;
}

/// Block by block, those of `was` and then `seeds` in their order.
void expect_inserted(const World<float>& was, const World<float>& now, std::size_t s,
                     const std::vector<ParticleSeed>& seeds) {
  const ParticleSet<float>&set = now.sets[s], &old = was.sets[s];
  ASSERT_EQ(set.size(), old.size() + seeds.size());
  BlockList before;
  before.assign(was.particle_blocks);
  std::vector<std::vector<std::size_t>> came(now.particle_blocks.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3i block = now.locate(seeds[i].position).block;
    const auto b = std::lower_bound(now.particle_blocks.begin(), now.particle_blocks.end(), block, block_less);
    ASSERT_TRUE(b != now.particle_blocks.end() && *b == block);
    came[static_cast<std::size_t>(b - now.particle_blocks.begin())].push_back(i);
  }
  std::size_t at = 0;
  for (std::size_t b = 0; b < now.particle_blocks.size(); ++b) {
    ASSERT_EQ(set.block_start[b], at);
    if (const std::int32_t o = before.find(now.particle_blocks[b]); o != BlockList::none) {
      const auto first = old.block_start.begin() + o;
      for (std::size_t p = first[0]; p < first[1]; ++p) ASSERT_EQ(row(set, at++), row(old, p));
    }
    for (const std::size_t i : came[b]) {
      ASSERT_EQ(set.id[at], seeds[i].id);
      const auto home = now.locate(seeds[i].position);
      for (int a = 0; a < 3; ++a) ASSERT_EQ(set.u[static_cast<std::size_t>(a)][at], home.at[a]);
      ++at;
    }
  }
  EXPECT_EQ(set.block_start.back(), at);
}

// Enough that columns are moved in parts.
TEST(Insert, PutsNewParticlesBehindThoseOfTheirBlock) {
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    for (const std::size_t s : {0, 1}) {
      World<float> w = empty_world();
      insert<float>(w, s, scattered(w, 0, 150'000, 0.2, 0.8));
      insert<float>(w, 1 - s, scattered(w, 300'000, 500, 0.1, 0.5));
      regroup(w);
      std::uint32_t next = 150'000;
      // Few, none, many, and into blocks that have no matter, before and after all others.
      for (const auto& [count, from, to] : {std::tuple{300u, 0.2, 0.8}, std::tuple{0u, 0.0, 1.0},
                                            std::tuple{40'000u, 0.3, 0.35}, std::tuple{20u, 0.0, 1.0}}) {
        mark(w.sets[0]), mark(w.sets[1]);
        const World<float> was = w;
        const std::vector<ParticleSeed> seeds = scattered(w, next, count, from, to);
        next += count;
        insert<float>(w, s, seeds);
        expect_inserted(was, w, s, seeds);
        expect_inserted(was, w, 1 - s, {});
        if (HasFailure()) FAIL() << count << " on " << threads;
      }
    }
  }
}

std::shared_ptr<const Region> box(const Vec3d& middle, const Vec3d& size) {
  Shape shape;
  shape.form = BoxShape{size}, shape.center = middle;
  return make_region(shape, 0.1, {});
}

/// Lets every particle move by up to `cells` along an axis, as between two sorts.
void stir(World<float>& w, double cells) {
  for (auto& set : w.sets)
    for (std::uint64_t a = 0; a < 3; ++a)
      for (std::size_t p = 0; p < set.size(); ++p)
        set.u[a][p] += static_cast<float>(cells * (2 * uniform(20 + a, set.id[p]) - 1));
}

TEST(TakeOut, FindsWhatIsInSinksAndTheSortLeavesItOut) {
  // Sinks that lie in each other, that reach over the end of a periodic axis, that move.
  auto path = std::make_shared<MotionPath>();
  path->velocity = {1, 0, 0}, path->spin = {0, 0.3, 0};
  for (const std::array<bool, 3> periodic : {std::array<bool, 3>{}, std::array<bool, 3>{true, false, true}})
    for (const double cells : {0.9, 3.5, 7.5}) {
      World<float> w = empty_world(periodic);
      insert<float>(w, 0, scattered(w, 0, 4000, 0, 1)), insert<float>(w, 1, scattered(w, 4000, 3000, 0.3, 1));
      regroup(w);
      stir(w, cells);
      w.step = 3, w.time = 0.5, w.drift = 0.9;
      const Vec3d middle = w.domain().center(), size = w.domain().size();
      w.sinks = {{"one", box(middle, size * 0.3)},
                 {"two", box(middle + Vec3d{0.1, 0, 0} * size, size * 0.25)},
                 {"end", box({w.domain().max.x, middle.y, middle.z}, size * 0.2)}};
      w.sinks.push_back({"goes", box(w.domain().min, size * 0.5), {}, 0, {}, {}, path});
      World<float> plain = w;
      plain.sinks.clear();
      std::vector<std::uint64_t> counts;
      for (Sink& sink : w.sinks) {
        std::uint64_t count = 0;
        for (std::size_t s = 0; s < 2; ++s) {
          ParticleSet<float>& set = plain.sets[s];
          std::vector<bool> keep(set.size(), true);
          for (std::size_t b = 0; b < plain.particle_blocks.size(); ++b)
            for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
              const Vec3d x = plain.position(plain.particle_blocks[b], {set.u[0][p], set.u[1][p], set.u[2][p]});
              keep[p] = !(sink.shape->distance(sink.path ? path->pose_at(w.time).inverse(x) : x) < 0);
            }
          count += erase(plain, s, keep);
        }
        counts.push_back(count);
        EXPECT_GT(count, 10u) << sink.name;
        plain.left += count;
      }
      const bool far = cells > block_width;
      GridFields<float> spare;
      Regroup<float>()(plain, spare, far);
      Regroup<float>()(w, spare, far);
      for (std::size_t n = 0; n < counts.size(); ++n) EXPECT_EQ(w.sinks[n].taken, counts[n]) << w.sinks[n].name;
      EXPECT_EQ(w.left, plain.left);
      EXPECT_EQ(w.particle_blocks, plain.particle_blocks);
      for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_EQ(w.sets[s].block_start, plain.sets[s].block_start);
        ASSERT_EQ(w.sets[s].size(), plain.sets[s].size());
        for (std::size_t p = 0; p < w.sets[s].size(); ++p) ASSERT_EQ(row(w.sets[s], p), row(plain.sets[s], p));
      }
    }
}

TEST(TakeOut, SumsWhatSinksTakeToTheSameBitsOnAnyThreads) {
  World<float> first;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    World<float> w = empty_world();
    for (ParticleSet<float>& set : w.sets) set.carries_motion = true;
    insert<float>(w, 0, scattered(w, 0, 6000, 0, 1)), insert<float>(w, 1, scattered(w, 6000, 6000, 0, 1));
    w.sinks = {{"one", box(w.domain().center(), w.domain().size() * 0.5)}};
    Vec3d momentum;
    for (const ParticleSet<float>& set : w.sets)
      for (std::size_t p = 0; p < set.size(); ++p)
        momentum += static_cast<Vec3d>(Vec3f{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]}) *
                    set.mass;
    w.step = 1;
    regroup(w);
    for (const ParticleSet<float>& set : w.sets)
      for (std::size_t p = 0; p < set.size(); ++p)
        momentum -= static_cast<Vec3d>(Vec3f{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]}) *
                    set.mass;
    const Sink& sink = w.sinks[0];
    EXPECT_GT(sink.taken, 1000u);
    EXPECT_EQ(w.left, sink.taken);
    EXPECT_LT(length(sink.momentum - momentum), 1e-9 * length(momentum));
    if (threads == 1) first = w;
    EXPECT_EQ(sink.momentum, first.sinks[0].momentum);
    EXPECT_EQ(sink.angular, first.sinks[0].angular);
    EXPECT_EQ(state_hash(w), state_hash(first));
  }
}

TEST(BlockBounds, HoldWhatHasGoneSoFar) {
  for (const std::array<bool, 3> periodic : {std::array<bool, 3>{}, std::array<bool, 3>{true, true, true}}) {
    World<float> w = empty_world(periodic);
    insert<float>(w, 0, scattered(w, 0, 5000, 0, 1));
    for (const int beyond : {0, 1, 4}) {
      std::size_t off = 0;
      double room = 0;
      for (std::size_t b = 0; b < w.particle_blocks.size(); ++b) {
        const Box3d box = bounds_of_block(w, w.particle_blocks[b], beyond);
        room += box.size().x * box.size().y * box.size().z;
        for (const float u : {-static_cast<float>(beyond), 1.5f, static_cast<float>(block_width + beyond)})
          for (const float v : {-static_cast<float>(beyond), static_cast<float>(block_width + beyond)})
            off += !box.contains(w.position(w.particle_blocks[b], {u, v, u}));
      }
      EXPECT_EQ(off, 0u) << beyond;
      // Not more than that, but for blocks at the end of a periodic axis.
      if (!periodic[0]) {
        EXPECT_NEAR(room / static_cast<double>(w.particle_blocks.size()), std::pow((4 + 2 * beyond) * w.dx, 3), 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace dreampm
