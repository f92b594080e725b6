// Loops over the nodes of a block in every step, over any lane type: momentum to velocity, and
// sums.
#pragma once
#include <bit>
#include <type_traits>

#include "dreampm/backend/impulse_sum.h"
#include "dreampm/backend/node_terms.h"
#include "dreampm/state/grid.h"

namespace dreampm {

/// Sums over the nodes of one block.
struct NodeSums {
  double mass = 0;      ///< kg
  Vec3d moment{};       ///< of mass times place within the block [kg cells]
  double kinetic2 = 0;  ///< twice the kinetic energy [J]
  double fastest2 = 0;  ///< the square of the largest speed [m^2/s^2]
  bool finite = true;
};

/// The planes of nodes behind a wall of the box, on it and as far before it.
template <class R>
struct MirrorPlanes {
  Node<R>* ghosts;  ///< the first node of each
  const Node<R>* walls;
  Node<R>* inners;
  int side;
  WallType type;
  std::uint16_t closed = 0xffff;  ///< the nodes where matter touches the wall, a bit each
};

/// The loops over nodes that one instruction set has: over those of a block, and of planes behind
/// its walls.
template <class R>
struct NodeLoops {
  /// Momentum to velocity, damped to the part `keep` and under gravity; zero where there is no
  /// mass. Adds to mass, moment and `finite`: no mass is a number below zero, or none.
  void (*momentum_to_velocity)(Node<R>* nodes, R keep, const Vec3<R>& kick, NodeSums& sums);
  /// Adds energy and speeds of nodes that hold velocities.
  void (*measure)(const Node<R>* nodes, NodeSums& sums);
  /// Contact of nodes that hold velocities with the wall of a side of the box, whose planes are
  /// counted from the first of them on. `approach`: the speed of each node at which matter may
  /// still come nearer to the wall, >= 0 [m/s]; null where all matter touches it. `impulses`: what
  /// it gave, added, places in cells from there.
  void (*box_contact)(Node<R>* nodes, const BoxWalls<R>& walls, int side, const R* approach, ImpulseSum& impulses);
  /// Mixes the images of nodes behind a wall into those that they mirror, by mass; where matter can
  /// leave it (WallType::separate) only where it presses on it. Returns which did so, a bit each.
  /// `impulses`: what that gave, places in cells from the inner plane's first node on. The wall
  /// does not move, so its impulse does no work.
  std::uint16_t (*fold_ghosts)(const MirrorPlanes<R>& planes, ImpulseSum& impulses);
  /// Gives those nodes behind a wall the velocity of their image, and returns what that adds to
  /// their kinetic energy [J]. `impulses`: places in cells from the first of them on.
  double (*reflect_ghosts)(const MirrorPlanes<R>& planes, std::uint16_t folded, ImpulseSum& impulses);
};

/// The places of a block's nodes within it [cells].
template <class R>
struct NodePlaces {
  alignas(64) R at[3][block_nodes];
  constexpr NodePlaces() : at{} {
    for (int n = 0; n < block_nodes; ++n)
      for (int a = 0; a < 3; ++a) at[a][n] = static_cast<R>(node_offset(n)[a]);
  }
};
template <class R>
inline constexpr NodePlaces<R> node_places;
inline Vec3d place_in_block(std::size_t n) {
  const auto& at = node_places<double>.at;
  return {at[0][n], at[1][n], at[2][n]};
}

/// True if all nodes of a block are zero, as in many blocks at the rim of the grid.
template <class R>
DM_FN bool is_empty(const Node<R>* nodes) {
  using Bits = std::conditional_t<sizeof(R) == 4, std::uint32_t, std::uint64_t>;
  // One number after the other: node by node g++ takes its vectors apart into x, y, z and m first.
  const R* const numbers = &nodes->x;
  Bits any = 0;
  for (std::size_t n = 0; n < block_nodes * sizeof(Node<R>) / sizeof(R); ++n) any |= std::bit_cast<Bits>(numbers[n]);
  return any == 0;
}

/// The places of a plane's nodes in it [cells].
template <class R>
struct PlanePlaces {
  alignas(64) R rows[plane_nodes], columns[plane_nodes];
  constexpr PlanePlaces() : rows{}, columns{} {
    for (int n = 0; n < plane_nodes; ++n)
      rows[n] = static_cast<R>(n / block_width), columns[n] = static_cast<R>(n % block_width);
  }
};
template <class R>
inline constexpr PlanePlaces<R> plane_places;

// `Row` handles as many nodes as S has lanes: load, store, numbers, sum, largest, bits, mask, as
// OneNode does for plain numbers.

/// Returns the sum over all lanes.
template <class Row, class S>
DM_FN ImpulseSum sum_of(const ImpulseSumOf<S>& impulses) {
  const auto sum = [](const Vec3<S>& v) __attribute__((always_inline)) {
    return static_cast<Vec3d>(Vec3<Scalar<S>>{Row::sum(v.x), Row::sum(v.y), Row::sum(v.z)});
  };
  return {sum(impulses.impulse), sum(impulses.angular), static_cast<double>(Row::sum(impulses.work))};
}

template <class S, class Row>
DM_FN void convert_nodes(Node<Scalar<S>>* nodes, Scalar<S> keep, const Vec3<Scalar<S>>& kick, NodeSums& sums) {
  using R = Scalar<S>;
  if (is_empty(nodes)) return;
  const Vec3<S> kicks{S(kick.x), S(kick.y), S(kick.z)};
  const S kept(keep), zero(R(0));
  S mass(zero), lowest(zero);
  Vec3<S> moment{zero, zero, zero};
  for (int n = 0; n < block_nodes; n += LaneTraits<S>::lanes) {
    Vec3<S> q;
    S m;
    Row::load(nodes + n, q, m);
    Row::store(node_velocity(q, m, kept, kicks), m, nodes + n);
    mass += m;
    lowest = min(m, lowest);
    const auto& at = node_places<R>.at;
    moment += Vec3<S>{Row::numbers(at[0] + n), Row::numbers(at[1] + n), Row::numbers(at[2] + n)} * m;
  }
  const auto total = static_cast<double>(Row::sum(mass));
  sums.mass += total;
  sums.moment += static_cast<Vec3d>(Vec3<R>{Row::sum(moment.x), Row::sum(moment.y), Row::sum(moment.z)});
  // NaN is neither less nor more than anything, but stays in a sum.
  sums.finite = sums.finite && total - total == 0 && !(-Row::largest(-lowest) < R(0));
}

template <class S, class Row>
DM_FN void measure_nodes(const Node<Scalar<S>>* nodes, NodeSums& sums) {
  using R = Scalar<S>;
  S kinetic2(R(0)), fastest2(R(0));
  for (int n = 0; n < block_nodes; n += LaneTraits<S>::lanes) {
    Vec3<S> v;
    S m;
    Row::load(nodes + n, v, m);
    const S speed2 = dot(v, v);
    kinetic2 += m * speed2;
    fastest2 = max(speed2, fastest2);
  }
  const auto total = static_cast<double>(Row::sum(kinetic2)), top = static_cast<double>(Row::largest(fastest2));
  sums.kinetic2 += total;
  sums.fastest2 = max(sums.fastest2, top);
  sums.finite = sums.finite && total - total == 0 && top < 1e30;
}

template <class S, class Row>
DM_FN void contact_nodes(Node<Scalar<S>>* nodes, const BoxWalls<Scalar<S>>& walls, int side, const Scalar<S>* approach,
                         ImpulseSum& impulses) {
  using R = Scalar<S>;
  ImpulseSumOf<S> given;
  for (int n = 0; n < block_nodes; n += LaneTraits<S>::lanes) {
    const auto& at = node_places<R>.at;
    const Vec3<S> place{Row::numbers(at[0] + n), Row::numbers(at[1] + n), Row::numbers(at[2] + n)};
    const auto held = walls.holds(side, place);
    if (!any(held)) continue;
    Vec3<S> before;
    S m;
    Row::load(nodes + n, before, m);
    const S gap = approach ? Row::numbers(approach + n) : S(R(0));
    const WallContact<S> met = wall_contact<S>(walls, side, before, approach ? &gap : nullptr);
    const Vec3<S> after = select(held, met.after, before);
    Row::store(after, m, nodes + n);
    given.add(place, m, before, after, met.stopped);
  }
  impulses += sum_of<Row>(given);
}

/// Returns the offsets of a plane's nodes from `n` on, from the plane's first node.
template <class S, class Row>
DM_FN Vec3<S> places_in_plane(int axis, int n) {
  const auto& at = plane_places<Scalar<S>>;
  Vec3<S> place;
  place[axis] = S(Scalar<S>(0));
  place[(axis + 1) % 3] = Row::numbers(at.rows + n);
  place[(axis + 2) % 3] = Row::numbers(at.columns + n);
  return place;
}

/// A plane's nodes, which lie apart, where a vector can load them.
template <class R>
struct PlaneCopy {
  alignas(64) Node<R> nodes[plane_nodes];

