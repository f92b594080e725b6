// The setup of contact with colliders before a step: surface points, their nodes, and the
// velocities of colliders there.
#include <algorithm>
#include <cmath>
#include <variant>

#include "dreampm/backend/surface_contact.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

template <class R>
bool moves_any(const World<R>& world) {
  return std::any_of(world.colliders.begin(), world.colliders.end(), [](const Collider& c) { return !c.stands(); });
}

/// Returns for each collider true if it is a rigid ball that matter may slip along. Pressure goes
/// through its middle; that of nodes goes through the nodes, which would turn it.
template <class R>
std::vector<bool> free_balls(const World<R>& world) {
  std::vector<bool> balls(world.colliders.size());
  for (const RigidBody& body : world.rigid) {
    const CollisionShape& shape = world.collision.at(body.collider);
    balls[body.collider] = std::holds_alternative<SphereShape>(shape.shape.form) && !shape.mesh &&
                           world.colliders[body.collider].contact() != WallType::stick;
  }
  return balls;
}

/// The side of a block on which that node of the stencil of a point in it lies, as in Neighbors.
std::size_t side_of(const SurfacePoint& p, int node) {
  const int i = p.first[0] + node / 9, j = p.first[1] + node / 3 % 3, k = p.first[2] + node % 3;
  return static_cast<std::size_t>(((i >> 2) + 1) * 9 + ((j >> 2) + 1) * 3 + (k >> 2) + 1);
}

}  // namespace

template <class R>
void SurfaceContact<R>::prepare(const World<R>& world, const Obstacles& obstacles) {
  keep_points(world.grid.blocks);
  node_block_index_.clear(), body_points_.clear();
  if (world.colliders.empty() || !world.settings.surface_contact) {
    node_blocks_.clear(), points_.clear(), point_nodes_.clear(), in_stencil_.clear();
    return;
  }
  is_free_ball_ = free_balls(world);
  any_moves_ = moves_any(world);
  find_points(world, obstacles);
  find_node_blocks(world, obstacles);
  transpose(obstacles);
  set_all_velocities(world, obstacles);
  set_iterations();
}

template <class R>
void SurfaceContact<R>::find_points(const World<R>& world, const Obstacles& obstacles) {
  const std::size_t blocks = world.grid.blocks.size();
  point_block_index_.assign(blocks, -1);
  std::size_t count = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::vector<SurfacePoint>& surface = obstacles.points(b);
    if (surface.empty()) continue;
    point_block_index_[b] = static_cast<std::int32_t>(point_blocks_.size());
    point_blocks_.push_back({b, count, count + surface.size(), {}});
    count += surface.size();
  }
  points_.resize(count), acting_.resize(count);
  resize_for_overwrite(point_nodes_, stencil_nodes * count);
  resize_for_overwrite(in_stencil_, stencil_nodes * count);
  parallel_for(point_blocks_.size(), 8, [&](std::size_t b) { find_points(world, obstacles, point_blocks_[b]); });
  for (std::size_t p = 0; p < count && !world.rigid.empty(); ++p) {
    const auto body = std::find_if(world.rigid.begin(), world.rigid.end(),
                                   [&](const RigidBody& b) { return b.collider == points_[p].collider; });
    if (body == world.rigid.end()) continue;
    points_[p].lever = static_cast<std::int32_t>(body_points_.size());
    body_points_.push_back(
        {static_cast<std::uint32_t>(p), {static_cast<std::uint32_t>(body - world.rigid.begin()), {}, {}}});
  }
  parallel_for(point_blocks_.size(), 8, [&](std::size_t b) { find_edge_limiters(obstacles, point_blocks_[b]); });
  for (const ContactPoint& point : points_)
    if (point.edge_limiter >= 0) points_[static_cast<std::size_t>(point.edge_limiter)].limits = true;
}

