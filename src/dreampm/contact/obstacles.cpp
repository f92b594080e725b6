#include "dreampm/contact/obstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/contact/collider_view.h"
#include "dreampm/contact/thin_places.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// Cells from the middle of a block: half its diagonal and the reach of a kernel.
constexpr double block_reach = 2.6 + 1.5;

/// Blocks count from here, so that a cache does not depend on where in space the scene lies.
template <class R>
Vec3i first_block(const World<R>& world) {
  return {world.low.x >> 2, world.low.y >> 2, world.low.z >> 2};
}

/// True if less than a cell may lie between a collider and a periodic copy of it.
bool may_meet_copy(const PlacedCollider& c, double dx) {
  const Vec3d room = c.collider.bounds().size() + Vec3d{dx, dx, dx};
  return std::any_of(c.shifts.begin() + 1, c.shifts.end(), [&](const Vec3d& shift) {
    const Vec3d apart = shift - c.shifts.front();
    return std::abs(apart.x) < room.x && std::abs(apart.y) < room.y && std::abs(apart.z) < room.z;
  });
}

}  // namespace

template <class R>
std::vector<std::uint16_t> Obstacles::near_moving(const World<R>& world, const Vec3i& block, ColliderView::See see,
                                                  const std::vector<Box3d>& bounds) const {
  const auto is_meant = [&](std::size_t c) {
    const Collider& collider = placed_[c].collider;
    return see == ColliderView::See::all ? collider.rigid : collider.moves() && !collider.rigid;
  };
  // Blocks behind a wall see what is before it. The width of a block is more than they lie behind.
  const double reach = (block_reach + 2 * block_width) * world.dx;
  const Vec3d middle = world.node_position(block * block_width) + Vec3d{1.5, 1.5, 1.5} * world.dx;
  bool any_near = false;
  for (std::size_t c = 0; c < placed_.size() && !any_near; ++c) {
    if (!is_meant(c)) continue;
    const std::vector<Vec3d>& shifts = placed_[c].shifts;
    any_near = std::any_of(shifts.begin(), shifts.end(), [&](const Vec3d& shift) {
      const Vec3d p = middle - shift;
      for (int a = 0; a < 3; ++a)
        if (p[a] < bounds[c].min[a] - reach || p[a] > bounds[c].max[a] + reach) return false;
      return true;
    });
  }
  if (!any_near) return {};
  const ColliderView view(world, block, placed_, ColliderView::SinglesOnly{});
  std::vector<std::uint16_t> near;
  for (std::size_t c = 0; c < placed_.size(); ++c)
    if (is_meant(c) && view.is_within(static_cast<std::uint16_t>(c), block_reach))
      near.push_back(static_cast<std::uint16_t>(c));
  return near;
}

bool Obstacles::is_current(const Near& near, const std::vector<std::uint16_t>& moving, const Near* base) const {
  return near.moving == moving && near.base == (base ? base->number : 0) &&
         std::none_of(moving.begin(), moving.end(), [&](std::uint16_t c) { return moved_[c]; });
}

template <class R>
void Obstacles::set_velocities(const World<R>& world, const Vec3i& block, Near& near) const {
  const ColliderView view(world, block, placed_, ColliderView::SinglesOnly{});
  for (ObstacleNode& n : near.nodes)
    if (n.inside) n.velocity = view.velocity(n.collider, static_cast<Vec3d>(node_offset(n.node)));
  for (SurfacePoint& p : near.points) {
    p.velocity = static_cast<Vec3<float>>(view.velocity(p.collider, static_cast<Vec3d>(p.at)));
    p.spin = static_cast<Vec3<float>>(view.spin(p.collider));
    p.arm = view.arm(p.collider, static_cast<Vec3d>(p.at));
  }
}

template <class R>
void Obstacles::set_velocities(const World<R>& world) const {
  parallel_for(beside_moving_.size(), 8, [&](std::size_t i) {
    const auto& [block, near] = beside_moving_[i];
    set_velocities(world, world.grid.blocks[block], *near);
  });
}

template <class R>
bool Obstacles::is_as_before(const World<R>& world) const {
  const BlockList& grid = world.grid.blocks;
  return std::find(moved_.begin(), moved_.end(), true) == moved_.end() &&
         std::equal(
             blocks_.begin(), blocks_.end(), grid.all().begin(), grid.all().end(),
             [first = first_block(world)](const Vec3i& known, const Vec3i& now) { return known == now - first; });
}

