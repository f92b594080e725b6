#include "dreampm/backend/surface_contact.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/four.h"

namespace dreampm {
namespace {

/// Each takes longer than the visit of a few hundred nodes.
constexpr std::size_t blocks_at_once = 1;

/// Returns the copy of a point on periodic axes that is nearest to `center` [m]: a body at a
/// periodic end has matter beyond the other.
template <class R>
Vec3d nearest_copy(const World<R>& world, Vec3d at, const Vec3d& center) {
  for (int a = 0; a < 3; ++a) {
    if (!world.periodic[static_cast<std::size_t>(a)]) continue;
    const double length = (world.high[a] - world.low[a]) * world.dx;
    at[a] -= length * std::round((at[a] - center[a]) / length);
  }
  return at;
}

}  // namespace

/// The sum at one point has to wait for each node before the next: four points at once do not.
template <class R>
std::size_t SurfaceContact<R>::velocities_at(std::size_t& first, std::size_t end, const Nodes<R>& nodes,
                                             std::array<std::size_t, 4>& which, std::array<Node<R>, 4>& sums) const {
  std::size_t count = 0, shortest = ~std::size_t{0};
  std::array<const LiveNode*, 4> at;
  for (; first < end && count < 4; ++first) {
    const ContactPoint& point = points_[first];
    if (!point.acts || !(point.effective_mass > R(0))) continue;
    which[count] = first, at[count++] = live_nodes_.data() + point.begin;
    shortest = std::min(shortest, point.live_end - point.begin);
  }
  const Node<R>* const from = nodes.data();
  const auto add = [from](const LiveNode& live, Four<R>& sum) {
    Four<R> node;
    load<R>(from + live.node, node);
    sum += node * live.velocity_weight;
  };
  std::size_t summed = 0;
  Four<R> found[4] = {};
  if (count == 4)
    for (; summed < shortest; ++summed)
      add(at[0][summed], found[0]), add(at[1][summed], found[1]), add(at[2][summed], found[2]),
          add(at[3][summed], found[3]);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t nodes_of = points_[which[i]].live_end - points_[which[i]].begin;
    for (std::size_t l = summed; l < nodes_of; ++l) add(at[i][l], found[i]);
    store<R>(found[i], &sums[i]);
  }
  return count;
}

template <class R>
void SurfaceContact<R>::gradient_step(const World<R>& world, const PointBlock& point_block, const Nodes<R>& nodes,
                                      R per_dt, const Vec3<R>& gravity_kick, int step, int last) {
  const R momentum = momentum_of_descent<R>(step, last);
  const std::size_t now_at = step & 1, before_at = 1 - now_at;
  std::array<std::size_t, 4> which;
  std::array<Node<R>, 4> sums;
  for (std::size_t first = point_block.begin, count = 4; count == 4;) {
    count = velocities_at(first, point_block.end, nodes, which, sums);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = which[i];
      const Node<R>& sum = sums[i];
      ContactPoint& point = points_[p];
      const Collider& c = world.colliders[point.collider];
      R now =
          descended(point.extrapolated, dot(velocity(sum), point.normal) - point.surface_speed, point.effective_mass,
                    point.approach, c.contact() == WallType::separate, least_impulse(c.sticky, world.dx, per_dt));
      if (step > 0 && point.edge_limiter >= 0) {
        const ContactPoint& limiter = points_[static_cast<std::size_t>(point.edge_limiter)];
        if (limiter.effective_mass > R(0))
          now = limited_at_edge(now, limiter.impulse[before_at], point.from_edge, point.mass, gravity_kick);
      }
      const R extrapolated = now + (now - point.impulse[before_at]) * momentum;
      const Vec3<R> change = point.normal * ((extrapolated - point.extrapolated) * point.area);
      impulse_changes_[p] = {change.x, change.y, change.z, R(0)};
      point.impulse[now_at] = now;
      point.extrapolated = extrapolated;
    }
  }
}

template <class R>
void SurfaceContact<R>::rest(const PointBlock& point_block) {
  // The impulse of the last step is then the one before it too.
  static_assert(ColliderContact::iterations % 2 == 0 && ColliderContact::body_iterations % 2 == 0);
  for (std::size_t p = point_block.begin; p < point_block.end; ++p)
    points_[p].impulse[0] = points_[p].impulse[1], impulse_changes_[p] = {};
}

/// The points of bodies in their order, so that the sums do not depend on the threads.
template <class R>
void SurfaceContact<R>::solve_bodies() {
  for (const BodyPoint& at : body_points_) {
    const ContactPoint& point = points_[at.point];
    if (!point.acts || !(point.effective_mass > R(0))) continue;
    const double area = static_cast<double>(point.area);
    bodies_.add(at.lever, {area * static_cast<double>(point.extrapolated),
                           point.extrapolated != R(0) ? area * static_cast<double>(point.effective_mass) : 0});
  }
  bodies_.solve();
  for (const BodyPoint& at : body_points_) points_[at.point].surface_speed = static_cast<R>(bodies_.speed(at.lever));
}

template <class R>
void SurfaceContact<R>::apply_impulses(const NodeBlock& node_block, Nodes<R>& nodes) const {
  Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  Four<R> change[block_nodes] = {};
  for (std::size_t g = node_block.begin; g < node_block.live_end; ++g) {
    const LivePoint& at = live_points_[g];
    Four<R> given;
    load<R>(&impulse_changes_[at.point], given);
    change[at.node] += given * at.inverse_mass;
  }
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (node_block.facing[n].m > R(0))
      set_velocity(own[n], velocity(own[n]) + free_part(node_block, n, {change[n][0], change[n][1], change[n][2]}));
}

