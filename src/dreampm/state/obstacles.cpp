#include "dreampm/state/obstacles.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

template <class R>
void Obstacles::prepare(const World<R>& world) {
  any_ = !world.colliders.empty();
  by_block_.assign(world.grid.blocks.size(), &none_);
  if (!any_) return;
  for (std::size_t b = 0; b < world.grid.blocks.size(); ++b) {
    const Vec3i& block = world.grid.blocks[b];
    auto& entry = cache_[block - Vec3i{world.low.x >> 2, world.low.y >> 2, world.low.z >> 2}];
    if (!entry) {
      entry = std::make_unique<std::vector<ObstacleNode>>();
      for (std::size_t c = 0; c < world.colliders.size(); ++c) {
        const Region& shape = *world.colliders[c].shape;
        const auto at = [&](double i, double j, double k) {
          return world.origin +
                 Vec3d{block.x * 4 - world.low.x + i, block.y * 4 - world.low.y + j, block.z * 4 - world.low.z + k} *
                     world.dx;
        };
        // Half the diagonal of the block and the kernel's reach.
        const std::vector<Vec3d> shifts = copies(world, shape);
        if (shape.distance(seen_from(shape, shifts, at(1.5, 1.5, 1.5))) > (2.6 + 1.5) * world.dx) continue;
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k) {
              const Vec3d p = seen_from(shape, shifts, at(i, j, k));
              const double d = shape.distance(p) / world.dx;
              const double blocked = kernel_inside(d);
              if (blocked <= 0) continue;
              // Nodes a rounding error outside an aligned face belong to it.
              const bool inside = d <= 1e-6;
              entry->push_back({static_cast<std::uint8_t>(node_index(i, j, k)), static_cast<std::uint8_t>(c), inside,
                                static_cast<float>(blocked), inside ? shape.normal(p) : Vec3d{}});
            }
      }
    }
    by_block_[b] = entry.get();
  }
}

template void Obstacles::prepare(const World<float>&);
template void Obstacles::prepare(const World<double>&);

}  // namespace dreampm