template <class R>
void Obstacles::place_bodies(const World<R>& world) {
  body_points_.clear();
  for (std::size_t c = 0; c < placed_.size(); ++c) {
    const Collider& collider = placed_[c].collider;
    if (!collider.rigid) continue;
    if (!bodies_[c])
      bodies_[c] = std::make_shared<const Body>(
          Body{body_points(collider.shape, world.dx), BodyKernel(collider.shape, world.dx)});
    const Pose& pose = collider.surface_pose;
    for (const Vec3d& shift : placed_[c].shifts)
      for (const BodyPoint& p : bodies_[c]->points) {
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

void Obstacles::add_body_points(ExposedNodes& exposed, const Vec3i& block, std::vector<SurfacePoint>& points) const {
  const ColliderView& view = exposed.view();
  const auto [begin, end] = std::equal_range(body_points_.begin(), body_points_.end(), PlacedPoint{block, 0, {}},
                                             [](const auto& a, const auto& b) { return block_less(a.block, b.block); });
  for (auto p = begin; p != end; ++p)
    if (view.within_domain(p->patch.at) && view.is_exposed(p->patch.at, p->patch.normal))
      points.push_back(surface_point(exposed, p->patch));
}

/// Null if no collider is near.
template <class R>
std::unique_ptr<Obstacles::Near> Obstacles::find(const World<R>& world, const Vec3i& block,
                                                 ColliderView::See see) const {
  const ColliderView view(world, block, placed_, see);
  const std::vector<std::uint16_t> colliders = view.within(block_reach);
  if (colliders.empty()) return nullptr;
  auto near = std::make_unique<Near>();
  ExposedNodes exposed(view);
  BlockDistances distances;
  for (const std::uint16_t c : colliders) {
    add_nodes(exposed, c, near->nodes);
    if (!view.holds_matter(c)) distances.add_exposed(exposed, c);
  }
  share_kernels(view, see == ColliderView::See::fixed ? Cubes::fixed : Cubes::moving, near->nodes);
  add_points(exposed, near->points);
  if (const std::uint64_t cells = thin_cells(view))
    near->thin = std::make_unique<const Thin>(Thin{view.for_later(), cells});
  for (int n = 0; n < block_nodes; ++n) near->clearance[static_cast<std::size_t>(n)] = distances.clearance(n);
  if (any_rigid_) near->distances = std::make_unique<const BlockDistances>(distances);
  return near;
}

template <class R>
std::unique_ptr<Obstacles::Near> Obstacles::find_beside(const World<R>& world, const Vec3i& block, const Near* base,
                                                        const std::vector<std::uint16_t>& bodies) const {
  const ColliderView view(world, block, placed_, ColliderView::See::all);
  ExposedNodes exposed(view);
  auto near = std::make_unique<Near>();
  BlockDistances distances;
  std::uint64_t thin = 0;
  if (base) {
    near->base = base->number, near->nodes = base->nodes, near->points = base->points;
    distances = *base->distances;
    if (base->thin) thin = base->thin->cells;
  }
  std::vector<BlockDistances> own(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) own[i].add_whole(exposed, bodies[i]);
  bool any_touch = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    BlockDistances others = base ? *base->distances : BlockDistances{};
    for (std::size_t j = 0; j < bodies.size(); ++j)
      if (j != i) others.add(own[j]);
    const bool touches = meets_copy_[bodies[i]] || !own[i].is_apart_from(others) || !own[i].is_apart_from_walls(view);
    any_touch = any_touch || touches;
    BlockDistances open = own[i];
    if (touches) {
      // A face of the body that something hides is no surface. The face that hides it may stay one:
      // no matter is before it.
      open = {};
      open.add_exposed(exposed, bodies[i]);
    }
    distances.add(open);
    const BodyKernel& kernel = bodies_[bodies[i]]->kernel;
    add_body_nodes(exposed, bodies[i], open, kernel, near->nodes);
    thin |= thin_cells(view, bodies[i], kernel);
  }
  std::sort(near->nodes.begin(), near->nodes.end(), in_order);
  if (any_touch)
    std::erase_if(near->points, [&](const SurfacePoint& p) {
      return !view.is_exposed(static_cast<Vec3d>(p.at), static_cast<Vec3d>(p.normal));
    });
  add_body_points(exposed, block, near->points);
  if (thin != 0) near->thin = std::make_unique<const Thin>(Thin{view.for_later(), thin});
  for (int n = 0; n < block_nodes; ++n) near->clearance[static_cast<std::size_t>(n)] = distances.clearance(n);
  return near;
}

bool Obstacles::still_fixed(const std::vector<Collider>& now) const {
  const auto is_rigid = [](const Collider& c) { return c.rigid; };
  if (!any_rigid_ && std::any_of(now.begin(), now.end(), is_rigid)) return false;  // no distances are kept for them
  for (std::size_t c = 0; c < std::max(now.size(), placed_.size()); ++c) {
    const bool was = c < placed_.size() && !placed_[c].collider.moves(), is = c < now.size() && !now[c].moves();
    if (was != is) return false;
    if (is && (placed_[c].collider.shape != now[c].shape || !(placed_[c].collider.surface_pose == now[c].surface_pose)))
      return false;
  }
  return true;
}

template <class R>
void Obstacles::place(const World<R>& world) {
  const std::vector<Collider>& now = world.colliders;
  const bool same = std::equal(placed_.begin(), placed_.end(), now.begin(), now.end(),
                               [](const PlacedCollider& a, const Collider& b) {
                                 return a.collider.moves() == b.moves() && a.collider.rigid == b.rigid;
                               });
  if (!same) {
    // Tables of bodies that were there before are kept: they cost more than all else.
    std::vector<std::shared_ptr<const Body>> bodies(now.size());
    for (std::size_t c = 0; c < now.size(); ++c)
      for (std::size_t old = 0; old < placed_.size() && !bodies[c]; ++old)
        if (now[c].rigid && placed_[old].collider.shape == now[c].shape) bodies[c] = bodies_[old];
    if (still_fixed(now)) {
      Cache cache = std::move(fixed_cache_);
      std::vector<Vec3i> blocks = std::move(blocks_);
      std::vector<const Near*> fixed = std::move(fixed_);
      const bool any_thin = any_thin_;
      forget();
      fixed_cache_ = std::move(cache), blocks_ = std::move(blocks), fixed_ = std::move(fixed), any_thin_ = any_thin;
    } else {
      forget();
    }
    bodies_.swap(bodies);
  }
  placed_.resize(now.size());
  moved_.assign(now.size(), false);
  meets_copy_.resize(now.size());
  bodies_.resize(now.size());
  for (std::size_t c = 0; c < now.size(); ++c) {
    const Collider& known = placed_[c].collider;
    moved_[c] = known.shape != now[c].shape || !(known.surface_pose == now[c].surface_pose);
    if (same && known.shape != now[c].shape) bodies_[c].reset();
    if (moved_[c]) {
      placed_[c] = {now[c], periodic_copies(world, now[c])};
      meets_copy_[c] = may_meet_copy(placed_[c], world.dx);
    } else
      placed_[c].collider.twist = now[c].twist, placed_[c].collider.time = now[c].time;
  }
  any_ = !now.empty();
  any_rigid_ = std::any_of(now.begin(), now.end(), [](const Collider& c) { return c.rigid; });
  any_driven_ = std::any_of(now.begin(), now.end(), [](const Collider& c) { return c.moves() && !c.rigid; });
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
  look_up(world, fixed_cache_, fixed_, [&](std::size_t b) { return find(world, grid[b], ColliderView::See::fixed); });
}

template <class R>
void Obstacles::find_moving(const World<R>& world, ColliderView::See see, Cache& cache) {
  const BlockList& grid = world.grid.blocks;
  std::vector<std::vector<std::uint16_t>> moving(grid.size());
  std::vector<Box3d> bounds;
  for (const PlacedCollider& c : placed_) bounds.push_back(c.collider.bounds());
  parallel_for(grid.size(), 32, [&](std::size_t b) { moving[b] = near_moving(world, grid[b], see, bounds); });
  fresh_.clear();
  // Blocks that none of them is near, or that are no longer in the grid, are forgotten.
  Cache kept;
  for (std::size_t b = 0; b < grid.size(); ++b) {
    if (moving[b].empty()) continue;
    const Vec3i key = grid[b] - first_block(world);
    const auto known = cache.find(key);
    if (known == cache.end() || !known->second ||
        !is_current(*known->second, moving[b], see == ColliderView::See::all ? by_block_[b] : nullptr))
      fresh_.push_back(static_cast<std::uint32_t>(b));
    else
      by_block_[b] = (kept[key] = std::move(known->second)).get();
  }
  cache.swap(kept);
  look_up(world, cache, by_block_, [&](std::size_t b) {
    return see == ColliderView::See::all ? find_beside(world, grid[b], by_block_[b], moving[b])
                                         : find(world, grid[b], see);
  });
  for (const std::uint32_t b : fresh_) cache.at(grid[b] - first_block(world))->moving = moving[b];
  for (std::size_t b = 0; b < grid.size(); ++b)
    if (!moving[b].empty())
      beside_moving_.emplace_back(static_cast<std::uint32_t>(b), cache.at(grid[b] - first_block(world)).get());
}

template <class R, class Find>
void Obstacles::look_up(const World<R>& world, Cache& cache, std::vector<const Near*>& by_block, const Find& find_one) {
  if (fresh_.empty()) return;
  const BlockList& grid = world.grid.blocks;
  std::vector<std::unique_ptr<Near>> found(fresh_.size());
  parallel_for(fresh_.size(), 8, [&](std::size_t i) { found[i] = find_one(fresh_[i]); });
  for (std::size_t i = 0; i < fresh_.size(); ++i) {
    auto& entry = cache[grid[fresh_[i]] - first_block(world)];
    entry = std::move(found[i]);
    if (entry) entry->number = ++numbers_;
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
    changed_ = true;
    return;
  }
  changed_ = !is_as_before(world);
  if (!changed_) return set_velocities(world);
  find_fixed(world);
  by_block_ = fixed_;
  beside_moving_.clear();
  place_bodies(world);
  if (any_driven_) find_moving(world, ColliderView::See::driven, driven_cache_);
  if (any_rigid_) find_moving(world, ColliderView::See::all, body_cache_);
  set_velocities(world);

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
