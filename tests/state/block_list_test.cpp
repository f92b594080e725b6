// Lists of blocks, and the blocks around a block.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

#include "dreampm/base/error.h"
#include "dreampm/math/rng.h"
#include "dreampm/state/neighbors.h"

namespace dreampm::block_list_test {
namespace {

using Key = std::tuple<int, int, int>;
Key key(const Vec3i& b) { return {b.x, b.y, b.z}; }

/// `count` blocks in a cube of `width` about `center`, some of them twice.
std::vector<Vec3i> cloud(int count, int width, const Vec3i& center, std::uint64_t seed) {
  std::vector<Vec3i> all;
  for (int i = 0; i < count; ++i) {
    const auto at = [&](std::uint64_t axis) {
      return static_cast<int>(width * uniform(seed * 3 + axis, static_cast<std::uint64_t>(i))) - width / 2;
    };
    all.push_back(center + Vec3i{at(0), at(1), at(2)});
  }
  return all;
}

// Kernels number nodes in 32 bits: 64 a block.
TEST(BlockList, MoreNodesThanCanBeNumberedAreRefused) {
  std::vector<Vec3i> line(std::size_t{1} << 25);
  for (std::size_t i = 0; i < line.size(); ++i) line[i].z = static_cast<int>(i);
  BlockList blocks;
  EXPECT_THROW(blocks.exchange(line), RunError);
}

TEST(BlockList, FindsWhatIsThereAndNothingElse) {
  // Dense, sparse, and far out, where differences of coordinates do not fit into 32 bits.
  const std::vector<std::vector<Vec3i>> lists{
      {},
      {{5, 5, 5}},
      cloud(2000, 10, {}, 1),
      cloud(300, 20, {1200, -1200, 7}, 2),
      cloud(200, 2000000, {}, 3),
      {{-2000000000, 2000000000, 0}, {2000000000, -2000000000, 0}, {2000000000, -2000000000, 2000000000}, {0, 0, 0}}};
  for (const auto& blocks : lists) {
    std::set<Key> there;
    for (const Vec3i& b : blocks) there.insert(key(b));
    BlockList list;
    list.assign(blocks);
    ASSERT_EQ(list.size(), there.size());
    std::map<Key, std::int32_t> index;
    for (const Key& k : there) index.emplace(k, static_cast<std::int32_t>(index.size()));
    const auto expected = [&](const Vec3i& b) {
      const auto at = index.find(key(b));
      return at == index.end() ? BlockList::none : at->second;
    };
    for (const auto& [k, i] : index) EXPECT_EQ(key(list[static_cast<std::size_t>(i)]), k);
    std::vector<Vec3i> asked = blocks;
    for (const auto& b : cloud(500, 12, blocks.empty() ? Vec3i{} : blocks[0], 4)) asked.push_back(b);
    for (const Vec3i& b : asked) {
      EXPECT_EQ(list.find(b), expected(b)) << b.x << " " << b.y << " " << b.z;
      const auto three = list.find_three(b);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(three[static_cast<std::size_t>(k)], expected(b + Vec3i{0, 0, k}));
      const std::size_t from = list.first_from(b);
      EXPECT_TRUE(from == list.size() || !block_less(list[from], b));
      EXPECT_TRUE(from == 0 || block_less(list[from - 1], b));
    }
  }
}

TEST(BlockList, ExchangeKeepsTheOrderGivenAndReturnsTheFormerList) {
  BlockList list;
  list.assign({{2, 0, 0}, {1, 0, 0}});
  std::vector<Vec3i> next{{-1, 0, 0}, {0, 3, 0}, {0, 3, 9}};
  list.exchange(next);
  EXPECT_EQ(next, (std::vector<Vec3i>{{1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(list.find({0, 3, 9}), 2);
  EXPECT_EQ(list.find({1, 0, 0}), BlockList::none);
}

World<float> domain(const Vec3i& blocks, const std::array<bool, 3>& periodic) {
  World<float> w;
  w.low = Vec3i{-3, 5, 0} * block_width;
  w.high = w.low + blocks * block_width;
  w.periodic = periodic;
  return w;
}

template <class Body>
void for_domains(const Body& body) {
  for (const Vec3i& size : {Vec3i{5, 4, 6}, Vec3i{3, 2, 1}, Vec3i{1, 3, 2}, Vec3i{2, 1, 3}})
    for (int p = 0; p < 8; ++p) body(domain(size, {(p & 1) != 0, (p & 2) != 0, (p & 4) != 0}), size);
}

TEST(Neighbors, AreThoseOfTheWrappedBlocks) {
  for_domains([](const World<float>& w, const Vec3i& size) {
    std::vector<Vec3i> some;
    for (int i = 0; i < size.x * size.y * size.z; ++i)
      if (uniform(9, static_cast<std::uint64_t>(i)) < 0.6)
        some.push_back(Vec3i{w.low.x / 4, w.low.y / 4, w.low.z / 4} +
                       Vec3i{i / (size.y * size.z), i / size.z % size.y, i % size.z});
    BlockList list;
    list.assign(some);
    for (const Vec3i& b : list.all()) {
      const Neighbors around = neighbors_in(list, w, b);
      for (int n = 0; n < 27; ++n)
        EXPECT_EQ(around[static_cast<std::size_t>(n)], list.find(w.wrapped(b + neighbor_offset(n))));
    }
  });
}

TEST(Neighbors, WhatParticlesReachAreWrappedBlocksToo) {
  for_domains([](const World<float>& w, const Vec3i& size) {
    BlockList list;
    list.assign(cloud(40, std::max({size.x, size.y, size.z}) + 1, {w.low.x / 4, w.low.y / 4, w.low.z / 4}, 11));
    for (const Vec3i& b : list.all()) {
      const StencilBlocks stencil_blocks = stencil_blocks_in(list, w, b);
      for (int i = 0, n = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          for (int k = 0; k < 2; ++k)
            EXPECT_EQ(stencil_blocks[static_cast<std::size_t>(n++)], list.find(w.wrapped(b + Vec3i{i, j, k})));
    }
  });
}

TEST(Neighbors, ASpreadIsTheUnionOfWhatBlocksReach) {
  HaloUnion spread;
  for_domains([&](const World<float>& w, const Vec3i& size) {
    for (const bool all : {false, true}) {
      std::vector<HaloMask> from;
      std::set<Key> expected;
      BlockList list;
      list.assign(cloud(12, std::min({size.x, size.y, size.z}) + 2, {w.low.x / 4, w.low.y / 4, w.low.z / 4}, 5));
      std::set<Key> inside;
      for (const Vec3i& b : list.all()) inside.insert(key(w.wrapped(b)));
      for (const auto& [x, y, z] : inside) {
        const double r = uniform(6, from.size());
        std::uint64_t around = 0;
        for (std::uint64_t bit = 0; bit < 64; ++bit) {
          const Vec3i offset = halo_offset(static_cast<int>(bit));
          if (!all && (r < 0.2 || uniform(7, 64 * from.size() + bit) > r)) continue;
          around |= halo_bit(offset);
          expected.insert(key(w.wrapped(Vec3i{x, y, z} + offset)));
        }
        from.push_back({{x, y, z}, around});
      }
      std::vector<Key> found;
      for (const Vec3i& b : spread(w, from)) found.push_back(key(b));
      EXPECT_EQ(found, std::vector<Key>(expected.begin(), expected.end()));
    }
  });
}

}  // namespace
}  // namespace dreampm::block_list_test