template <class R>
void SurfaceContact<R>::find_node_blocks(const World<R>& world, const Obstacles& obstacles) {
  const std::size_t blocks = world.grid.blocks.size();
  node_block_index_.assign(blocks, -1);
  for (const PointBlock& point_block : point_blocks_)
    for (std::size_t side = 0; side < 27; ++side)
      if (point_block.entries[side] > 0) node_block_index_[static_cast<std::size_t>(point_block.around[side])] = 0;
  const auto is_held = [&](const ObstacleNode& o) {
    return o.inside && !o.deep && world.colliders[o.collider].contact() == WallType::stick;
  };
  const bool any_sticks = std::any_of(world.colliders.begin(), world.colliders.end(),
                                      [](const Collider& c) { return c.contact() == WallType::stick; });
  std::size_t count = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::vector<ObstacleNode>& near = obstacles.at(b);
    if (node_block_index_[b] < 0 && !(any_sticks && std::any_of(near.begin(), near.end(), is_held))) continue;
    node_block_index_[b] = static_cast<std::int32_t>(count++);
  }
  node_blocks_.resize(count);
  parallel_for(blocks, 16, [&](std::size_t b) {
    if (!changes(b)) return;
    NodeBlock& node_block = node_blocks_[static_cast<std::size_t>(node_block_index_[b])];
    const std::vector<ObstacleNode>& near = obstacles.at(b);
    node_block = {};
    node_block.block = b;
    node_block.open_fraction.fill(R(1));
    for (std::size_t number = 0; number < near.size(); ++number) {
      const ObstacleNode& o = near[number];
      node_block.open_fraction[o.node] = std::max(R(0), node_block.open_fraction[o.node] - static_cast<R>(o.blocked));
      if (!is_held(o)) continue;
      const Collider& collider = world.colliders[o.collider];
      if (node_block.sticking >> o.node & 1 && node_block.axis[o.node] == Vec3<R>{})
        continue;  // another collider holds it
      node_block.sticking |= std::uint64_t{1} << o.node;
      // Matter that is held does not move along the normal either.
      node_block.axis[o.node] = collider.holds ? Vec3<R>{} : static_cast<Vec3<R>>(o.normal);
      node_block.collider[o.node] = o.collider;
      node_block.held_by[o.node] = static_cast<std::uint16_t>(number);
    }
  });
}

/// A node block has the entries of one point block after those of another.
template <class R>
void SurfaceContact<R>::transpose(const Obstacles& obstacles) {
  resize_for_overwrite(runs_, 27 * node_blocks_.size());
  for (std::size_t b = 0; b < node_blocks_.size(); ++b) node_blocks_[b].runs_end = 27 * b;
  for (std::size_t b = 0; b < point_blocks_.size(); ++b)
    for (std::size_t side = 0; side < 27; ++side) {
      if (point_blocks_[b].entries[side] == 0) continue;
      NodeBlock& node_block = node_block_around(point_blocks_[b], side);
      runs_[node_block.runs_end++] = {node_block.end, node_block.end + point_blocks_[b].entries[side],
                                      static_cast<std::uint32_t>(b)};
      node_block.end += point_blocks_[b].entries[side];
    }
  std::size_t all = 0;
  for (std::size_t b = 0; b < node_blocks_.size(); ++b) {
    NodeBlock& node_block = node_blocks_[b];
    for (std::size_t r = 27 * b; r < node_block.runs_end; ++r) runs_[r].begin += all, runs_[r].end += all;
    node_block.begin = node_block.live_end = all;
    node_block.end = all += node_block.end;
  }
  resize_for_overwrite(node_points_, all);
  resize_for_overwrite(live_points_, all);
  resize_for_overwrite(live_nodes_, point_nodes_.size());
  resize_for_overwrite(transposed_, point_nodes_.size());
  resize_for_overwrite(impulse_changes_, points_.size());
  parallel_for(point_blocks_.size(), 8, [&](std::size_t b) {
    const PointBlock& point_block = point_blocks_[b];
    std::array<Run, 27> runs{};
    for (std::size_t side = 0; side < 27; ++side) {
      if (point_block.entries[side] == 0) continue;
      const NodeBlock& node_block = node_block_around(point_block, side);
      runs[side] = *std::find_if(runs_.begin() + (&node_block - node_blocks_.data()) * 27, runs_.end(),
                                 [&](const Run& run) { return run.point_block == b; });
    }
    std::array<std::size_t, 27> next{};
    for (std::size_t side = 0; side < 27; ++side) next[side] = runs[side].begin;
    const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
    for (std::size_t p = point_block.begin; p < point_block.end; ++p)
      for (std::size_t l = points_[p].begin; l < points_[p].end; ++l) {
        const std::size_t g = next[point_block.same_as[side_of(surface[p - point_block.begin], in_stencil_[l])]]++;
        node_points_[g] = {static_cast<std::uint32_t>(p),
                           static_cast<std::uint16_t>(point_nodes_[l].node % block_nodes), 1, point_nodes_[l].w};
        transposed_[l] = static_cast<std::uint32_t>(g);
      }
    for (const Run& run : runs)
      for (std::size_t g = run.end; g-- > run.begin + 1;)
        if (node_points_[g - 1].point == node_points_[g].point)
          node_points_[g - 1].rest = static_cast<std::uint16_t>(node_points_[g].rest + 1);
  });
}

