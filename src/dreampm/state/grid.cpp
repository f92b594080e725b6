#include "dreampm/state/grid.h"

#include <algorithm>

#include "dreampm/base/narrow.h"

namespace dreampm {
namespace {

/// The first place in [begin, end) whose coordinate `at(place)` is not below `wanted`, or `end`;
/// coordinates rise.
template <class At>
std::uint32_t first_not_below(std::uint32_t begin, std::uint32_t end, std::int32_t wanted, const At& at) {
  if (begin == end || at(begin) >= wanted) return begin;
  // Each place is at least one coordinate on, so it is here if none is missing, else before.
  const auto ahead = static_cast<std::uint64_t>(std::int64_t(wanted) - at(begin));
  if (ahead < end - begin) {
    const auto last = static_cast<std::uint32_t>(begin + ahead);
    if (at(last) == wanted) return last;
    end = last;
  }
  while (begin < end) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    if (at(middle) < wanted)
      begin = middle + 1;
    else
      end = middle;
  }
  return begin;
}

}  // namespace

void BlockList::assign(std::vector<Vec3i> blocks) {
  std::sort(blocks.begin(), blocks.end(), block_less);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  blocks.shrink_to_fit();
  blocks_ = std::move(blocks);
  make_index();
}

void BlockList::exchange(std::vector<Vec3i>& blocks) {
  blocks_.swap(blocks);
  make_index();
}

void BlockList::make_index() {
  // Kernels number nodes in 32 bits.
  narrow<std::int32_t>(blocks_.size() * block_nodes, "nodes of the grid");
  planes_.clear();
  columns_.clear();
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const Vec3i& b = blocks_[i];
    const bool plane = i == 0 || blocks_[i - 1].x != b.x;
    if (plane) planes_.push_back({b.x, static_cast<std::uint32_t>(columns_.size())});
    if (plane || blocks_[i - 1].y != b.y) columns_.push_back({b.y, static_cast<std::uint32_t>(i)});
  }
  planes_.push_back({0, static_cast<std::uint32_t>(columns_.size())});
  columns_.push_back({0, static_cast<std::uint32_t>(blocks_.size())});
}

BlockList::Column BlockList::column(std::int32_t x, std::int32_t y) const {
  if (blocks_.empty()) return {0, 0};
  const auto planes = static_cast<std::uint32_t>(planes_.size() - 1);
  const std::uint32_t p = first_not_below(0, planes, x, [&](std::uint32_t i) { return planes_[i].at; });
  if (p == planes || planes_[p].at != x) return {0, 0};
  const std::uint32_t end = planes_[p + 1].begin;
  const std::uint32_t c = first_not_below(planes_[p].begin, end, y, [&](std::uint32_t i) { return columns_[i].at; });
  if (c == end || columns_[c].at != y) return {0, 0};
  return {columns_[c].begin, columns_[c + 1].begin};
}

std::int32_t BlockList::find(const Vec3i& block) const {
  const Column c = column(block.x, block.y);
  const std::uint32_t i = first_not_below(c.begin, c.end, block.z, [&](std::uint32_t at) { return blocks_[at].z; });
  return i < c.end && blocks_[i].z == block.z ? static_cast<std::int32_t>(i) : none;
}

std::array<std::int32_t, 3> BlockList::find_three(const Vec3i& first) const {
  const Column c = column(first.x, first.y);
  std::uint32_t i = first_not_below(c.begin, c.end, first.z, [&](std::uint32_t at) { return blocks_[at].z; });
  std::array<std::int32_t, 3> three;
  for (int k = 0; k < 3; ++k) {
    const bool there = i < c.end && blocks_[i].z == first.z + k;
    three[static_cast<std::size_t>(k)] = there ? static_cast<std::int32_t>(i++) : none;
  }
  return three;
}

std::size_t BlockList::first_from(const Vec3i& block) const {
  return static_cast<std::size_t>(std::lower_bound(blocks_.begin(), blocks_.end(), block, block_less) -
                                  blocks_.begin());
}

}  // namespace dreampm