template <class R>
void SurfaceContact<R>::apply_friction(const World<R>& world, const NodeBlock& node_block, Nodes<R>& nodes,
                                       int last) const {
  Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  std::array<R, block_nodes> most{};  // of velocity that friction takes
  for (std::size_t g = node_block.begin; g < node_block.live_end; ++g) {
    const ContactPoint& point = points_[live_points_[g].point];
    most[live_points_[g].node] += static_cast<R>(world.colliders[point.collider].friction) * point.impulse[last & 1] *
                                  point.area * live_points_[g].inverse_mass;
  }
  for (std::size_t n = 0; n < block_nodes; ++n)
    set_velocity(own[n], after_friction(velocity(own[n]), node_block.surface_velocity[n],
                                        velocity(node_block.facing[n]), most[n]));
}

template <class R>
void SurfaceContact<R>::clamp_speeds(const NodeBlock& node_block, Nodes<R>& nodes) const {
  Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (node_block.facing[n].m > R(0))
      set_velocity(own[n], clamped_speed(velocity(own[n]), node_block.surface_velocity[n], max_speed2_));
}

template <class R>
void SurfaceContact<R>::record_reactions(const World<R>& world, const NodeBlock& node_block, const Nodes<R>& nodes,
                                         bool frictional, BlockStats& found) const {
  const Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  const Vec3i first = world.grid.blocks[node_block.block] * block_width;
  for (std::size_t n = 0; n < block_nodes; ++n) {
    if (velocity(own[n]) == node_block.velocity_before[n]) continue;
    const Vec3d to = static_cast<Vec3d>(velocity(own[n]));
    const Vec3d moved_at = works_at(to, static_cast<Vec3d>(node_block.surface_velocity[n]),
                                    static_cast<Vec3d>(velocity(node_block.facing[n])), frictional);
    const std::size_t collider = node_block.collider[n];
    const Collider& there = world.colliders[collider];
    Vec3d at = world.node_position(first + node_offset(static_cast<int>(n)));
    if (there.rigid) at = nearest_copy(world, at, there.twist.center);
    if (!frictional && is_free_ball_[collider]) at = there.twist.center;
    found.impulse_of(BlockStats::first_collider + collider)
        .add(at, static_cast<double>(own[n].m), static_cast<Vec3d>(node_block.velocity_before[n]), to, moved_at);
  }
}

template <class R>
void SurfaceContact<R>::operator()(ThreadTeam& team, World<R>& world, const Obstacles& obstacles, std::size_t field,
                                   const ContactGaps& gaps, R per_dt, std::vector<BlockStats>& found) {
  if (node_blocks_.empty()) return;
  Nodes<R>& nodes = world.grid.field(field);
  const double dt = per_dt > R(0) ? world.dx / static_cast<double>(per_dt) : 0;
  const auto gravity_kick = static_cast<Vec3<R>>(world.gravity_over(dt) * dt);
  const bool frictional = !world.holds_liquid(field) && std::any_of(world.colliders.begin(), world.colliders.end(),
                                                                    [](const Collider& c) { return c.friction > 0; });
  const auto for_point_blocks = [&](const auto& body) {
    team.loop(point_blocks_.size(), blocks_at_once, [&](std::size_t h) { body(point_blocks_[h]); });
  };
  const auto for_node_blocks = [&](const auto& body) {
    team.loop(node_blocks_.size(), blocks_at_once, [&](std::size_t s) { body(node_blocks_[s]); });
  };
  const ContactGaps* const gaps_before = gaps.has(world, field) ? &gaps : nullptr;
  for_point_blocks([&](PointBlock& point_block) {
    find_acting_points(world, obstacles, gaps_before, point_block, nodes, found, per_dt);
  });
  for_node_blocks([&](NodeBlock& node_block) {
    node_block.idle = !(found[node_block.block].sums.mass > 0);
    find_node_areas(node_block, nodes);
  });
  for_point_blocks([&](const PointBlock& point_block) {
    if (point_block.has_matter) find_effective_masses(point_block, nodes);
  });
  const bool coupled = bodies_.any() && !body_points_.empty();
  const int steps = coupled ? ColliderContact::body_iterations : ColliderContact::iterations, last = steps - 1;
  for (int step = 0; step < steps; ++step) {
    for_point_blocks([&](const PointBlock& point_block) {
      if (!point_block.acts || step > point_block.iterations) return;
      if (step == point_block.iterations)
        rest(point_block);
      else
        gradient_step(world, point_block, nodes, per_dt, gravity_kick, step,
                      std::min(steps, point_block.iterations) - 1);
    });
    if (coupled) team.loop(1, 1, [&](std::size_t) { solve_bodies(); });
    for_node_blocks([&](const NodeBlock& node_block) {
      if (node_block.live_end > node_block.begin && step < node_block.iterations) apply_impulses(node_block, nodes);
    });
  }
  // In a loop of its own: a thread that comes late would read node blocks while others fill them
  // for the next field.
  team.loop(1, 1, [&](std::size_t) {
    max_speed2_ = R(0);
    for (const NodeBlock& node_block : node_blocks_) max_speed2_ = std::max(max_speed2_, node_block.max_speed2);
  });
  for_node_blocks([&](const NodeBlock& node_block) {
    if (node_block.idle || !node_block.counts) return;
    if (frictional && node_block.has_matter) apply_friction(world, node_block, nodes, last);
    clamp_speeds(node_block, nodes);
    record_reactions(world, node_block, nodes, frictional, found[node_block.block]);
  });
}

template class SurfaceContact<float>;
template class SurfaceContact<double>;

}  // namespace dreampm
