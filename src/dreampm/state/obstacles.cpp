#include "dreampm/state/obstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/state/collider_view.h"
#include "dreampm/state/neighbours.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

constexpr Node<float> far_away{0, 0, 0, static_cast<float>(ColliderContact::clearance_reach)};
/// Cells from the middle of a block: half its diagonal and the reach of a kernel.
constexpr double block_reach = 2.6 + 1.5;

/// Blocks count from here, so that a cache does not depend on where in space the scene lies.
template <class R>
Vec3i first_block(const World<R>& world) {
  return {world.low.x >> 2, world.low.y >> 2, world.low.z >> 2};
}

/// The distance from the nearest of several colliders at a block's nodes and those beside them.
class Distances {
 public:
  Distances() { d_.fill(ColliderContact::clearance_reach); }
  void add(const ColliderView& view, std::uint16_t collider) {
    for (int i = 0; i < width; ++i)
      for (int j = 0; j < width; ++j)
        for (int k = 0; k < width; ++k) {
          double& d = d_[static_cast<std::size_t>((i * width + j) * width + k)];
          d = std::max(-ColliderContact::clearance_reach,
                       std::min(d, view.exposed(collider, {i - 1.0, j - 1.0, k - 1.0}).distance));
        }
  }
  /// As in Obstacles::clearance. A quadratic spline of the distances themselves would be off by an
  /// eighth of their Laplacian: by 1/4 r cells on a sphere of r cells.
  Node<float> clearance(int n) const {
    const Vec3i at = node_offset(n);
    const int middle = ((at.x + 1) * width + at.y + 1) * width + at.z + 1, steps[3] = {width * width, width, 1};
    const auto d = [&](int i) { return d_[static_cast<std::size_t>(i)]; };
    Vec3d gradient;
    double laplacian = 0;
    for (int a = 0; a < 3; ++a) {
      const double before = d(middle - steps[a]), after = d(middle + steps[a]);
      gradient[a] = 0.5 * (after - before), laplacian += before - 2 * d(middle) + after;
    }
    return {static_cast<float>(gradient.x), static_cast<float>(gradient.y), static_cast<float>(gradient.z),
            static_cast<float>(d(middle) - laplacian / 8)};
  }

 private:
  static constexpr int width = block_width + 2;
  std::array<double, width * width * width> d_;
};

/// Whether the collider ends again less than `thickness` behind a place on its surface.
bool is_thin(const ColliderView& view, const Vec3d& at, const Vec3d& normal, double thickness) {
  constexpr int steps = 8;
  for (int k = 1; k <= steps; ++k)
    if (view.nearest(at - normal * (thickness * k / steps)) > 1e-6) return true;
  return false;
}

/// Whether a surface is no plane within a cell of a place on it: at edges, in corners, where it is
/// round and narrow.
bool is_bent(const ColliderView& view, const Vec3d& at, const Vec3d& normal) {
  const std::array<Vec3d, 8> ways = ways_along(normal);
  return std::any_of(ways.begin(), ways.end(), [&](const Vec3d& way) {
    return std::abs(view.nearest(at + way * ColliderContact::bend_reach)) > ColliderContact::bend;
  });
}

/// Whether splines between nodes do not resolve the solid behind the surface that is nearest to a
/// free place.
template <class R>
bool needs_distance(const World<R>& world, const ColliderView& view, const Vec3d& at) {
  const double distance = view.nearest(at);
  if (ColliderView::inside(distance) || distance > 1) return false;
  const std::uint16_t collider = view.nearest_collider(at);
  if (world.colliders[collider].holds) return false;
  const Vec3d normal = view.normal(collider, at), foot = at - normal * distance;
  return is_thin(view, foot, normal, ColliderContact::thin_wall) ||
         (is_thin(view, foot, normal, ColliderContact::thin_edge) && is_bent(view, foot, normal));
}

/// The cells of a block in which particles need their exact distance: those of free places that
/// need it, and all around them, for a particle just inside of a collider to be put back.
template <class R>
std::uint64_t thin_cells(const World<R>& world, const ColliderView& view) {
  // A particle is put back from half a cell before a surface at most, as far as it moves in a step.
  constexpr double near = 0.5 + 0.87;
  std::uint64_t cells = 0;
  // By cell, from one before the block's first on: not looked at yet, not needed, needed.
  constexpr int width = block_width + 2;
  std::array<std::int8_t, width * width * width> known{};
  const auto needed_at = [&](const Vec3i& cell) {
    std::int8_t& k = known[static_cast<std::size_t>(((cell.x + 1) * width + cell.y + 1) * width + cell.z + 1)];
    if (k == 0) k = needs_distance(world, view, static_cast<Vec3d>(cell) + Vec3d{0.5, 0.5, 0.5}) ? 2 : 1;
    return k == 2;
  };
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3i first = node_offset(n);
    if (std::abs(view.nearest(static_cast<Vec3d>(first) + Vec3d{0.5, 0.5, 0.5})) > near) continue;
    bool needed = false;
    for (int m = 0; m < 27 && !needed; ++m) needed = needed_at(first + neighbour_offset(m));
    cells |= static_cast<std::uint64_t>(needed) << n;
  }
  return cells;
}

}  // namespace