template <class R>
bool SurfaceContact<R>::set_velocities(const World<R>& world, const Obstacles& obstacles) {
  if (any_moves_ != moves_any(world)) return false;
  set_all_velocities(world, obstacles);
  return true;
}

template <class R>
void SurfaceContact<R>::set_all_velocities(const World<R>& world, const Obstacles& obstacles) {
  for (NodeBlock& node_block : node_blocks_)
    if (node_block.sticking != 0) set_held_velocities(obstacles, node_block);
  resize_for_overwrite(point_node_velocity_, any_moves_ ? point_nodes_.size() : 0);
  resize_for_overwrite(node_point_velocity_, any_moves_ ? node_points_.size() : 0);
  resize_for_overwrite(point_node_arm_, world.rigid.empty() ? 0 : point_node_velocity_.size());
  for (NodeBlock& node_block : node_blocks_) {
    for (std::size_t n = 0; n < block_nodes && node_block.moves; ++n)
      if (!(node_block.sticking >> n & 1)) node_block.surface_velocity[n] = {};
    node_block.moves = false;
  }
  if (!any_moves_) return;
  parallel_for(point_blocks_.size(), 8,
               [&](std::size_t b) { set_point_velocities(world, obstacles, point_blocks_[b]); });
  for (const PointBlock& point_block : point_blocks_)
    if (!point_block.rests) for_node_blocks_around(point_block, [](NodeBlock& node_block) { node_block.moves = true; });
}

template <class R>
void SurfaceContact<R>::set_held_velocities(const Obstacles& obstacles, NodeBlock& node_block) {
  const std::vector<ObstacleNode>& near = obstacles.at(node_block.block);
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (node_block.sticking >> n & 1)
      node_block.surface_velocity[n] = static_cast<Vec3<R>>(near[node_block.held_by[n]].velocity);
}

template <class R>
void SurfaceContact<R>::set_point_velocities(const World<R>& world, const Obstacles& obstacles,
                                             PointBlock& point_block) {
  const bool rests = std::all_of(points_.begin() + static_cast<std::ptrdiff_t>(point_block.begin),
                                 points_.begin() + static_cast<std::ptrdiff_t>(point_block.end),
                                 [&](const ContactPoint& p) { return world.colliders[p.collider].stands(); });
  if (rests && point_block.rests) return;
  point_block.rests = rests;
  const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
  for (std::size_t s = 0; s < surface.size(); ++s) {
    const SurfacePoint& p = surface[s];
    const ContactPoint& point = points_[point_block.begin + s];
    const auto at = static_cast<Vec3d>(p.at), velocity = static_cast<Vec3d>(p.velocity),
               spin = static_cast<Vec3d>(p.spin);
    for (std::size_t l = point.begin; l < point.end; ++l) {
      const int m = in_stencil_[l];
      const Vec3i node{p.first[0] + m / 9, p.first[1] + m / 3 % 3, p.first[2] + m % 3};
      const Vec3d off = (static_cast<Vec3d>(node) - at) * world.dx;
      if (!point_node_arm_.empty()) point_node_arm_[l] = static_cast<Vec3<R>>(static_cast<Vec3d>(p.arm) + off);
      point_node_velocity_[l] = static_cast<Vec3<R>>(velocity + cross(spin, off));
      node_point_velocity_[transposed_[l]] = point_node_velocity_[l];
    }
  }
}

