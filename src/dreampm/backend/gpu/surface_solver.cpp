#include "dreampm/backend/gpu/surface_solver.h"

#include <algorithm>

namespace dreampm::gpu {

SurfaceSolver::SurfaceSolver(Device& device)
    : device_(&device),
      points_(device),
      blocks_(device),
      node_blocks_(device),
      first_(device),
      first_group_(device),
      nodes_(device),
      points_of_(device),
      colliders_(device),
      groups_(device),
      ranges_(device),
      point_states_(device),
      changes_(device),
      velocity_weights_(device),
      inverse_masses_(device),
      node_states_(device),
      fastest2_(device),
      given_(device) {}

void SurfaceSolver::prepare(const World<float>& world, const Obstacles& obstacles, const SurfaceContact<float>& host,
                            const ContactGaps& gaps) {
  const SurfaceContact<float> nothing;
  const SurfaceContact<float>& from = takes(world) ? host : nothing;
  find_points(obstacles, from, gaps);
  find_nodes(from);
  find_groups(world.colliders.size(), from);
  std::vector<CollidingMatter> colliders;
  for (const Collider& c : world.colliders)
    colliders.push_back({c.contact(), !c.holds, static_cast<float>(c.friction), c.sticky});
  colliders_.upload(colliders);
  fastest2_.resize(1);
  set_velocities(obstacles, from);
}

void SurfaceSolver::set_velocities(const Obstacles& obstacles, const SurfaceContact<float>& host) {
  if (node_blocks_.size() == 0) return;
  moves_ = host.moves();
  for (const auto& point_block : host.point_blocks()) {
    const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
    for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
      points_home_[p].velocity = surface[p - point_block.begin].velocity;
      points_home_[p].spin = surface[p - point_block.begin].spin;
    }
  }
  std::size_t first = 0;
  for (const auto& node_block : host.node_blocks()) {
    const std::vector<ObstacleNode>& near = obstacles.at(node_block.block);
    for (std::size_t n = 0; n < block_nodes; ++n)
      if (nodes_home_[first + n].sticks)
        nodes_home_[first + n].velocity = static_cast<Vec3<float>>(near[node_block.held_by[n]].velocity);
    first += block_nodes;
  }
  points_.upload(points_home_), nodes_.upload(nodes_home_);
}

void SurfaceSolver::find_points(const Obstacles& obstacles, const SurfaceContact<float>& host,
                                const ContactGaps& gaps) {
  points_home_.resize(host.points().size());
  std::vector<PointBlock> blocks;
  for (const auto& point_block : host.point_blocks()) {
    const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
    for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
      const SurfacePoint& from = surface[p - point_block.begin];
      const auto& known = host.points()[p];
      ContactPoint& to = points_home_[p];
      to = {from.at,
            from.normal,
            from.from_edge,
            from.velocity,
            from.spin,
            from.area,
            static_cast<std::uint32_t>(blocks.size()),
            from.deep,
            known.edge_limiter,
            {},
            known.limits,
            from.collider};
      std::copy(from.first.begin(), from.first.end(), to.first);
    }
    PointBlock& block = blocks.emplace_back();
    for (std::size_t n = 0; n < 27; ++n) {
      const std::int32_t around = point_block.around[n];
      block.nodes[n] = around == BlockList::none ? -1 : host.node_block_of_block(static_cast<std::size_t>(around));
      block.gaps[n] =
          around == BlockList::none || gaps.gaps_of().empty() ? -1 : gaps.gaps_of()[static_cast<std::size_t>(around)];
    }
  }
  blocks_.upload(blocks);
  const std::size_t count = points_home_.size();
  point_states_.resize(count), changes_.resize(count), velocity_weights_.resize(27 * count);
}

void SurfaceSolver::find_nodes(const SurfaceContact<float>& host) {
  const auto& of = host.node_blocks();
  const std::size_t count = of.size() * block_nodes;
  std::vector<std::uint32_t> blocks;
  nodes_home_.resize(count);
  for (const auto& node_block : of) {
    const std::size_t first = blocks.size() * block_nodes;
    blocks.push_back(static_cast<std::uint32_t>(node_block.block));
    for (std::size_t n = 0; n < block_nodes; ++n) {
      const bool sticks = (node_block.sticking >> n & 1) != 0;
      const Vec3<float> none{}, axis = sticks ? node_block.axis[n] : none;
      nodes_home_[first + n] = {node_block.open_fraction[n], sticks, node_block.collider[n], axis, none};
    }
  }
  // The points at each node, in the order of the points.
  std::vector<std::uint32_t> first(count + 1, 0);
  const auto each = [&](auto&& body) {
    for (std::size_t p = 0; p < host.points().size(); ++p)
      for (std::size_t l = host.points()[p].begin; l < host.points()[p].end; ++l) {
        const std::uint32_t node = host.point_nodes()[l].node;
        const std::int32_t holder = host.node_block_of_block(node / block_nodes);
        body(p, l, static_cast<std::size_t>(holder) * block_nodes + node % block_nodes);
      }
  };
  each([&](std::size_t, std::size_t, std::size_t node) { ++first[node + 1]; });
  for (std::size_t n = 0; n < count; ++n) first[n + 1] += first[n];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<PointOfNode> points_of(first.back());
  each([&](std::size_t p, std::size_t l, std::size_t node) {
    points_of[next[node]++] = {static_cast<std::uint32_t>(p), host.in_stencil()[l]};
  });
  node_blocks_.upload(blocks), first_.upload(first), points_of_.upload(points_of);
  inverse_masses_.resize(points_of.size()), node_states_.resize(count);
}