  DM_FN PlaneCopy(const Node<R>* first, int axis) {
    for (int n = 0; n < plane_nodes; ++n) nodes[n] = first[node_in_plane(axis, n)];
  }
  /// Writes the nodes of `some`, a bit each, back.
  DM_FN void store(Node<R>* first, int axis, unsigned some) const {
    for (; some; some &= some - 1) {
      const int n = std::countr_zero(some);
      first[node_in_plane(axis, n)] = nodes[n];
    }
  }
};

template <class S, class Row>
DM_FN std::uint16_t fold_planes(const MirrorPlanes<Scalar<S>>& planes, ImpulseSum& impulses) {
  using R = Scalar<S>;
  const int axis = axis_of(planes.side);
  const PlaneCopy<R> ghosts(planes.ghosts, axis);
  bool empty = true;
  for (const Node<R>& ghost : ghosts.nodes) empty = empty && !(ghost.m > R(least_mass));
  if (empty) return 0;
  PlaneCopy<R> inners(planes.inners, axis);
  const PlaneCopy<R> walls(planes.walls, axis);
  const S zero(R(0));
  const Vec3<S> still{zero, zero, zero};
  ImpulseSumOf<S> given;
  unsigned nodes = 0;
  for (int n = 0; n < plane_nodes; n += LaneTraits<S>::lanes) {
    Vec3<S> behind, on, before;
    S ghost, wall, m;
    Row::load(ghosts.nodes + n, behind, ghost);
    Row::load(walls.nodes + n, on, wall);
    Row::load(inners.nodes + n, before, m);
    const auto folds = image_folds(planes.side, planes.type, ghost, m, on) && Row::mask(planes.closed >> n);
    if (!any(folds)) continue;
    nodes |= Row::bits(folds) << n;
    const Vec3<S> mixed = folded(planes.side, planes.type, folds, behind, ghost, before, m);
    const Vec3<S> after = select(folds, mixed, before);
    Row::store(after, m, inners.nodes + n);
    given.add(places_in_plane<S, Row>(axis, n), m, before, after, still);
  }
  inners.store(planes.inners, axis, nodes);
  impulses += sum_of<Row>(given);
  return static_cast<std::uint16_t>(nodes);
}

template <class S, class Row>
DM_FN double reflect_planes(const MirrorPlanes<Scalar<S>>& planes, std::uint16_t folded, ImpulseSum& impulses) {
  using R = Scalar<S>;
  const int axis = axis_of(planes.side);
  PlaneCopy<R> ghosts(planes.ghosts, axis);
  const PlaneCopy<R> inners(planes.inners, axis);
  const S zero(R(0));
  const Vec3<S> still{zero, zero, zero};
  ImpulseSumOf<S> given;
  S gained2(zero);
  for (int n = 0; n < plane_nodes; n += LaneTraits<S>::lanes) {
    Vec3<S> before, inner;
    S m, inner_m;
    Row::load(ghosts.nodes + n, before, m);
    Row::load(inners.nodes + n, inner, inner_m);
    const Vec3<S> after = select(Row::mask(folded >> n), image_of(inner, axis, planes.type), before);
    Row::store(after, m, ghosts.nodes + n);
    given.add(places_in_plane<S, Row>(axis, n), m, before, after, still);
    gained2 += m * (dot(after, after) - dot(before, before));
  }
  ghosts.store(planes.ghosts, axis, folded);
  impulses += sum_of<Row>(given);
  return 0.5 * static_cast<double>(Row::sum(gained2));
}

template <class R>
struct OneNode {
  static void load(const Node<R>* node, Vec3<R>& xyz, R& m) { xyz = {node->x, node->y, node->z}, m = node->m; }
  static void store(const Vec3<R>& xyz, R m, Node<R>* node) { *node = {xyz.x, xyz.y, xyz.z, m}; }
  static R numbers(const R* p) { return *p; }
  static R sum(R a) { return a; }
  static R largest(R a) { return a; }
  static unsigned bits(bool m) { return m; }
  static bool mask(unsigned bits) { return (bits & 1) != 0; }
};

/// The loops for plain numbers.
template <class R>
NodeLoops<R> plain_node_loops() {
  return {
      [](Node<R>* nodes, R keep, const Vec3<R>& kick, NodeSums& sums) {
        convert_nodes<R, OneNode<R>>(nodes, keep, kick, sums);
      },
      [](const Node<R>* nodes, NodeSums& sums) { measure_nodes<R, OneNode<R>>(nodes, sums); },
      [](Node<R>* nodes, const BoxWalls<R>& walls, int side, const R* approach, ImpulseSum& impulses) {
        contact_nodes<R, OneNode<R>>(nodes, walls, side, approach, impulses);
      },
      [](const MirrorPlanes<R>& planes, ImpulseSum& impulses) { return fold_planes<R, OneNode<R>>(planes, impulses); },
      [](const MirrorPlanes<R>& planes, std::uint16_t folded, ImpulseSum& impulses) {
        return reflect_planes<R, OneNode<R>>(planes, folded, impulses);
      }};
}

}  // namespace dreampm
