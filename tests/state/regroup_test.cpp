// Sorting, compared with its definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <tuple>

#include "dreampm/base/parallel.h"
#include "dreampm/math/rng.h"
#include "dreampm/state/regroup.h"

namespace dreampm::regroup_test {
namespace {

using Key = std::tuple<int, int, int>;
Key key(const Vec3i& b) { return {b.x, b.y, b.z}; }

/// The domain of a test: blocks, and the axes that are periodic.
struct Domain {
  Vec3i blocks;
  std::array<bool, 3> periodic;
};
const Domain domains[]{{{6, 5, 4}, {false, false, false}}, {{6, 5, 4}, {true, true, true}},
                       {{3, 4, 2}, {true, false, true}},   {{1, 4, 3}, {true, false, true}},
                       {{2, 1, 5}, {true, true, false}},   {{2, 2, 2}, {true, true, true}}};

void fill(Nodes<float>& nodes, float from) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const float v = from + static_cast<float>(i);
    nodes[i] = {v, v + 0.25f, v + 0.5f, v + 0.75f};
  }
}

/// A liquid, a solid with velocities of its own and an empty set, `count` particles each, lumped so
/// that blocks of one are empty in the other; the grid holds other numbers at each node.
World<float> world_of(const Domain& d, std::uint32_t count, const Vec3i& shift = {}) {
  World<float> w;
  w.dx = 0.5;
  w.low = Vec3i{-2, 1, 0} * block_width + shift * block_width;
  w.high = w.low + d.blocks * block_width;
  w.periodic = d.periodic;
  const char* const materials[]{"newtonian", "elastic", "snow"};
  for (const char* name : materials) {
    ParticleSet<float> set;
    set.name = set.material = name;
    set.liquid = w.sets.empty();
    set.mass = set.rest_volume = 1;
    w.sets.push_back(set);
  }
  w.sets[1].transfer = {1, 0.97, 0};
  const Vec3d size = static_cast<Vec3d>(d.blocks * block_width) * w.dx;
  for (std::size_t s = 0; s < 2; ++s) {
    std::vector<ParticleSeed> all;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto at = [&](std::uint64_t axis) {
        const double u = uniform(10 * s + axis, i);
        return s == 0 ? u * u : 1 - u * u * u;
      };
      all.push_back({static_cast<std::uint32_t>(s) * count + i,
                     {at(0) * size.x, at(1) * size.y, at(2) * size.z},
                     {at(3), at(4), at(5)},
                     {}});
    }
    insert<float>(w, s, all);
  }
  for (auto& set : w.sets)
    for (std::size_t c = 0; c < set.state.size(); ++c)
      for (std::size_t p = 0; p < set.size(); ++p) set.state[c][p] = static_cast<float>(set.id[p] * 16 + c);
  fill(w.grid.nodes, 1), fill(w.grid.solids, 1e5f), fill(w.grid.velocity_old[1], 2e5f), fill(w.grid.mixture, 3e5f);
  return w;
}

/// Lets every particle move by less than a cell an axis, as between two sorts.
void stir(World<float>& w, std::uint64_t round) {
  for (auto& set : w.sets)
    for (int a = 0; a < 3; ++a)
      for (std::size_t p = 0; p < set.size(); ++p)
        set.u[static_cast<std::size_t>(a)][p] +=
            static_cast<float>(1.8 * uniform(100 + 3 * round + static_cast<std::uint64_t>(a), set.id[p]) - 0.9);
  w.drift = 0.9;
}

/// The place of a particle after a sort, by its definition. Cells come in rows along z, the rows of
/// every second plane in reverse, so that each lies beside the one before.
struct Place {
  Vec3i block;
  Vec3<float> u;
  int cell;
};
Place place_of(const World<float>& w, const Vec3i& old, Vec3<float> u) {
  Vec3i block = old, cell;
  for (int a = 0; a < 3; ++a) {
    const int side = u[a] < 0 ? -1 : u[a] < 4 ? 0 : 1;
    block[a] += side;
    u[a] -= static_cast<float>(4 * side);
    cell[a] = std::min(static_cast<int>(u[a]), 3);
  }
  const int row = cell.x % 2 == 0 ? cell.y : 3 - cell.y;
  return {w.wrapped(block), u, 16 * cell.x + 4 * row + cell.z};
}
bool gone(const World<float>& w, const Vec3i& block) {
  for (int a = 0; a < 3; ++a) {
    if (w.periodic[static_cast<std::size_t>(a)]) continue;
    const int size = w.high[a] - w.low[a];
    if (4 * block[a] + 5 < w.low[a] - size || 4 * block[a] + 1 > w.high[a] + size) return true;
  }
  return false;
}

