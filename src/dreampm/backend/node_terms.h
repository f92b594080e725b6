// What happens to one node of the grid in its visit: momentum to velocity, contact with the walls
// of the box, its image behind them. Compilers of device code read it too.
#pragma once
#include <cstdint>

#include "dreampm/physics/node.h"
#include "dreampm/state/node.h"

namespace dreampm {

/// Masses of nodes below this count as nothing: a stencil's outermost weights.
inline constexpr double least_mass = 1e-36;
template <class R>
DM_FN bool has_mass(const Node<R>& node) {
  return node.m > R(least_mass);
}

template <class R>
DM_FN Vec3<R> velocity(const Node<R>& node) {
  return {node.x, node.y, node.z};
}
/// Leaves the mass alone: other blocks may be reading it.
template <class R>
DM_FN void set_velocity(Node<R>& node, const Vec3<R>& v) {
  node.x = v.x, node.y = v.y, node.z = v.z;
}

/// Constants of all nodes in one step.
template <class R>
struct NodeConstants {
  BoxWalls<R> walls[2];  ///< by field
  Vec3<R> kick;
  R keep;         ///< of the velocity, by damping
  R diffusion;    ///< dt/dx^2 [s/m^2]
  R dx;           ///< m
  R per_dt;       ///< dx/dt [m/s]
  bool skin;      ///< true if a wall slows liquids by its boundary layer
  bool slows[6];  ///< the walls that do, where they are asked to
  // Viscous contact, where viscosity acts in stages: up to this drag it is one of their forces;
  // what is left of it acts on its own, for this part of the step. It is rare: a node with next to
  // nothing of a solid, a liquid that solves its own viscosity implicitly.
  R staged_drag, part;