/// The colliders from which a block of nodes may receive: those of its points, and those that its
/// nodes stick to. Entries of one collider lie together.
void SurfaceSolver::find_groups(std::size_t colliders, const SurfaceContact<float>& host) {
  std::vector<std::vector<std::int32_t>> of_block(host.node_blocks().size());
  const auto add = [&](std::size_t block, std::uint16_t collider) {
    auto& all = of_block[block];
    if (std::find(all.begin(), all.end(), collider) == all.end()) all.push_back(collider);
  };
  for (std::size_t b = 0; b < of_block.size(); ++b) {
    const auto& node_block = host.node_blocks()[b];
    for (std::size_t n = 0; n < block_nodes; ++n)
      if (node_block.sticking >> n & 1) add(b, node_block.collider[n]);
  }
  for (const auto& point : host.points())
    for (std::size_t l = point.begin; l < point.end; ++l)
      add(static_cast<std::size_t>(host.node_block_of_block(host.point_nodes()[l].node / block_nodes)), point.collider);
  std::vector<std::uint32_t> first{0}, next(colliders + 1, 0);
  for (const auto& all : of_block)
    for (const std::int32_t c : all) ++next[static_cast<std::size_t>(c) + 1];
  for (std::size_t c = 0; c < colliders; ++c) next[c + 1] += next[c];
  std::vector<Range> ranges;
  collider_of_range_.clear();
  for (std::size_t c = 0; c < colliders; ++c) {
    add_ranges(next[c], next[c + 1], ranges);
    collider_of_range_.resize(ranges.size(), static_cast<std::int32_t>(c));
  }
  const std::size_t count = next[colliders];
  std::vector<SurfaceGroup> groups;
  for (const auto& all : of_block) {
    for (const std::int32_t c : all) groups.push_back({c, next[static_cast<std::size_t>(c)]++});
    first.push_back(static_cast<std::uint32_t>(groups.size()));
  }
  groups_.upload(groups), first_group_.upload(first), ranges_.upload(ranges);
  given_.resize(count);
}

SurfaceInput SurfaceSolver::input(const VisitInput& in, const World<float>& world, const GapMeasure& gaps, double dt,
                                  std::size_t field) const {
  SurfaceInput all{};
  all.in = in;
  all.field = static_cast<int>(field);
  all.frictional = !world.holds_liquid(field) && std::any_of(world.colliders.begin(), world.colliders.end(),
                                                             [](const Collider& c) { return c.friction > 0; });
  all.moves = moves_;
  all.per_dt = static_cast<float>(world.dx / dt);
  all.gravity_kick = static_cast<Vec3<float>>(world.gravity_over(dt) * dt);
  all.points = points_.data(), all.count = static_cast<std::int32_t>(points_.size());
  all.blocks = blocks_.data(), all.node_blocks = node_blocks_.data(), all.nodes = nodes_.data();
  all.first = first_.data(), all.points_of = points_of_.data();
  all.colliders = colliders_.data();
  all.first_group = first_group_.data(), all.groups = groups_.data();
  all.gaps = gaps.cells(field), all.no_gap = ContactGaps::none;
  all.point_states = point_states_.data(), all.changes = changes_.data();
  all.velocity_weights = velocity_weights_.data(), all.inverse_masses = inverse_masses_.data();
  all.node_states = node_states_.data(), all.fastest2 = fastest2_.data(), all.given = given_.data();
  return all;
}

void SurfaceSolver::operator()(const VisitInput& in, const World<float>& world, const GapMeasure& gaps, double dt) {
  const std::size_t blocks = node_blocks_.size(), points = std::max<std::size_t>(points_.size(), 1);
  if (blocks == 0) return;
  const auto by_point = [&]<class K>(const K& kernel) { launch(*device_, kernel, blocks_for<K>(points)); };
  for (std::size_t field = 0; field < 2; ++field) {
    if (world.grid.field(field).empty()) continue;
    const SurfaceInput all = input(in, world, gaps, dt, field);
    by_point(FindActingPoints{all});
    launch(*device_, FindNodeAreas{all}, blocks);
    by_point(FindEffectiveMasses{all});
    constexpr int steps = ColliderContact::iterations;
    for (int step = 0; step < steps; ++step) {
      by_point(DescendPoints{all, step, steps - 1});
      launch(*device_, ApplyImpulses{all}, blocks);
    }
    launch(*device_, FinishSurfaces{all, steps - 1}, blocks);
  }
}

}  // namespace dreampm::gpu
