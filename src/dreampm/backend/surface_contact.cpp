#include "dreampm/backend/surface_contact.h"

#include <algorithm>
#include <cmath>

#include "dreampm/state/refit.h"

namespace dreampm {
namespace {

/// Each takes longer than the visit of a few hundred nodes.
constexpr std::size_t blocks_at_once = 1;
constexpr int steps = 8, last = steps - 1;  // of the gradient
/// A node counts as if its kernel outside the colliders were filled to this part, at least, of what matter at the point
/// would fill, and, far inside, as if it had this part of the mass at the point for each part of the weight: else those
/// with next to nothing would take off for the others to stay.
constexpr double least_fill = 0.25, least_share = 0.375;
/// From which part of its weights on a point has matter to hold, and from which it has all.
constexpr double held_from = 0.5, held_whole = 0.75;

/// Of a point's weight by the node's mass [1/kg]; `open`: the part of its kernel outside the colliders. At a plane
/// surface of much matter the mass at the point is half of that of a node whose kernel is full.
template <class R>
R answer(const R& w, const R& mass, const R& open, const R& at_point) {
  return w /
         std::max(mass, at_point * std::max(static_cast<R>(2 * least_fill) * open, static_cast<R>(least_share) * w));
}

}  // namespace

template <class R>
void SurfaceContact<R>::prepare(const World<R>& world, const Obstacles& obstacles) {
  homes_.clear(), points_.clear(), links_.clear(), shores_.clear(), shore_of_.clear();
  if (world.colliders.empty()) return;
  const std::size_t blocks = world.grid.blocks.size();
  shore_of_.assign(blocks, -1);
  for (std::size_t b = 0; b < blocks; ++b) link(world, obstacles, b);
  for (const Home& home : homes_) look_inland(obstacles, home);

  for (const Link& l : links_) shore_of_[l.node / block_nodes] = 0;
  const auto is_held = [&](const ObstacleNode& o) {
    return o.inside && !o.deep && world.colliders[o.collider].contact() == WallType::stick;
  };
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::vector<ObstacleNode>& near = obstacles.at(b);
    if (std::any_of(near.begin(), near.end(), is_held)) shore_of_[b] = 0;
    if (shore_of_[b] < 0) continue;
    shore_of_[b] = static_cast<std::int32_t>(shores_.size());
    Shore& shore = shores_.emplace_back();
    shore.block = b;
    shore.open.fill(R(1));
    for (const ObstacleNode& o : near) {
      shore.open[o.node] = std::max(R(0), shore.open[o.node] - static_cast<R>(o.blocked));
      if (!is_held(o)) continue;
      const Collider& collider = world.colliders[o.collider];
      if (shore.held >> o.node & 1 && shore.axis[o.node] == Vec3<R>{}) continue;  // another collider holds it
      shore.held |= std::uint64_t{1} << o.node;
      // Matter that is held does not move along the normal either.
      shore.axis[o.node] = collider.holds ? Vec3<R>{} : static_cast<Vec3<R>>(o.normal);
      shore.collider[o.node] = o.collider;
    }
  }
  for (const Link& l : links_) ++shore_of(l.node).end;
  std::size_t all = 0;
  for (Shore& shore : shores_) {
    const std::size_t count = shore.end;
    shore.begin = shore.end = all;
    all += count;
  }
  refit(gifts_, links_.size());
  for (std::size_t p = 0; p < points_.size(); ++p)
    for (std::size_t l = points_[p].begin; l < points_[p].end; ++l)
      gifts_[shore_of(links_[l].node).end++] = {static_cast<std::uint32_t>(p), links_[l].node % block_nodes,
                                                links_[l].w, R(0)};
}

