#include "dreampm/backend/surface_contact.h"

#include <algorithm>
#include <cmath>

namespace dreampm {
namespace {

/// Each takes longer than the visit of a few hundred nodes.
constexpr std::size_t blocks_at_once = 1;

/// A point's weight over the node's mass, bounded from below [1/kg]; `open_fraction`: of the node's
/// kernel, outside the colliders. At a plane surface of much matter the mass at the point is half
/// of that of a node whose kernel is full.
template <class R>
R bounded_inverse_mass(const R& w, const R& mass, const R& open_fraction, const R& at_point) {
  return w / std::max(mass, at_point * std::max(static_cast<R>(2 * ColliderContact::least_fill) * open_fraction,
                                                static_cast<R>(ColliderContact::least_share) * w));
}

/// Of a point and its copies on periodic axes the one nearest to `center` [m]: a body at a periodic
/// end has matter beyond the other.
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

template <class R>
void SurfaceContact<R>::find_point_masses(PointBlock& point_block, const Nodes<R>& nodes,
                                          const std::vector<BlockStats>& found) {
  point_block.has_matter = point_block.acts = false;
  const bool any = std::any_of(point_block.around.begin(), point_block.around.end(), [&](std::int32_t b) {
    return b != BlockList::none && found[static_cast<std::size_t>(b)].sums.mass > 0;
  });
  if (!any && point_block.cleared) return;
  point_block.cleared = !any;
  for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
    ContactPoint& point = points_[p];
    R mass(0);
    for (std::size_t l = point.begin; l < point.end; ++l) mass += point_nodes_[l].w * nodes[point_nodes_[l].node].m;
    point.mass = mass > R(least_mass) ? mass : R(0);
    point.acts = point.mass > R(0);
    point.effective_mass = point.extrapolated = point.surface_speed = point.approach = R(0), point.impulse = {};
    impulse_changes_[p] = {};
    point_block.has_matter = point_block.acts = point_block.has_matter || point.acts;
  }
}

template <class R>
void SurfaceContact<R>::find_approach_speeds(const World<R>& world, const Obstacles& obstacles, const ContactGaps& gaps,
                                             PointBlock& point_block, R per_dt) {
  const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
  ContactGaps::AtPoints gap_at(gaps, point_block.around);
  point_block.acts = false;
  for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
    ContactPoint& point = points_[p];
    // What a collider holds is inside of it, and has no gap.
    if (const Collider& collider = world.colliders[point.collider]; point.acts && !collider.holds) {
      const float gap = gap_at.at(surface[p - point_block.begin]);
      point.approach = static_cast<R>(gap) * per_dt;
      point.acts = gap < ContactGaps::none || collider.contact() != WallType::separate || collider.sticky > 0;
    }
    point_block.acts = point_block.acts || point.acts;
  }
}

template <class R>
void SurfaceContact<R>::find_node_areas(NodeBlock& node_block, Nodes<R>& nodes) {
  node_block.has_matter = false;
  node_block.max_speed2 = R(0);
  if (node_block.idle) return;
  Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  node_block.facing.fill({}), node_block.most.fill(R(0));
  if (node_block.moves)
    for (std::size_t n = 0; n < block_nodes; ++n)
      if (!(node_block.sticking >> n & 1)) node_block.surface_velocity[n] = {};
  node_block.live_end = node_block.begin;
  for (std::size_t g = node_block.begin; g < node_block.end; ++g) {
    const NodePoint& node_point = node_points_[g];
    const Node<R>& node = own[node_point.node];
    if (!(node.m > R(least_mass))) continue;
    const ContactPoint& point = points_[node_point.point];
    if (!(point.mass > R(0))) continue;
    const R inverse_mass =
        bounded_inverse_mass(node_point.w, node.m, node_block.open_fraction[node_point.node], point.mass);
    if (point.acts) live_points_[node_block.live_end++] = {node_point.point, node_point.node, inverse_mass};
    const R area = point.area * inverse_mass * node.m;
    node_block.has_matter = true;
    Node<R>& facing = node_block.facing[node_point.node];
    facing = facing + Node<R>{point.normal.x, point.normal.y, point.normal.z, R(1)} * area;
    if (node_block.moves && !(node_block.sticking >> node_point.node & 1))
      node_block.surface_velocity[node_point.node] += node_point_velocity_[g] * area;
    if (area > node_block.most[node_point.node])
      node_block.most[node_point.node] = area, node_block.collider[node_point.node] = point.collider;
  }
  for (std::size_t n = 0; n < block_nodes; ++n) {
    node_block.velocity_before[n] = velocity(own[n]);
    Vec3<R>& surface = node_block.surface_velocity[n];
    // Of those at a node the mean over their area.
    if (node_block.moves && !(node_block.sticking >> n & 1) && node_block.facing[n].m > R(0))
      surface = surface * (R(1) / node_block.facing[n].m);
    const Vec3<R> relative = node_block.velocity_before[n] - surface;
    if (own[n].m > R(least_mass)) node_block.max_speed2 = std::max(node_block.max_speed2, dot(relative, relative));
    set_velocity(own[n], free_part(node_block, n, relative) + surface);
  }
}

