// The setup of contact with colliders before its iterations: the masses at surface points, the
// speed at which matter may come nearer, and the effective masses of impulses at the nodes.
#include <algorithm>
#include <cmath>
#include <optional>

#include "dreampm/backend/surface_contact.h"
#include "dreampm/math/four.h"

namespace dreampm {

template <class R>
void SurfaceContact<R>::find_masses(const std::array<std::size_t, 4>& which, std::size_t count, const Nodes<R>& nodes,
                                    std::array<R, 4>& masses) const {
  const auto add = [&](std::size_t l, R& sum) { sum += point_nodes_[l].w * nodes[point_nodes_[l].node].m; };
  masses = {};
  std::size_t summed = 0;
  if (count == masses.size()) {
    std::array<std::size_t, 4> begin;
    std::size_t shortest = stencil_nodes;
    for (std::size_t i = 0; i < 4; ++i) {
      begin[i] = points_[which[i]].begin;
      shortest = std::min(shortest, points_[which[i]].end - begin[i]);
    }
    R a(0), b(0), c(0), d(0);
    for (; summed < shortest; ++summed)
      add(begin[0] + summed, a), add(begin[1] + summed, b), add(begin[2] + summed, c), add(begin[3] + summed, d);
    masses = {a, b, c, d};
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t l = points_[which[i]].begin + summed; l < points_[which[i]].end; ++l) add(l, masses[i]);
}

template <class R>
void SurfaceContact<R>::find_acting_points(const World<R>& world, const Obstacles& obstacles, const ContactGaps* gaps,
                                           PointBlock& point_block, const Nodes<R>& nodes,
                                           const std::vector<BlockStats>& found, R per_dt) {
  point_block.has_matter = point_block.acts = point_block.counts = false;
  const bool any = std::any_of(point_block.around.begin(), point_block.around.end(), [&](std::int32_t b) {
    return b != BlockList::none && found[static_cast<std::size_t>(b)].sums.mass > 0;
  });
  if (!any && point_block.cleared) return;
  point_block.cleared = !any;
  const std::vector<SurfacePoint>& surface = obstacles.points(point_block.block);
  std::optional<ContactGaps::AtPoints> gap_at;
  if (any && gaps) gap_at.emplace(*gaps, point_block.around);
  // Four sums at once do not wait for one another.
  std::array<std::size_t, 4> which{};
  std::array<R, 4> masses;
  std::size_t count = 0;
  const auto set_masses = [&] {
    find_masses(which, count, nodes, masses);
    for (std::size_t i = 0; i < count; ++i) {
      ContactPoint& point = points_[which[i]];
      point.mass = masses[i] > R(least_mass) ? masses[i] : R(0);
      point.acts = point.acts && point.mass > R(0);
      if (point.acts) acting_[which[i]].mass = point.mass;
      point_block.acts = point_block.acts || point.acts;
      point_block.counts = point_block.counts || point.mass > R(0);
    }
    count = 0;
  };
  for (std::size_t p = point_block.begin; p < point_block.end; ++p) {
    ContactPoint& point = points_[p];
    point.mass = point.effective_mass = point.extrapolated = point.surface_speed = point.approach = R(0);
    point.impulse = {};
    impulse_changes_[p] = {};
    acting_[p].mass = R(0);
    point.acts = any;
    // Matter that a collider holds is inside of it, and has no gap.
    if (const Collider& collider = world.colliders[point.collider]; gap_at && !collider.holds) {
      const float gap = gap_at->at(surface[p - point_block.begin]);
      point.approach = static_cast<R>(gap) * per_dt;
      point.acts = gap < ContactGaps::none || collider.contact() != WallType::separate || collider.sticky > 0;
    }
    if (!any || !(point.acts || point.limits)) continue;
    which[count++] = p;
    if (count == which.size()) set_masses();
  }
  set_masses();
  point_block.has_matter = point_block.counts;
}

template <class R>
void SurfaceContact<R>::find_node_areas(NodeBlock& node_block, Nodes<R>& nodes) {
  node_block.has_matter = node_block.counts = false;
  node_block.max_speed2 = R(0);
  node_block.live_end = node_block.begin;
  if (node_block.idle) return;
  const auto counts = [&](const Run& run) { return point_blocks_[run.point_block].counts; };
  const auto runs = runs_.begin() + 27 * (&node_block - node_blocks_.data());
  node_block.counts = node_block.sticking != 0 || node_block.moves ||
                      std::any_of(runs, runs_.begin() + static_cast<std::ptrdiff_t>(node_block.runs_end), counts);
  Node<R>* const own = nodes.data() + node_block.block * block_nodes;
  if (node_block.counts) add_node_areas(node_block, own);
  for (std::size_t n = 0; n < block_nodes; ++n) {
    node_block.velocity_before[n] = velocity(own[n]);
    Vec3<R>& surface = node_block.surface_velocity[n];
    // The mean over the points at a node, by their areas.
    if (node_block.moves && !(node_block.sticking >> n & 1) && node_block.facing[n].m > R(0))
      surface = surface * (R(1) / node_block.facing[n].m);
    const Vec3<R> relative = node_block.velocity_before[n] - surface;
    if (own[n].m > R(least_mass)) node_block.max_speed2 = std::max(node_block.max_speed2, dot(relative, relative));
    set_velocity(own[n], free_part(node_block, n, relative) + surface);
  }
}

template <class R>
void SurfaceContact<R>::add_node_areas(NodeBlock& node_block, const Node<R>* own) {
  node_block.facing.fill({}), node_block.most.fill(R(0));
  if (node_block.moves)
    for (std::size_t n = 0; n < block_nodes; ++n)
      if (!(node_block.sticking >> n & 1)) node_block.surface_velocity[n] = {};
  LivePoint* live = live_points_.data() + node_block.begin;
  bool has_matter = false;
  const auto add = [&](const NodePoint& node_point, const ActingPoint& point) {
    const std::size_t n = node_point.node;
    // Without branches: which nodes have mass is hard to foresee. Those without add 0.
    const R mass = mass_or_none(own[n]);
    const R inverse_mass = bounded_inverse_mass(node_point.w, mass, node_block.open_fraction[n], point.mass);
    *live = {node_point.point, node_point.node, inverse_mass};
    live += static_cast<std::ptrdiff_t>(mass > R(0));
    has_matter |= mass > R(0);
    const R area = point.area * inverse_mass * mass;
    Four<R> facing;
    load<R>(&node_block.facing[n], facing);
    facing += Four<R>{point.normal.x, point.normal.y, point.normal.z, R(1)} * area;
    store<R>(facing, &node_block.facing[n]);
    if (node_block.moves && !(node_block.sticking >> n & 1))
      node_block.surface_velocity[n] +=
          node_point_velocity_[static_cast<std::size_t>(&node_point - node_points_.data())] * area;
    const bool largest = area > node_block.most[n];
    node_block.most[n] = largest ? area : node_block.most[n];
    node_block.collider[n] = largest ? point.collider : node_block.collider[n];
  };
  for (auto r = static_cast<std::size_t>(27 * (&node_block - node_blocks_.data())); r < node_block.runs_end; ++r) {
    if (!point_blocks_[runs_[r].point_block].acts) continue;
    const NodePoint* at = node_points_.data() + runs_[r].begin;
    for (const NodePoint *const end = node_points_.data() + runs_[r].end, *next; at < end; at = next) {
      next = at + at->rest;
      if (const ActingPoint& point = acting_[at->point]; point.mass > R(0))
        for (; at < next; ++at) add(*at, point);
    }
  }
  node_block.has_matter = has_matter;
  node_block.live_end = static_cast<std::size_t>(live - live_points_.data());
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
    LiveNode* live = live_nodes_.data() + point.begin;
    for (std::size_t l = point.begin; l < point.end; ++l) {
      const PointNode& point_node = point_nodes_[l];
      const R mass = mass_or_none(nodes[point_node.node]);
      const NodeBlock& node_block = node_block_of(point_node.node);
      const std::size_t n = point_node.node % block_nodes;
      const R inverse_mass = bounded_inverse_mass(point_node.w, mass, node_block.open_fraction[n], point.mass);
      const R velocity_weight = inverse_mass * mass;
      *live = {point_node.node, velocity_weight};
      live += static_cast<std::ptrdiff_t>(mass > R(0));
      held_weight += velocity_weight;
      if (moves) surface += point_node_velocity_[l] * velocity_weight;
      if (moves_freely) arm += point_node_arm_[l] * velocity_weight;
      row += inverse_mass * node_block.facing[n].m;
    }
    point.live_end = static_cast<std::size_t>(live - live_nodes_.data());
    point.effective_mass = effective_mass_of(held_weight, row, point.acts);
    point.surface_speed = dot(surface, point.normal);
    if (moves_freely) {
      BodyCoupling::Lever& lever = body_points_[static_cast<std::size_t>(point.lever)].lever;
      lever.linear = static_cast<Vec3d>(point.normal) * static_cast<double>(held_weight);
      lever.angular = is_free_ball_[point.collider] ? Vec3d{} : static_cast<Vec3d>(cross(arm, point.normal));
      point.surface_speed = static_cast<R>(bodies_.speed(lever));
    }
  }
}

#define DM_INSTANTIATE(R)                                                                                           \
  template void SurfaceContact<R>::find_acting_points(const World<R>&, const Obstacles&, const ContactGaps*,        \
                                                      PointBlock&, const Nodes<R>&, const std::vector<BlockStats>&, \
                                                      R);                                                           \
  template void SurfaceContact<R>::find_node_areas(NodeBlock&, Nodes<R>&);                                          \
  template void SurfaceContact<R>::find_effective_masses(const PointBlock&, const Nodes<R>&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