template <class R>
template <class Body>
void SurfaceContact<R>::for_node_blocks_around(const PointBlock& point_block, const Body& body) {
  for (const std::int32_t block : point_block.around)
    if (block != BlockList::none && changes(static_cast<std::size_t>(block)))
      body(node_blocks_[static_cast<std::size_t>(node_block_index_[static_cast<std::size_t>(block)])]);
}

template <class R>
void SurfaceContact<R>::set_iterations() {
  if (body_points_.empty()) return;
  std::vector<bool> beside_body(node_block_index_.size());
  for (const PointBlock& point_block : point_blocks_)
    if (std::any_of(points_.begin() + static_cast<std::ptrdiff_t>(point_block.begin),
                    points_.begin() + static_cast<std::ptrdiff_t>(point_block.end),
                    [](const ContactPoint& p) { return p.lever >= 0; }))
      for (const std::int32_t block : point_block.around)
        if (block != BlockList::none) beside_body[static_cast<std::size_t>(block)] = true;
  for (PointBlock& point_block : point_blocks_) {
    if (!beside_body[point_block.block]) continue;
    point_block.iterations = ColliderContact::body_iterations;
    for_node_blocks_around(point_block,
                           [](NodeBlock& node_block) { node_block.iterations = ColliderContact::body_iterations; });
  }
}

template <class R>
void SurfaceContact<R>::keep_points(const BlockList& grid) {
  before_.of_block.swap(point_block_index_);
  before_.blocks.swap(point_blocks_), before_.points.swap(points_);
  before_.nodes.swap(point_nodes_), before_.in_stencil.swap(in_stencil_);
  point_blocks_.clear(), point_block_index_.clear();  // the others are overwritten
  if (before_.grid == grid.all()) return;
  before_.of_block.clear();
  before_.grid = grid.all();
}

template <class R>
void SurfaceContact<R>::find_points(const World<R>& world, const Obstacles& obstacles, PointBlock& point_block) {
  const std::int32_t old = before_.of_block.empty() ? -1 : before_.of_block[point_block.block];
  const PointBlock* const known = old < 0 ? nullptr : &before_.blocks[static_cast<std::size_t>(old)];
  point_block.number = obstacles.number(point_block.block);
  if (known && known->number == point_block.number)
    take_points(*known, point_block);
  else
    find_points(world, obstacles.points(point_block.block), point_block);
}

template <class R>
void SurfaceContact<R>::take_points(const PointBlock& known, PointBlock& point_block) {
  point_block.around = known.around, point_block.same_as = known.same_as, point_block.entries = known.entries;
  for (std::size_t p = point_block.begin, q = known.begin; p < point_block.end; ++p, ++q) {
    const ContactPoint& point = before_.points[q];
    const std::size_t begin = stencil_nodes * p, count = point.end - point.begin;
    points_[p] = {point.normal, point.area, point.collider, begin, begin + count, point.from_edge};
    acting_[p] = {point.normal, point.area, R(0), point.collider};
    std::copy_n(before_.nodes.data() + point.begin, count, point_nodes_.data() + begin);
    std::copy_n(before_.in_stencil.data() + point.begin, count, in_stencil_.data() + begin);
  }
}

