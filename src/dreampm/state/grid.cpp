#include "dreampm/state/grid.h"

#include <algorithm>
#include <tuple>

namespace dreampm {

void BlockList::assign(std::vector<Vec3i> blocks) {
  const auto less = [](const Vec3i& a, const Vec3i& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::sort(blocks.begin(), blocks.end(), less);
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  blocks_ = std::move(blocks);
  index_.clear();
  index_.reserve(blocks_.size());
  for (std::size_t i = 0; i < blocks_.size(); ++i) index_.emplace(blocks_[i], static_cast<std::int32_t>(i));
}

std::int32_t BlockList::find(const Vec3i& block) const {
  const auto it = index_.find(block);
  return it == index_.end() ? none : it->second;
}

}  // namespace dreampm