template <class R>
void SurfaceContact<R>::find_effective_masses(const PointBlock& point_block, const Nodes<R>& nodes) {
  for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
    ContactPoint& point = points_[p];
    if (!point.acts && !(point.mass > R(0) && point.limits)) continue;
    R held_weight(0), row(0);
    Vec3<R> surface{}, arm{};
    const bool moves_freely = bodies_.any() && point.lever >= 0;
    const bool moves = any_moves_ && !point_block.rests;
    point.live_end = point.begin;
    for (std::size_t l = point.begin; l < point.end; ++l) {
      const PointNode& point_node = point_nodes_[l];
      const R mass = nodes[point_node.node].m;
      if (!(mass > R(least_mass))) continue;
      const NodeBlock& node_block = node_block_of(point_node.node);
      const std::size_t n = point_node.node % block_nodes;
      const R inverse_mass = bounded_inverse_mass(point_node.w, mass, node_block.open_fraction[n], point.mass);
      const R velocity_weight = inverse_mass * mass;
      live_nodes_[point.live_end++] = {point_node.node, velocity_weight};
      held_weight += velocity_weight;
      if (moves) surface += point_node_velocity_[l] * velocity_weight;
      if (moves_freely) arm += point_node_arm_[l] * velocity_weight;
      row += inverse_mass * node_block.facing[n].m;
    }
    const R part = (held_weight - R(ColliderContact::held_from)) *
                   R(1 / (ColliderContact::held_whole - ColliderContact::held_from));
    if (part > R(0) && row > R(0)) point.effective_mass = std::min(part, R(1)) / row;
    point.surface_speed = dot(surface, point.normal);
    if (moves_freely) {
      BodyCoupling::Lever& lever = body_points_[static_cast<std::size_t>(point.lever)].lever;
      lever.linear = static_cast<Vec3d>(point.normal) * static_cast<double>(held_weight);
      lever.angular = is_free_ball_[point.collider] ? Vec3d{} : static_cast<Vec3d>(cross(arm, point.normal));
      point.surface_speed = static_cast<R>(bodies_.speed(lever));
    }
  }
}

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
  std::size_t summed = 0;
  if (count == 4) {
    Node<R> a{}, b{}, c{}, d{};
    for (; summed < shortest; ++summed) {
      a = a + from[at[0][summed].node] * at[0][summed].velocity_weight;
      b = b + from[at[1][summed].node] * at[1][summed].velocity_weight;
      c = c + from[at[2][summed].node] * at[2][summed].velocity_weight;
      d = d + from[at[3][summed].node] * at[3][summed].velocity_weight;
    }
    sums = {a, b, c, d};
  } else {
    sums.fill({});
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t nodes_of = points_[which[i]].live_end - points_[which[i]].begin;
    for (std::size_t l = summed; l < nodes_of; ++l) sums[i] = sums[i] + from[at[i][l].node] * at[i][l].velocity_weight;
  }
  return count;
}