template <class R>
void SurfaceContact<R>::find_points(const World<R>& world, const std::vector<SurfacePoint>& surface,
                                    PointBlock& point_block) {
  point_block.around = neighbors_in(world.grid.blocks, world, world.grid.blocks[point_block.block]);
  const Neighbors& around = point_block.around;
  for (std::size_t side = 0; side < 27; ++side)
    point_block.same_as[side] =
        static_cast<std::uint8_t>(std::find(around.begin(), around.end(), around[side]) - around.begin());
  for (std::size_t s = 0; s < surface.size(); ++s) {
    const SurfacePoint& p = surface[s];
    std::array<Weights1<R>, 3> weights;
    for (std::size_t a = 0; a < 3; ++a)
      weights[a] = bspline2(static_cast<R>(p.at[static_cast<int>(a)]) - static_cast<R>(p.first[a] + 1));
    const std::size_t begin = stencil_nodes * (point_block.begin + s);
    std::size_t end = begin;
    for (int m = 0; m < 27; ++m) {
      const R w = weights[0].w[m / 9] * weights[1].w[m / 3 % 3] * weights[2].w[m % 3];
      const int i = p.first[0] + m / 9, j = p.first[1] + m / 3 % 3, k = p.first[2] + m % 3;
      const std::size_t side = side_of(p, m);
      if (p.deep >> m & 1 || !(w > R(0)) || around[side] == BlockList::none) continue;
      point_nodes_[end] = {static_cast<std::uint32_t>(around[side] * block_nodes + node_index(i & 3, j & 3, k & 3)), w};
      in_stencil_[end++] = static_cast<std::uint8_t>(m);
      ++point_block.entries[point_block.same_as[side]];
    }
    points_[point_block.begin + s] = {static_cast<Vec3<R>>(p.normal),   static_cast<R>(p.area), p.collider, begin, end,
                                      static_cast<Vec3<R>>(p.from_edge)};
    acting_[point_block.begin + s] = {static_cast<Vec3<R>>(p.normal), static_cast<R>(p.area), R(0), p.collider};
  }
}

/// The edge limiter of a point: the nearest point to the place one cell away from the edge, on the
/// same face.
template <class R>
void SurfaceContact<R>::find_edge_limiters(const Obstacles& obstacles, const PointBlock& point_block) {
  const std::vector<SurfacePoint>& own = obstacles.points(point_block.block);
  if (std::none_of(own.begin(), own.end(), [](const SurfacePoint& p) { return dot(p.from_edge, p.from_edge) > 0; }))
    return;
  std::vector<float> nearest(own.size(), static_cast<float>(ColliderContact::limiter_reach2));  // squared, cells
  for (int n = 0; n < 27; ++n) {
    const std::int32_t holder = point_block.around[static_cast<std::size_t>(n)];
    if (holder == BlockList::none || point_block_index_[static_cast<std::size_t>(holder)] < 0) continue;
    const PointBlock* const there =
        &point_blocks_[static_cast<std::size_t>(point_block_index_[static_cast<std::size_t>(holder)])];
    const std::vector<SurfacePoint>& others = obstacles.points(there->block);
    const auto shift = static_cast<Vec3<float>>(neighbor_offset(n) * block_width);
    for (std::size_t p = 0; p < own.size(); ++p) {
      const SurfacePoint& point = own[p];
      if (!(dot(point.from_edge, point.from_edge) > 0)) continue;
      for (std::size_t o = 0; o < others.size(); ++o) {
        const Vec3<float> off = others[o].at + shift - point.at - point.from_edge;
        if (!(dot(off, off) < nearest[p]) || others[o].collider != point.collider ||
            dot(others[o].normal, point.normal) < static_cast<float>(ColliderContact::same_face) ||
            dot(others[o].from_edge, point.from_edge) < 0)
          continue;
        nearest[p] = dot(off, off);
        points_[point_block.begin + p].edge_limiter = static_cast<std::int32_t>(there->begin + o);
      }
    }
  }
}

#define DM_INSTANTIATE(R)                                                      \
  template void SurfaceContact<R>::prepare(const World<R>&, const Obstacles&); \
  template bool SurfaceContact<R>::set_velocities(const World<R>&, const Obstacles&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