using Columns = std::vector<LargeVector<float>>;
Columns columns_of(const ParticleSet<float>& set) {
  Columns all(set.u.begin(), set.u.end());
  all.insert(all.end(), set.state.begin(), set.state.end());
  all.insert(all.end(), set.own_velocity.begin(), set.own_velocity.end());
  return all;
}

void expect_sorted_by_definition(const World<float>& was, const World<float>& now) {
  std::map<Key, std::size_t> blocks;
  std::vector<std::vector<Place>> places(was.sets.size());
  std::uint64_t left = was.left;
  for (std::size_t s = 0; s < was.sets.size(); ++s)
    for (std::size_t b = 0; b < was.particle_blocks.size(); ++b)
      for (std::size_t p = was.sets[s].block_start[b]; p < was.sets[s].block_start[b + 1]; ++p) {
        const auto& u = was.sets[s].u;
        places[s].push_back(place_of(was, was.particle_blocks[b], {u[0][p], u[1][p], u[2][p]}));
        if (gone(was, places[s].back().block))
          ++left;
        else
          blocks[key(places[s].back().block)] = 0;
      }
  std::size_t count = 0;
  for (auto& [k, index] : blocks) {
    ASSERT_LT(count, now.particle_blocks.size());
    EXPECT_EQ(key(now.particle_blocks[count]), k);
    index = count++;
  }
  ASSERT_EQ(now.particle_blocks.size(), count);
  EXPECT_EQ(now.left, left);
  EXPECT_EQ(now.drift, 0);

  for (std::size_t s = 0; s < was.sets.size(); ++s) {
    std::vector<std::size_t> order;
    for (std::size_t p = 0; p < places[s].size(); ++p)
      if (!gone(was, places[s][p].block)) order.push_back(p);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(key(places[s][a].block), places[s][a].cell, a) <
             std::tuple(key(places[s][b].block), places[s][b].cell, b);
    });
    std::vector<std::uint32_t> start(count + 1, 0), id;
    for (const std::size_t p : order) ++start[blocks[key(places[s][p].block)] + 1], id.push_back(was.sets[s].id[p]);
    std::partial_sum(start.begin(), start.end(), start.begin());
    EXPECT_EQ(now.sets[s].block_start, start);
    EXPECT_EQ(now.sets[s].id, id);
    Columns expected = columns_of(was.sets[s]);
    for (std::size_t c = 0; c < expected.size(); ++c) {
      LargeVector<float> sorted;
      for (const std::size_t p : order)
        if (!expected[c].empty()) sorted.push_back(c < 3 ? places[s][p].u[static_cast<int>(c)] : expected[c][p]);
      expected[c] = sorted;
    }
    EXPECT_EQ(columns_of(now.sets[s]), expected);
  }
}

template <class T>
void expect_carried(const BlockList& old_blocks, const LargeVector<T>& old, const BlockList& blocks,
                    const LargeVector<T>& now) {
  ASSERT_EQ(old.empty(), now.empty());
  if (now.empty()) return;
  ASSERT_EQ(now.size(), blocks.size() * block_nodes);
  const std::vector<T> zero(block_nodes);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::int32_t o = old_blocks.find(blocks[b]);
    const T* expected = o == BlockList::none ? zero.data() : old.data() + static_cast<std::size_t>(o) * block_nodes;
    EXPECT_EQ(std::memcmp(now.data() + b * block_nodes, expected, block_nodes * sizeof(T)), 0);
  }
}