template <class R>
void SurfaceContact<R>::link(const World<R>& world, const Obstacles& obstacles, std::size_t block) {
  const std::vector<SurfacePoint>& points = obstacles.points(block);
  if (points.empty()) return;
  const Neighbours around = neighbours_in(world.grid.blocks, world, world.grid.blocks[block]);
  homes_.push_back({block, points_.size(), points_.size() + points.size(), around});
  for (const SurfacePoint& p : points) {
    std::array<Weights1<R>, 3> weights;
    for (std::size_t a = 0; a < 3; ++a)
      weights[a] = bspline2(static_cast<R>(p.at[static_cast<int>(a)]) - static_cast<R>(p.first[a] + 1));
    const std::size_t begin = links_.size();
    for (int m = 0; m < 27; ++m) {
      const R w = weights[0].w[m / 9] * weights[1].w[m / 3 % 3] * weights[2].w[m % 3];
      const int i = p.first[0] + m / 9, j = p.first[1] + m / 3 % 3, k = p.first[2] + m % 3;
      const int side = ((i >> 2) + 1) * 9 + ((j >> 2) + 1) * 3 + (k >> 2) + 1;
      const std::int32_t holder = around[static_cast<std::size_t>(side)];
      if (p.deep >> m & 1 || !(w > R(0)) || holder == BlockList::none) continue;
      links_.push_back({static_cast<std::uint32_t>(holder * block_nodes + node_index(i & 3, j & 3, k & 3)), w, R(0)});
    }
    points_.push_back({static_cast<Vec3<R>>(p.normal), static_cast<R>(p.area), p.collider, begin, links_.size()});
  }
}

/// The point that is nearest to the place a cell inland, of the same face: none from the other side of a narrow one.
template <class R>
void SurfaceContact<R>::look_inland(const Obstacles& obstacles, const Home& home) {
  const std::vector<SurfacePoint>& own = obstacles.points(home.block);
  if (std::none_of(own.begin(), own.end(), [](const SurfacePoint& p) { return dot(p.inland, p.inland) > 0; })) return;
  std::vector<float> nearest(own.size(), 0.9f);  // squared, cells: less than to the point itself
  for (int n = 0; n < 27; ++n) {
    const auto there =
        std::lower_bound(homes_.begin(), homes_.end(), home.around[static_cast<std::size_t>(n)],
                         [](const Home& h, std::int32_t block) { return static_cast<std::int32_t>(h.block) < block; });
    if (there == homes_.end() || static_cast<std::int32_t>(there->block) != home.around[static_cast<std::size_t>(n)])
      continue;
    const std::vector<SurfacePoint>& others = obstacles.points(there->block);
    const auto shift = static_cast<Vec3<float>>(neighbour_offset(n) * block_width);
    for (std::size_t p = 0; p < own.size(); ++p) {
      const SurfacePoint& point = own[p];
      if (!(dot(point.inland, point.inland) > 0)) continue;
      for (std::size_t o = 0; o < others.size(); ++o) {
        const Vec3<float> off = others[o].at + shift - point.at - point.inland;
        if (!(dot(off, off) < nearest[p]) || others[o].collider != point.collider ||
            dot(others[o].normal, point.normal) < 0.7f || dot(others[o].inland, point.inland) < 0)
          continue;
        nearest[p] = dot(off, off);
        points_[home.begin + p].inland = static_cast<std::int32_t>(there->begin + o);
      }
    }
  }
}

template <class R>
void SurfaceContact<R>::weigh(Home& home, const Nodes<R>& nodes) {
  home.met = false;
  for (std::size_t p = home.begin; p < home.end; ++p) {
    Point& point = points_[p];
    R mass(0);
    for (std::size_t l = point.begin; l < point.end; ++l) mass += links_[l].w * nodes[links_[l].node].m;
    point.mass = mass > R(least_mass) ? mass : R(0);
    point.gain = point.ahead = point.approach = R(0), point.impulse = {}, point.given = {};
    home.met = home.met || point.mass > R(0);
  }
}

template <class R>
void SurfaceContact<R>::find_approach(const World<R>& world, const Obstacles& obstacles, const ContactGaps& gaps,
                                      const Home& home, R per_dt) {
  const std::vector<SurfacePoint>& surface = obstacles.points(home.block);
  for (std::size_t p = home.begin; p < home.end; ++p) {
    Point& point = points_[p];
    // What a collider holds is inside of it, and has no gap.
    if (!(point.mass > R(0)) || world.colliders[point.collider].holds) continue;
    point.approach = static_cast<R>(gaps.at_point(home.around, surface[p - home.begin])) * per_dt;
  }
}