  /// Returns the part of a drag that the stages leave to this visit.
  DM_FN R unstaged(const R& drag) const { return part * max(R(0), drag - staged_drag); }
};

/// The velocity of a node with momentum `q` and mass `m`; zero where there is no mass.
template <class S>
DM_FN Vec3<S> node_velocity(const Vec3<S>& q, const S& m, const S& keep, const Vec3<S>& kick) {
  const S zero(Scalar<S>(0)), one(Scalar<S>(1));
  const auto there = m > S(static_cast<Scalar<S>>(least_mass));
  const Vec3<S> v = free_velocity(q, select(there, m, one), keep, kick);
  return {select(there, v.x, zero), select(there, v.y, zero), select(there, v.z, zero)};
}

/// The momentum of the particles that keep a velocity becomes their velocity. Returns twice their
/// kinetic energy [J]; `unweigh` turns their weight into mass.
template <class R>
DM_FN R normalize_old_velocity(Node<R>& before, const R& unweigh) {
  const R weight = before.m;
  before = has_mass(before) ? before * (R(1) / weight) : Node<R>{};
  return weight * unweigh * dot(velocity(before), velocity(before));
}

/// The velocity of a node after contact with a wall.
template <class S>
struct WallContact {
  Vec3<S> after, stopped;  ///< `stopped`: without what a gap lets through
};
/// `approach`: the speed at which matter may still come nearer to the wall, >= 0 [m/s]; null where
/// it touches it.
template <class S>
DM_FN WallContact<S> wall_contact(const BoxWalls<Scalar<S>>& walls, int side, const Vec3<S>& before,
                                  const S* approach) {
  const int axis = axis_of(side);
  Vec3<S> onto = before;
  S let(Scalar<S>(0));
  if (approach) {
    let = walls.let_through(side, before, *approach);
    onto[axis] -= let;
  }
  WallContact<S> found;
  found.stopped = found.after = walls.contact(side, onto);
  if (approach) found.after[axis] += let;
  return found;
}

/// The boundary layer of a wall at a liquid's node.
template <class R>
struct BoundaryLayer {
  Vec3<R> along;  ///< m/s, the node's velocity along the wall
  R drag;         ///< as in skin_drag
};
/// Finds that of the wall of `side` at node number `at` of the grid; false where the node does not
/// lie on the wall, leaves it, or there is none. `viscosity`: of the node's mixture.
template <class R>
DM_FN bool boundary_layer(const NodeConstants<R>& step, int side, const Vec3<std::int32_t>& at, const Node<R>& node,
                          const R& viscosity, BoundaryLayer<R>& found) {
  const int a = axis_of(side);
  const int plane = side % 2 == 0 ? step.walls[0].low[a] : step.walls[0].high[a];
  if (!step.slows[side] || at[a] != plane) return false;
  found.along = velocity(node);
  if (side % 2 == 0 ? found.along[a] > R(0) : found.along[a] < R(0)) return false;
  found.along[a] = R(0);
  const R speed = sqrt(dot(found.along, found.along)), own = viscosity / node.m;
  if (!(speed > R(0)) || !(own > R(0))) return false;
  found.drag = skin_drag(speed, own, step.dx, step.diffusion * step.dx);
  return true;
}
/// The velocity that such a layer leaves, where no stage of viscosity takes part of it.
template <class R>
DM_FN Vec3<R> after_layer(const NodeConstants<R>& step, const Vec3<R>& before, const BoundaryLayer<R>& layer) {
  return before - layer.along * (R(1) - R(1) / (R(1) + step.unstaged(layer.drag)));
}

/// The change of a node's velocity in one of the stages of a sub-cycled step (Meyer et al. 2014,
/// RKL1). `change`: that of the stage before; `given`: the momentum that stress gives in the whole
/// step, `kick` the velocity that gravity does.
template <class R>
DM_FN Vec3<R> stage_change(const Vec3<R>& change, const Vec3<R>& given, const R& mass, const R& keep, const R& gain,
                           const Vec3<R>& kick) {
  return change * keep + given * (gain / mass) + kick * gain;
}
/// The velocity that a boundary layer takes in a stage.
template <class R>
DM_FN Vec3<R> lost_in_stage(const NodeConstants<R>& step, const BoundaryLayer<R>& layer, const R& gain) {
  return layer.along * (gain * min(layer.drag, step.staged_drag));
}
/// Twice the work that gravity and `stress` [kg m/s] do at a node that goes from one velocity to
/// another, in a step [J].
template <class R>
DM_FN R driven_work2(const Vec3<R>& kick, const Vec3<R>& stress, const R& mass, const Vec3<R>& before,
                     const Vec3<R>& now) {
  return dot(kick * mass + stress, before + now);
}

/// True where the image of a node behind a wall mixes with the node that it mirrors: where both
/// have mass and, at a wall that lets matter leave, where matter presses on it. `on`: velocity of
/// the wall's node between.
template <class S>
DM_FN auto image_folds(int side, WallType type, const S& ghost_mass, const S& mass, const Vec3<S>& on) {
  using R = Scalar<S>;
  const S least(static_cast<R>(least_mass));
  auto folds = ghost_mass > least && mass > least;
  if (type == WallType::separate) folds = folds && on[axis_of(side)] * S(static_cast<R>(inward_of(side))) < S(R(0));
  return folds;
}
/// The velocity of such a node, mixed by mass.
template <class S, class Mask>
DM_FN Vec3<S> folded(int side, WallType type, const Mask& folds, const Vec3<S>& ghost, const S& ghost_mass,
                     const Vec3<S>& before, const S& mass) {
  const Vec3<S> image = image_of(ghost, axis_of(side), type);
  return before + (image - before) * (ghost_mass / select(folds, ghost_mass + mass, S(Scalar<S>(1))));
}

/// Makes what is `behind` a wall and its image `inner` the same, and counts what lies on the wall
/// twice.
template <class R>
DM_FN void add_image(R& behind, R& wall, R& inner) {
  wall += wall;
  inner += behind;
  behind = inner;
}

inline constexpr int plane_nodes = block_width * block_width;
/// Node `n` of those of a block in a plane across an axis, from the first of them.
constexpr int node_in_plane(int axis, int n) {
  return n / block_width * node_step[(axis + 1) % 3] + n % block_width * node_step[(axis + 2) % 3];
}

}  // namespace dreampm