/// The nodes along an axis that a particle in cell `c` can give to before the next sort, and what
/// lies behind a wall among them.
std::array<int, 2> reach_of(const World<float>& w, int axis, int c) {
  std::array<int, 2> nodes{c - 1, c + 3};
  if (w.periodic[static_cast<std::size_t>(axis)]) return nodes;
  if (nodes[0] == w.low[axis]) --nodes[0];
  if (nodes[1] == w.high[axis]) ++nodes[1];
  return nodes;
}

void expect_grid_by_definition(const World<float>& was, const World<float>& now) {
  std::map<Key, bool> wanted;
  for (const ParticleSet<float>& set : now.sets)
    for (std::size_t b = 0; b < now.particle_blocks.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
        std::array<int, 2> nodes[3];
        for (int a = 0; a < 3; ++a) {
          const int cell = std::min(static_cast<int>(set.u[static_cast<std::size_t>(a)][p]), 3);
          nodes[a] = reach_of(now, a, 4 * now.particle_blocks[b][a] + 1 + cell);
        }
        for (int i = nodes[0][0]; i <= nodes[0][1]; ++i)
          for (int j = nodes[1][0]; j <= nodes[1][1]; ++j)
            for (int k = nodes[2][0]; k <= nodes[2][1]; ++k) wanted[key(now.wrapped(block_of({i, j, k})))] = true;
      }
  ASSERT_EQ(now.grid.blocks.size(), wanted.size());
  std::size_t at = 0;
  for (const auto& [k, yes] : wanted) EXPECT_EQ(key(now.grid.blocks[at++]), k);
  const auto expect = [&](const auto& old, const auto& carried) {
    expect_carried(was.grid.blocks, old, now.grid.blocks, carried);
  };
  expect(was.grid.nodes, now.grid.nodes);
  expect(was.grid.solids, now.grid.solids);
  expect(was.grid.mixture, now.grid.mixture);
  for (std::size_t f = 0; f < 2; ++f) expect(was.grid.velocity_old[f], now.grid.velocity_old[f]);
}

TEST(World, HomeIsWhereThePositionIs) {
  for (const Domain& d : domains) {
    World<float> w;
    w.dx = 0.5, w.origin = {3, -1, 2};
    w.low = Vec3i{-2, 1, 0} * block_width, w.high = w.low + d.blocks * block_width, w.periodic = d.periodic;
    const Vec3d size = static_cast<Vec3d>(d.blocks * block_width) * w.dx;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      Vec3d x;
      for (int a = 0; a < 3; ++a)
        x[a] = w.origin[a] + (1.2 * uniform(40 + static_cast<std::uint64_t>(a), i) - 0.1) * size[a];
      const auto home = w.locate(x);
      EXPECT_EQ(w.wrapped(home.block), home.block);
      const Vec3d back = w.position(home.block, home.at);
      for (int a = 0; a < 3; ++a) {
        EXPECT_TRUE(home.at[a] >= 0 && home.at[a] <= 4) << home.at[a];
        const double off = (back[a] - x[a]) / size[a];
        EXPECT_NEAR(d.periodic[static_cast<std::size_t>(a)] ? off - std::round(off) : off, 0, 1e-6) << x[a];
      }
    }
  }
}

TEST(Regroup, SortsByItsDefinition) {
  for (const Domain& d : domains) {
    World<float> w = world_of(d, 3000);
    ASSERT_TRUE(!w.grid.solids.empty() && !w.grid.mixture.empty() && !w.grid.velocity_old[1].empty());
    Regroup<float> regroup;
    GridFields<float> spare;
    for (std::uint64_t round = 0; round < 6; ++round) {
      stir(w, round);
      const World<float> was = w;
      regroup(w, spare);
      expect_sorted_by_definition(was, w);
      expect_grid_by_definition(was, w);
      if (HasFailure()) FAIL() << d.blocks.x << d.blocks.y << d.blocks.z << " in round " << round;
    }
  }
}