template <class R>
void SurfaceContact<R>::measure(Shore& shore, Nodes<R>& nodes) {
  Node<R>* const own = nodes.data() + shore.block * block_nodes;
  shore.met = false;
  shore.fastest2 = R(0);
  shore.area.fill(R(0)), shore.most.fill(R(0)), shore.normal.fill({});
  for (std::size_t g = shore.begin; g < shore.end; ++g) {
    Gift& gift = gifts_[g];
    const Point& point = points_[gift.point];
    const Node<R>& node = own[gift.node];
    gift.answer = R(0);
    if (!(point.mass > R(0)) || !(node.m > R(least_mass))) continue;
    gift.answer = answer(gift.w, node.m, shore.open[gift.node], point.mass);
    const R area = point.area * gift.answer * node.m;
    shore.met = true;
    shore.area[gift.node] += area;
    shore.normal[gift.node] += point.normal * area;
    if (area > shore.most[gift.node]) shore.most[gift.node] = area, shore.collider[gift.node] = point.collider;
  }
  for (std::size_t n = 0; n < block_nodes; ++n) {
    shore.before[n] = velocity(own[n]);
    if (own[n].m > R(least_mass)) shore.fastest2 = std::max(shore.fastest2, dot(shore.before[n], shore.before[n]));
    set_velocity(own[n], free_part(shore, n, shore.before[n]));
  }
}

template <class R>
void SurfaceContact<R>::find_gains(const Home& home, const Nodes<R>& nodes) {
  for (std::size_t p = home.begin; p < home.end; ++p) {
    Point& point = points_[p];
    if (!(point.mass > R(0))) continue;
    R held(0), row(0);
    for (std::size_t l = point.begin; l < point.end; ++l) {
      Link& link = links_[l];
      const R mass = nodes[link.node].m;
      link.part = R(0);
      if (!(mass > R(least_mass))) continue;
      const Shore& shore = shore_of(link.node);
      const std::size_t n = link.node % block_nodes;
      const R answers = answer(link.w, mass, shore.open[n], point.mass);
      link.part = answers * mass;
      held += link.part;
      row += answers * shore.area[n];
    }
    const R part = (held - R(held_from)) * R(1 / (held_whole - held_from));
    if (part > R(0) && row > R(0)) point.gain = std::min(part, R(1)) / row;
  }
}

template <class R>
void SurfaceContact<R>::press(const World<R>& world, const Home& home, const Nodes<R>& nodes, int step) {
  const R momentum = step < last ? R(step) / R(step + 3) : R(0);  // the last one stays where it is
  const std::size_t now_at = step & 1, before_at = 1 - now_at;
  for (std::size_t p = home.begin; p < home.end; ++p) {
    Point& point = points_[p];
    if (!(point.gain > R(0))) continue;
    Vec3<R> v{};
    for (std::size_t l = point.begin; l < point.end; ++l) v += velocity(nodes[links_[l].node]) * links_[l].part;
    R now = point.ahead - dot(v, point.normal) * point.gain;
    if (now > R(0)) now = std::max(now - point.approach * point.gain, R(0));
    if (world.colliders[point.collider].contact() == WallType::separate) now = std::max(now, R(0));
    if (step > 0 && point.inland >= 0) {
      const Point& inland = points_[static_cast<std::size_t>(point.inland)];
      const R most = abs(inland.impulse[before_at]);
      if (inland.gain > R(0)) now = std::clamp(now, -most, most);
    }
    const R ahead = now + (now - point.impulse[before_at]) * momentum;
    point.given = point.normal * ((ahead - point.ahead) * point.area);
    point.impulse[now_at] = now;
    point.ahead = ahead;
  }
}

template <class R>
void SurfaceContact<R>::give(const Shore& shore, Nodes<R>& nodes) const {
  Node<R>* const own = nodes.data() + shore.block * block_nodes;
  std::array<Vec3<R>, block_nodes> given{};
  for (std::size_t g = shore.begin; g < shore.end; ++g)
    given[gifts_[g].node] += points_[gifts_[g].point].given * gifts_[g].answer;
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (shore.area[n] > R(0)) set_velocity(own[n], velocity(own[n]) + free_part(shore, n, given[n]));
}