template <class R>
std::vector<std::uint16_t> Obstacles::near_moving(const World<R>& world, const Vec3i& block) const {
  // Blocks behind a wall see what is before it. The width of a block is more than they lie behind.
  const double reach = (block_reach + 2 * block_width) * world.dx;
  const Vec3d middle = world.node_position(block * block_width) + Vec3d{1.5, 1.5, 1.5} * world.dx;
  const auto is_near = [&](const PlacedCollider& c) {
    const Box3d bounds = c.collider.bounds();
    return std::any_of(c.shifts.begin(), c.shifts.end(), [&](const Vec3d& shift) {
      const Vec3d p = middle - shift;
      for (int a = 0; a < 3; ++a)
        if (p[a] < bounds.min[a] - reach || p[a] > bounds.max[a] + reach) return false;
      return true;
    });
  };
  if (std::none_of(placed_.begin(), placed_.end(),
                   [&](const PlacedCollider& c) { return c.collider.moves() && is_near(c); }))
    return {};
  std::vector<std::uint16_t> near = ColliderView(world, block, placed_, ColliderView::See::all).within(block_reach);
  std::erase_if(near, [&](std::uint16_t c) { return !placed_[c].collider.moves(); });
  return near;
}

bool Obstacles::is_current(const Near& near, const std::vector<std::uint16_t>& moving) const {
  return near.moving == moving &&
         std::none_of(moving.begin(), moving.end(), [&](std::uint16_t c) { return moved_[c]; });
}

template <class R>
void Obstacles::set_velocities(const World<R>& world, const Vec3i& block, Near& near) const {
  const ColliderView view(world, block, placed_, ColliderView::See::all);
  for (ObstacleNode& n : near.nodes)
    if (n.inside) n.velocity = view.velocity(n.collider, static_cast<Vec3d>(node_offset(n.node)));
  for (SurfacePoint& p : near.points) {
    p.velocity = static_cast<Vec3<float>>(view.velocity(p.collider, static_cast<Vec3d>(p.at)));
    p.spin = static_cast<Vec3<float>>(view.spin(p.collider));
    p.arm = view.arm(p.collider, static_cast<Vec3d>(p.at));
  }
}

template <class R>
void Obstacles::place_bodies(const World<R>& world) {
  body_points_.clear();
  for (std::size_t c = 0; c < placed_.size(); ++c) {
    const Collider& collider = placed_[c].collider;
    if (!collider.rigid) continue;
    if (bodies_[c].empty()) bodies_[c] = body_points(collider.shape, world.dx);
    const Pose& pose = collider.surface_pose;
    for (const Vec3d& shift : placed_[c].shifts)
      for (const BodyPoint& p : bodies_[c]) {
        const Vec3d at = static_cast<Vec3d>(world.low) + (pose(p.at) + shift - world.origin) * (1 / world.dx);
        Vec3i block;
        for (int a = 0; a < 3; ++a) block[a] = static_cast<int>(std::floor(at[a])) >> 2;
        body_points_.push_back({block,
                                body_points_.size(),
                                {at - static_cast<Vec3d>(block * block_width), pose.rotation(p.normal),
                                 pose.rotation(p.from_edge), p.area, static_cast<std::uint16_t>(c)}});
      }
  }
  std::sort(body_points_.begin(), body_points_.end(), [](const auto& a, const auto& b) {
    return a.block == b.block ? a.number < b.number : block_less(a.block, b.block);
  });
}

/// Null if no collider is near.
template <class R>
std::unique_ptr<Obstacles::Near> Obstacles::find(const World<R>& world, const Vec3i& block,
                                                 ColliderView::See see) const {
  const ColliderView view(world, block, placed_, see);
  const std::vector<std::uint16_t> colliders = view.within(block_reach);
  if (colliders.empty()) return nullptr;
  auto near = std::make_unique<Near>();
  Distances distances;
  for (const std::uint16_t c : colliders) {
    add_nodes(view, c, near->nodes);
    if (!world.colliders[c].holds) distances.add(view, c);
  }
  share_kernels(view, see == ColliderView::See::fixed ? Cubes::fixed : Cubes::moving, near->nodes);
  add_points(view, near->points);
  if (see == ColliderView::See::all) {
    const auto [begin, end] =
        std::equal_range(body_points_.begin(), body_points_.end(), PlacedPoint{block, 0, {}},
                         [](const auto& a, const auto& b) { return block_less(a.block, b.block); });
    for (auto p = begin; p != end; ++p)
      if (view.within_domain(p->patch.at) && view.is_exposed(p->patch.at, p->patch.normal))
        near->points.push_back(surface_point(view, p->patch));
  }
  if (const std::uint64_t cells = thin_cells(world, view)) near->thin = std::make_unique<const Thin>(Thin{view, cells});
  for (int n = 0; n < block_nodes; ++n) near->clearance[static_cast<std::size_t>(n)] = distances.clearance(n);
  return near;
}