TEST(Regroup, WhoIsAWholeBoxOutsideLeaves) {
  for (const std::array<bool, 3> periodic : {std::array<bool, 3>{}, std::array<bool, 3>{true, false, false}}) {
    World<float> w = world_of({{3, 2, 2}, periodic}, 500);
    Regroup<float> regroup;
    GridFields<float> spare;
    const std::size_t all = w.particles();
    // Half of them along x, and a quarter along -y.
    for (int i = 0; i < 64; ++i) {
      for (auto& set : w.sets)
        for (std::size_t p = 0; p < set.size(); ++p) {
          if (set.id[p] % 2 == 0) set.u[0][p] += 0.9f;
          if (set.id[p] % 4 == 1) set.u[1][p] -= 0.9f;
        }
      const World<float> was = w;
      regroup(w, spare);
      expect_sorted_by_definition(was, w);
      expect_grid_by_definition(was, w);
      EXPECT_EQ(w.left + w.particles(), all);
    }
    EXPECT_EQ(w.left, periodic[0] ? all / 4 : all / 4 * 3);
  }
}

TEST(Regroup, NothingIsLeftOfAWorldThatAllLeave) {
  World<float> w = world_of({{1, 1, 1}, {}}, 40);
  for (int i = 0; i < 16; ++i) {
    for (auto& set : w.sets)
      for (float& u : set.u[2]) u += 0.9f;
    regroup(w);
  }
  EXPECT_EQ(w.particles(), 0u);
  EXPECT_EQ(w.left, 80u);
  EXPECT_EQ(w.particle_blocks.size(), 0u);
  EXPECT_EQ(w.grid.blocks.size(), 0u);
  EXPECT_TRUE(w.grid.nodes.empty());
  regroup(w);
  EXPECT_EQ(w.left, 80u);
}

/// The bits after some sorts; with one room for all or a new one each time.
std::uint64_t sorted(const Domain& d, std::uint32_t count, const Vec3i& shift, bool one_room = true) {
  World<float> w = world_of(d, count, shift);
  Regroup<float> room;
  GridFields<float> spare;
  for (std::uint64_t round = 0; round < 4; ++round) {
    stir(w, round);
    if (one_room)
      room(w, spare);
    else
      regroup(w);
  }
  return state_hash(w);
}

TEST(Regroup, ThreadsAndRoomDoNotChangeABit) {
  // Enough for many pieces of every loop.
  for (const Domain& d : {Domain{{16, 12, 9}, {}}, Domain{{16, 12, 9}, {true, false, true}}}) {
    const std::uint64_t alone = [&] {
      const ThreadLimit limit(1);
      return sorted(d, 60000, {});
    }();
    for (const int threads : {2, 5}) {
      const ThreadLimit limit(threads);
      EXPECT_EQ(sorted(d, 60000, {}), alone) << threads;
    }
    EXPECT_EQ(sorted(d, 60000, {}, false), alone);
  }
}

TEST(Regroup, FarIsAsTwoSorts) {
  for (const Domain& d : domains) {
    World<float> w = world_of(d, 2000);
    for (auto& set : w.sets)
      for (auto& axis : set.u)
        for (std::size_t p = 0; p < set.size(); ++p)
          axis[p] +=
              static_cast<float>(14 * uniform(17, 3 * set.id[p] + static_cast<std::uint64_t>(&axis - &set.u[0])) - 7);
    World<float> once = w;
    Regroup<float> room;
    GridFields<float> spare;
    room(w, spare), room(w, spare);
    room(once, spare, true);
    EXPECT_EQ(once.left, w.left);
    EXPECT_EQ(once.particle_blocks, w.particle_blocks);
    for (std::size_t s = 0; s < w.sets.size(); ++s) {
      EXPECT_EQ(once.sets[s].block_start, w.sets[s].block_start);
      EXPECT_EQ(once.sets[s].id, w.sets[s].id);
      EXPECT_EQ(columns_of(once.sets[s]), columns_of(w.sets[s]));
    }
    expect_grid_by_definition(once, once);
  }
}

TEST(Regroup, FarFromTheOriginTheBitsAreTheSame) {
  for (const Domain& d : domains)
    for (const Vec3i& shift : {Vec3i{1200, -1200, 1200}, Vec3i{-1200, 0, 7}})
      EXPECT_EQ(sorted(d, 1000, shift), sorted(d, 1000, {}));
}

}  // namespace
}  // namespace dreampm::regroup_test