template <class R>
void SurfaceContact<R>::rub(const World<R>& world, const Shore& shore, Nodes<R>& nodes) const {
  Node<R>* const own = nodes.data() + shore.block * block_nodes;
  std::array<R, block_nodes> most{};  // of velocity that friction takes
  for (std::size_t g = shore.begin; g < shore.end; ++g) {
    const Point& point = points_[gifts_[g].point];
    most[gifts_[g].node] += static_cast<R>(world.colliders[point.collider].friction) * point.impulse[last & 1] *
                            point.area * gifts_[g].answer;
  }
  for (std::size_t n = 0; n < block_nodes; ++n) {
    const R length = sqrt(dot(shore.normal[n], shore.normal[n]));
    if (most[n] > R(0) && length > R(0))
      set_velocity(own[n], rubbed(velocity(own[n]), shore.normal[n] * (R(1) / length), most[n]));
  }
}

template <class R>
void SurfaceContact<R>::slow(const Shore& shore, Nodes<R>& nodes) const {
  Node<R>* const own = nodes.data() + shore.block * block_nodes;
  for (std::size_t n = 0; n < block_nodes; ++n)
    if (const R speed2 = dot(velocity(own[n]), velocity(own[n])); shore.area[n] > R(0) && speed2 > fastest2_)
      set_velocity(own[n], velocity(own[n]) * sqrt(fastest2_ / speed2));
}

template <class R>
void SurfaceContact<R>::tell(const World<R>& world, const Shore& shore, const Nodes<R>& nodes, bool rubs,
                             BlockFound& found) const {
  const Node<R>* const own = nodes.data() + shore.block * block_nodes;
  const Vec3i first = world.grid.blocks[shore.block] * block_width;
  for (std::size_t n = 0; n < block_nodes; ++n) {
    if (velocity(own[n]) == shore.before[n]) continue;
    const Vec3d to = static_cast<Vec3d>(velocity(own[n])), normal = static_cast<Vec3d>(shore.normal[n]);
    // Only friction does work: of what is left along normals, putting particles back undoes as much.
    const Vec3d slid = rubs ? to - normal * (dot(to, normal) / std::max(dot(normal, normal), 1e-30)) : Vec3d{};
    found.given(BlockFound::first_collider + shore.collider[n])
        .add(world.node_position(first + node_offset(static_cast<int>(n))), static_cast<double>(own[n].m),
             static_cast<Vec3d>(shore.before[n]), to, slid);
  }
}

template <class R>
void SurfaceContact<R>::operator()(Crew& crew, World<R>& world, const Obstacles& obstacles, std::size_t field,
                                   const ContactGaps& gaps, R per_dt, std::vector<BlockFound>& found) {
  if (shores_.empty()) return;
  Nodes<R>& nodes = world.grid.field(field);
  const bool rubs = !world.holds_liquid(field) && std::any_of(world.colliders.begin(), world.colliders.end(),
                                                              [](const Collider& c) { return c.friction > 0; });
  const auto for_homes = [&](const auto& body) {
    crew.loop(homes_.size(), blocks_at_once, [&](std::size_t h) { body(homes_[h]); });
  };
  const auto for_shores = [&](const auto& body) {
    crew.loop(shores_.size(), blocks_at_once, [&](std::size_t s) { body(shores_[s]); });
  };
  const bool gapped = gaps.has(world, field);
  for_homes([&](Home& home) {
    weigh(home, nodes);
    if (gapped && home.met) find_approach(world, obstacles, gaps, home, per_dt);
  });
  for_shores([&](Shore& shore) { measure(shore, nodes); });
  for_homes([&](const Home& home) {
    if (home.met) find_gains(home, nodes);
  });
  for (int step = 0; step < steps; ++step) {
    for_homes([&](const Home& home) {
      if (home.met) press(world, home, nodes, step);
    });
    for_shores([&](const Shore& shore) {
      if (shore.met) give(shore, nodes);
    });
  }
  // In a loop of its own: who comes here late would look at shores while others measure them for the next field.
  crew.loop(1, 1, [&](std::size_t) {
    fastest2_ = R(0);
    for (const Shore& shore : shores_) fastest2_ = std::max(fastest2_, shore.fastest2);
  });
  for_shores([&](const Shore& shore) {
    if (rubs && shore.met) rub(world, shore, nodes);
    slow(shore, nodes);
    tell(world, shore, nodes, rubs, found[shore.block]);
  });
}

template class SurfaceContact<float>;
template class SurfaceContact<double>;

}  // namespace dreampm