template <class R>
void Obstacles::place(const World<R>& world) {
  const std::vector<Collider>& now = world.colliders;
  const bool same =
      std::equal(placed_.begin(), placed_.end(), now.begin(), now.end(),
                 [](const PlacedCollider& a, const Collider& b) { return a.collider.moves() == b.moves(); });
  if (!same) *this = {};
  placed_.resize(now.size());
  moved_.assign(now.size(), false);
  bodies_.resize(now.size());
  for (std::size_t c = 0; c < now.size(); ++c) {
    const Collider& known = placed_[c].collider;
    moved_[c] = known.shape != now[c].shape || !(known.surface_pose == now[c].surface_pose);
    if (known.shape != now[c].shape) bodies_[c].clear();
    if (moved_[c])
      placed_[c] = {now[c], periodic_copies(world, now[c])};
    else
      placed_[c].collider.twist = now[c].twist, placed_[c].collider.time = now[c].time;
  }
  any_ = !now.empty();
  any_move_ = std::any_of(now.begin(), now.end(), [](const Collider& c) { return c.moves(); });
}

template <class R>
void Obstacles::find_fixed(const World<R>& world) {
  const BlockList& grid = world.grid.blocks;
  fixed_before_.swap(fixed_);
  fixed_.assign(grid.size(), nullptr);
  // Most blocks were in the last grid too: both lists are in order.
  fresh_.clear();
  const Vec3i first = first_block(world);
  for (std::size_t b = 0, old = 0; b < grid.size(); ++b) {
    while (old < blocks_.size() && block_less(blocks_[old], grid[b] - first)) ++old;
    if (old < blocks_.size() && blocks_[old] == grid[b] - first) {
      fixed_[b] = fixed_before_[old];
      continue;
    }
    const auto known = fixed_cache_.find(grid[b] - first);
    if (known == fixed_cache_.end())
      fresh_.push_back(static_cast<std::uint32_t>(b));
    else
      fixed_[b] = known->second.get();
  }
  blocks_.clear();
  for (const Vec3i& b : grid.all()) blocks_.push_back(b - first);
  look_up(world, ColliderView::See::fixed, fixed_cache_, fixed_);
}

template <class R>
void Obstacles::find_moving(const World<R>& world) {
  const BlockList& grid = world.grid.blocks;
  std::vector<std::vector<std::uint16_t>> moving(grid.size());
  parallel_for(grid.size(), 32, [&](std::size_t b) { moving[b] = near_moving(world, grid[b]); });
  fresh_.clear();
  // Blocks that no collider that moves is near, or that are no longer in the grid, are forgotten.
  Cache kept;
  for (std::size_t b = 0; b < grid.size(); ++b) {
    if (moving[b].empty()) continue;
    const Vec3i key = grid[b] - first_block(world);
    const auto known = moving_cache_.find(key);
    if (known == moving_cache_.end() || !known->second || !is_current(*known->second, moving[b]))
      fresh_.push_back(static_cast<std::uint32_t>(b));
    else
      by_block_[b] = (kept[key] = std::move(known->second)).get();
  }
  moving_cache_.swap(kept);
  look_up(world, ColliderView::See::all, moving_cache_, by_block_);
  for (const std::uint32_t b : fresh_) moving_cache_.at(grid[b] - first_block(world))->moving = moving[b];
  parallel_for(grid.size(), 32, [&](std::size_t b) {
    if (!moving[b].empty()) set_velocities(world, grid[b], *moving_cache_.at(grid[b] - first_block(world)));
  });
}

template <class R>
void Obstacles::look_up(const World<R>& world, ColliderView::See see, Cache& cache,
                        std::vector<const Near*>& by_block) {
  if (fresh_.empty()) return;
  const BlockList& grid = world.grid.blocks;
  std::vector<std::unique_ptr<Near>> found(fresh_.size());
  parallel_for(fresh_.size(), 8, [&](std::size_t i) { found[i] = find(world, grid[fresh_[i]], see); });
  for (std::size_t i = 0; i < fresh_.size(); ++i) {
    auto& entry = cache[grid[fresh_[i]] - first_block(world)];
    entry = std::move(found[i]);
    by_block[fresh_[i]] = entry.get();
    any_thin_ = any_thin_ || (entry && entry->thin);
  }
}

template <class R>
void Obstacles::prepare(const World<R>& world) {
  place(world);
  const std::size_t blocks = world.grid.blocks.size();
  if (!any_) {
    by_block_.assign(blocks, nullptr);
    clearance_.clear();
    return;
  }
  find_fixed(world);
  by_block_ = fixed_;
  place_bodies(world);
  if (any_move_) find_moving(world);

  resize_for_overwrite(clearance_, blocks * block_nodes);
  parallel_for(blocks, 64, [&](std::size_t b) {
    Node<float>* const to = clearance_.data() + b * block_nodes;
    if (by_block_[b])
      std::copy_n(by_block_[b]->clearance.data(), block_nodes, to);
    else
      std::fill_n(to, block_nodes, far_away);
  });
}

template void Obstacles::prepare(const World<float>&);
template void Obstacles::prepare(const World<double>&);

}  // namespace dreampm
