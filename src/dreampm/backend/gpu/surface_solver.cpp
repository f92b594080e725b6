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
      body_points_(device),
      body_ranges_(device),
      body_sums_(device),
      motions_(device),
      point_states_(device),
      changes_(device),
      velocity_weights_(device),
      inverse_masses_(device),
      node_states_(device),
      fastest2_(device),
      given_(device) {}

void SurfaceSolver::prepare(const World<float>& world, const Obstacles& obstacles, const SurfaceContact<float>& host,
                            const ContactGaps& gaps) {
  find_points(obstacles, host, gaps);
  find_nodes(host);
  find_groups(world.colliders.size(), host);
  find_bodies(world);
  fastest2_.resize(1);
  set_velocities(world, obstacles, host);
}

void SurfaceSolver::set_velocities(const World<float>& world, const Obstacles& obstacles,
                                   const SurfaceContact<float>& host) {
  if (node_blocks_.size() == 0) return;
  std::vector<CollidingMatter> colliders;
  for (std::size_t c = 0; c < world.colliders.size(); ++c) {
    const Collider& one = world.colliders[c];
    colliders.push_back({one.contact(), !one.holds, static_cast<float>(one.friction), one.sticky, one.rigid,
                         host.is_free_ball(c), one.twist.center});
  }
  colliders_.upload(colliders);
  moves_ = host.moves();
  for (const auto& point_block : host.point_blocks()) {
    const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
    for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
      const SurfacePoint& from = surface[p - point_block.begin];
      ContactPoint& to = points_home_[p];
      to.velocity = from.velocity, to.spin = from.spin, to.arm = static_cast<Vec3<float>>(from.arm);
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
      to = {};
      to.at = from.at, to.normal = from.normal, to.from_edge = from.from_edge, to.area = from.area;
      to.block = static_cast<std::uint32_t>(blocks.size()), to.deep = from.deep;
      to.limiter = known.edge_limiter, to.limits = known.limits;
      to.iterations = static_cast<std::uint8_t>(point_block.iterations);
      to.collider = from.collider, to.body = -1;
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

void SurfaceSolver::find_bodies(const World<float>& world) {
  std::vector<std::int32_t> body_of(world.colliders.size(), -1);
  for (std::size_t b = 0; b < world.rigid.size(); ++b) body_of[world.rigid[b].collider] = static_cast<std::int32_t>(b);
  std::vector<std::vector<std::uint32_t>> of_body(world.rigid.size());
  for (std::size_t p = 0; p < points_home_.size(); ++p) {
    ContactPoint& point = points_home_[p];
    point.body = body_of[point.collider];
    if (point.body >= 0) of_body[static_cast<std::size_t>(point.body)].push_back(static_cast<std::uint32_t>(p));
  }
  std::vector<std::uint32_t> points;
  std::vector<Range> ranges;
  body_of_range_.clear();
  for (std::size_t b = 0; b < of_body.size(); ++b) {
    const auto begin = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), of_body[b].begin(), of_body[b].end());
    add_ranges(begin, static_cast<std::uint32_t>(points.size()), ranges);
    body_of_range_.resize(ranges.size(), b);
  }
  body_points_.upload(points), body_ranges_.upload(ranges);
  body_sums_.resize(ranges.size()), body_sums_home_.resize(ranges.size(), BodySums::none());
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
  for (int a = 0; a < 3; ++a)
    all.period[a] = world.periodic[static_cast<std::size_t>(a)] ? (world.high[a] - world.low[a]) * world.dx : 0;
  all.node_states = node_states_.data(), all.fastest2 = fastest2_.data(), all.given = given_.data();
  return all;
}

void SurfaceSolver::operator()(const VisitInput& in, const World<float>& world, const GapMeasure& gaps, double dt,
                               bool bodies) {
  if (node_blocks_.size() == 0) return;
  const bool coupled = bodies && body_points_.size() > 0;
  if (coupled) {
    coupling_.begin(world, dt);
    motions_home_.resize(world.rigid.size());
    send_bodies();
  }
  for (std::size_t field = 0; field < 2; ++field) {
    if (world.grid.field(field).empty()) continue;
    SurfaceInput all = input(in, world, gaps, dt, field);
    all.bodies = coupled ? motions_.data() : nullptr;
    solve_field(all, coupled);
  }
}

void SurfaceSolver::solve_field(const SurfaceInput& all, bool bodies) {
  const std::size_t blocks = node_blocks_.size(), points = std::max<std::size_t>(points_.size(), 1);
  const auto by_point = [&]<class K>(const K& kernel) { launch(*device_, kernel, blocks_for<K>(points)); };
  by_point(FindActingPoints{all});
  launch(*device_, FindNodeAreas{all}, blocks);
  by_point(FindEffectiveMasses{all});
  const int steps = bodies ? ColliderContact::body_iterations : ColliderContact::iterations;
  for (int step = 0; step < steps; ++step) {
    by_point(DescendPoints{all, step, steps - 1});
    if (bodies) solve_bodies(all);
    launch(*device_, ApplyImpulses{all}, blocks);
  }
  launch(*device_, FinishSurfaces{all, steps - 1}, blocks);
}

void SurfaceSolver::solve_bodies(const SurfaceInput& all) {
  launch(*device_, SumBodies{all, body_points_.data(), body_ranges_.data(), body_sums_.data()}, body_ranges_.size());
  body_sums_.download(body_sums_home_);
  for (std::size_t r = 0; r < body_sums_home_.size(); ++r) coupling_.add(body_of_range_[r], body_sums_home_[r]);
  coupling_.solve();
  send_bodies();
}

void SurfaceSolver::send_bodies() {
  for (std::size_t b = 0; b < motions_home_.size(); ++b) motions_home_[b] = {coupling_.velocity(b), coupling_.spin(b)};
  motions_.upload(motions_home_);
}

}  // namespace dreampm::gpu