template <class R>
void SurfaceContact<R>::gradient_step(const World<R>& world, const PointBlock& point_block, const Nodes<R>& nodes,
                                      R per_dt, const Vec3<R>& gravity_kick, int step, int last) {
  const R momentum = step < last ? R(step) / R(step + 3) : R(0);  // the last one stays where it is
  const std::size_t now_at = step & 1, before_at = 1 - now_at;
  std::array<std::size_t, 4> which;
  std::array<Node<R>, 4> sums;
  for (std::size_t first = point_block.begin, count = 4; count == 4;) {
    count = velocities_at(first, point_block.end, nodes, which, sums);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = which[i];
      const Node<R>& sum = sums[i];
      ContactPoint& point = points_[p];
      R now = point.extrapolated - (dot(velocity(sum), point.normal) - point.surface_speed) * point.effective_mass;
      if (now > R(0)) now = std::max(now - point.approach * point.effective_mass, R(0));
      if (const Collider& c = world.colliders[point.collider]; c.contact() == WallType::separate)
        now = std::max(now, c.sticky > 0 ? static_cast<R>(-c.sticky * world.dx * world.dx * world.dx) / per_dt : R(0));
      if (step > 0 && point.edge_limiter >= 0) {
        const ContactPoint& limiter = points_[static_cast<std::size_t>(point.edge_limiter)];
        // A kernel at a plane surface is half full.
        const R weight = std::max(R(0), -dot(gravity_kick, point.from_edge)) * 2 * point.mass;
        const R most = abs(limiter.impulse[before_at]) + weight;
        if (limiter.effective_mass > R(0)) now = std::clamp(now, -most, most);
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
  std::array<Node<R>, block_nodes> change{};
  for (std::size_t g = node_block.begin; g < node_block.live_end; ++g) {
    const LivePoint& at = live_points_[g];
    change[at.node] = change[at.node] + impulse_changes_[at.point] * at.inverse_mass;
  }
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (node_block.facing[n].m > R(0))
      set_velocity(own[n], velocity(own[n]) + free_part(node_block, n, velocity(change[n])));
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
  for (std::size_t n = 0; n < block_nodes; ++n) {
    const Vec3<R> normal = velocity(node_block.facing[n]);
    const R length = sqrt(dot(normal, normal));
    if (!(most[n] > R(0) && length > R(0))) continue;
    const Vec3<R>& surface = node_block.surface_velocity[n];
    set_velocity(own[n],
                 apply_coulomb_friction(velocity(own[n]) - surface, normal * (R(1) / length), most[n]) + surface);
  }
}

template <class R>
void SurfaceContact<R>::clamp_speeds(const NodeBlock& node_block, Nodes<R>& nodes) const {
  Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  for (std::size_t n = 0; n < block_nodes; ++n) {
    const Vec3<R>&surface = node_block.surface_velocity[n], relative = velocity(own[n]) - surface;
    if (const R speed2 = dot(relative, relative); node_block.facing[n].m > R(0) && speed2 > max_speed2_)
      set_velocity(own[n], relative * sqrt(max_speed2_ / speed2) + surface);
  }
}

template <class R>
void SurfaceContact<R>::record_reactions(const World<R>& world, const NodeBlock& node_block, const Nodes<R>& nodes,
                                         bool frictional, BlockStats& found) const {
  const Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  const Vec3i first = world.grid.blocks[node_block.block] * block_width;
  for (std::size_t n = 0; n < block_nodes; ++n) {
    if (velocity(own[n]) == node_block.velocity_before[n]) continue;
    const Vec3d to = static_cast<Vec3d>(velocity(own[n])), normal = static_cast<Vec3d>(velocity(node_block.facing[n]));
    const Vec3d surface = static_cast<Vec3d>(node_block.surface_velocity[n]), relative = to - surface;
    // A wall that stands still does work by friction alone: of what is left along normals, putting
    // particles back undoes as much.
    const Vec3d slid =
        frictional ? relative - normal * (dot(relative, normal) / std::max(dot(normal, normal), 1e-30)) : Vec3d{};
    const std::size_t collider = node_block.collider[n];
    const Collider& there = world.colliders[collider];
    Vec3d at = world.node_position(first + node_offset(static_cast<int>(n)));
    if (there.rigid) at = nearest_copy(world, at, there.twist.center);
    if (!frictional && is_free_ball_[collider]) at = there.twist.center;
    found.impulse_of(BlockStats::first_collider + collider)
        .add(at, static_cast<double>(own[n].m), static_cast<Vec3d>(node_block.velocity_before[n]), to, surface + slid);
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
  const bool gapped = gaps.has(world, field);
  for_point_blocks([&](PointBlock& point_block) {
    find_point_masses(point_block, nodes, found);
    if (gapped && point_block.has_matter) find_approach_speeds(world, obstacles, gaps, point_block, per_dt);
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
    if (node_block.idle) return;
    if (frictional && node_block.has_matter) apply_friction(world, node_block, nodes, last);
    clamp_speeds(node_block, nodes);
    record_reactions(world, node_block, nodes, frictional, found[node_block.block]);
  });
}

template class SurfaceContact<float>;
template class SurfaceContact<double>;

}  // namespace dreampm
