#include "dreampm/state/obstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

// The part of a quadratic B-spline beyond distance d on its positive side: how much of a node's kernel lies inside a
// plane obstacle at signed distance d (cells).
double kernel_inside(double d) {
  if (d >= 1.5) return 0;
  if (d <= -1.5) return 1;
  if (d >= 0.5) return std::pow(1.5 - d, 3) / 6;
  if (d <= -0.5) return 1 - std::pow(1.5 + d, 3) / 6;
  return 0.5 - 0.75 * d + d * d * d / 3;
}

/// Where copies of a region lie on periodic axes, as shifts [m]; endless regions have none.
template <class R>
std::vector<Vec3d> copies(const World<R>& world, const Region& shape) {
  std::vector<Vec3d> shifts{{}};
  const Box3d bounds = shape.bounds();
  for (int a = 0; a < 3; ++a) {
    if (!world.periodic[static_cast<std::size_t>(a)] || !is_finite(bounds.min) || !is_finite(bounds.max)) continue;
    const double length = (world.high[a] - world.low[a]) * world.dx;
    for (std::size_t i = 0, n = shifts.size(); i < n; ++i)
      for (const double side : {-length, length}) {
        Vec3d s = shifts[i];
        s[a] = side;
        shifts.push_back(s);
      }
  }
  return shifts;
}

/// The point as the nearest copy of the region sees it.
Vec3d seen_from(const Region& shape, const std::vector<Vec3d>& shifts, const Vec3d& p) {
  Vec3d best = p;
  if (shifts.size() > 1)
    for (const Vec3d& s : shifts)
      if (shape.distance(p - s) < shape.distance(best)) best = p - s;
  return best;
}

/// The nodes of a block that colliders touch; `shifts` has the copies of each collider.
template <class R>
std::vector<ObstacleNode> touched(const World<R>& world, const Vec3i& block,
                                  const std::vector<std::vector<Vec3d>>& shifts) {
  std::vector<ObstacleNode> nodes;
  const auto at = [&](double i, double j, double k) {
    return world.origin +
           Vec3d{block.x * 4 - world.low.x + i, block.y * 4 - world.low.y + j, block.z * 4 - world.low.z + k} *
               world.dx;
  };
  for (std::size_t c = 0; c < world.colliders.size(); ++c) {
    const Region& shape = *world.colliders[c].shape;
    // Half the diagonal of the block and the kernel's reach.
    if (shape.distance(seen_from(shape, shifts[c], at(1.5, 1.5, 1.5))) > (2.6 + 1.5) * world.dx) continue;
    for (int n = 0; n < block_nodes; ++n) {
      const Vec3i offset = node_offset(n);
      const Vec3d p = seen_from(shape, shifts[c], at(offset.x, offset.y, offset.z));
      const double d = shape.distance(p) / world.dx;
      const double blocked = kernel_inside(d);
      if (blocked <= 0) continue;
      // Nodes a rounding error outside an aligned face belong to it.
      const bool inside = d <= 1e-6;
      nodes.push_back({static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(c), inside, static_cast<float>(blocked),
                       inside ? shape.normal(p) : Vec3d{}});
    }
  }
  return nodes;
}

}  // namespace

template <class R>
void Obstacles::prepare(const World<R>& world) {
  any_ = !world.colliders.empty();
  const BlockList& grid = world.grid.blocks;
  before_.swap(by_block_);
  by_block_.assign(grid.size(), nullptr);
  if (!any_) {
    blocks_.clear();
    return;
  }
  // Most blocks were in the last grid too: both lists are in order.
  fresh_.clear();
  const Vec3i first{world.low.x >> 2, world.low.y >> 2, world.low.z >> 2};
  for (std::size_t b = 0, old = 0; b < grid.size(); ++b) {
    while (old < blocks_.size() && before(blocks_[old], grid[b] - first)) ++old;
    if (old < blocks_.size() && blocks_[old] == grid[b] - first) {
      by_block_[b] = before_[old];
      continue;
    }
    const auto known = cache_.find(grid[b] - first);
    if (known == cache_.end())
      fresh_.push_back(static_cast<std::uint32_t>(b));
    else
      by_block_[b] = known->second.get();
  }
  blocks_.clear();
  for (const Vec3i& b : grid.all()) blocks_.push_back(b - first);
  if (fresh_.empty()) return;

  std::vector<std::vector<Vec3d>> shifts;
  for (const Collider& c : world.colliders) shifts.push_back(copies(world, *c.shape));
  std::vector<Nodes> found(fresh_.size());
  parallel_for(fresh_.size(), 8, [&](std::size_t i) { found[i] = touched(world, grid[fresh_[i]], shifts); });
  for (std::size_t i = 0; i < fresh_.size(); ++i) {
    auto& entry = cache_[grid[fresh_[i]] - first];
    if (!found[i].empty()) entry = std::make_unique<Nodes>(std::move(found[i]));
    by_block_[fresh_[i]] = entry.get();
  }
}

template void Obstacles::prepare(const World<float>&);
template void Obstacles::prepare(const World<double>&);

}  // namespace dreampm
