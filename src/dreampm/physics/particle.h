// One particle between gather and scatter: the physics of a step, written once for scalar and
// lanes. Lengths in cells, the rest SI.
#pragma once
#include "dreampm/physics/collider_contact.h"
#include "dreampm/physics/law.h"
#include "dreampm/physics/shift.h"
#include "dreampm/physics/transfer.h"
#include "dreampm/physics/transfer_rule.h"

namespace dreampm {

/// Constants of all particles of a set in one step.
template <class S>
struct SetStep {
  S dt, dt_next;   ///< s: of this step, which moves particles, and of the next one, whose force is scattered
  S dx;            ///< m
  S mass, volume;  ///< of one particle, kg and m^3 at rest
  S full;          ///< content of a full node, in the unit of G2PResult::node_content
  bool keep_inside;
  S margin;  ///< distance that particles keep from walls and colliders [cells]; at least `inside_margin`
  TransferRule<S> transfer;  ///< its blend is the share of own velocities that this step keeps
  S keep_next;               ///< share of own velocities that the next step keeps
  S volume_relaxation;       ///< as in StrainIncrement
  bool sub_cycled;           ///< true if the force of the next step is left to sub-cycles
  S max_own_speed;  ///< m/s: the most that the transfer's `advance` adds along an axis, so that steps can be bounded
};

/// Node planes of walls, counted from the block's first_stencil(); an open side lies far away.
template <class S>
struct BlockWalls {
  S low[3], high[3];
  bool
      truncates_kernel[3];  ///< by axis: true if one of its walls cuts kernels off, as the grid has no images behind it
  bool near;  ///< true if a wall is within 2.5 cells of a particle of the block, where open_fraction is less than 1
  bool colliders;  ///< true if there are colliders near the block
};

/// The result of the gather (G2P) at a particle.
template <class R>
struct G2PResult {
  Vec3<R> v;                 ///< m/s
  Vec3<R> affine_moment[3];  ///< sum w v (x_i - x_p)_a, m/s cells
  /// Content of the nodes of the particle's field, weighed: mass [kg], or, where sets of several
  /// densities share the field, rest volume over dx^3 [1]. Only where the step measures a density.
  R node_content;
  R blocked;        ///< sum w blocked_i [1]; only where the step measures a density
  R affine_excess;  ///< m/s cells: excess of tr C over the divergence of the splines' field; only of liquids
  DensityState<R> density_state;  ///< only of volume-relaxed liquids in a step that relaxes volume
  Vec3<R> clearance_gradient;     ///< gradient of `clearance` [1]
  R clearance;                    ///< distance from colliders [cells], negative inside; only where there are some near
  Vec3<R> own_velocity;           ///< m/s: the particle's own; only where the transfer keeps velocities
  Vec3<R> velocity_old;           ///< sum w v_i before the grid's forces; only where the transfer keeps velocities
};

/// The terms of the scatter (P2G): a node gets (q + sum slope_a (x_i - x_p)_a) w, x_i - x_p in
/// cells.
template <class R>
struct P2GTerms {
  Vec3<R> q, slope[3];
  Vec3<R> own_velocity;  ///< m/s: the particle's velocity now
  Vec3<R> shifted;       ///< cells: displacement besides its velocity's; only of volume-relaxed liquids in a step that
                         ///< relaxes volume, and where there are colliders about
  /// Volume that the particle takes beyond that at rest, over that at rest [1]; 0 but of
  /// volume-relaxed liquids in a step that relaxes volume. 0 where the nodes hold less than
  /// `least_content` of a full one: drops of spray are no swollen liquid.
  R swollen;
};

/// True if particles need the density around them in a step with this volume relaxation [s/m].
template <class M, class S>
constexpr bool measures(S volume_relaxation) {
  return M::wants_density && (!VolumeRelaxed<M> || volume_relaxation > S(0));
}

/// C dt, C = grad v [1/s] of gathered moments (Jiang et al. 2015: C = B D^-1, D = dx^2/4).
template <class S, class R>
DM_FN Mat3<R> affine_velocity(const Vec3<R> (&affine_moment)[3], S dx, S dt = S(1)) {
  const R scale(S(apic_inertia) * dt / dx);
  Mat3<R> c;
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) c(i, a) = affine_moment[a][i] * scale;
  return c;
}

/// The slopes of momentum alone, without the step's force: m C (x_i - x_p), x_i - x_p in cells, of
/// gathered moments.
template <class R>
DM_FN Vec3<R> momentum_slope(const Vec3<R>& affine_moment, const SetStep<Scalar<R>>& set) {
  using S = Scalar<R>;
  return affine_moment * R(S(apic_inertia) * set.mass * set.transfer.affine);
}

/// The slope of momentum that a stress gives in dt, over that stress: -dt (4/dx^2) V0 dx.
template <class S>
DM_FN S stress_slope(const SetStep<S>& set, S dt) {
  return -dt * S(apic_inertia) * set.volume / set.dx;
}

/// The part of a particle with an own velocity in the grid's velocities before forces: its momentum
/// and mass, times the share that the coming step keeps. The sum of kept m (v_p - v_before) over
/// particles is then zero, whatever share each set keeps; else momentum would be lost or won where
/// sets of two blends share nodes.
template <class R>
struct OldVelocityTerm {
  Vec3<R> q, slope[3];
  R mass;

  DM_FN OldVelocityTerm(const P2GTerms<R>& now, const Vec3<R> (&affine_moment)[3], const SetStep<Scalar<R>>& set)
      : q(now.q * R(set.keep_next)), mass(Scalar<R>(set.mass * set.keep_next)) {
    for (int a = 0; a < 3; ++a) slope[a] = momentum_slope(affine_moment[a], set) * R(set.keep_next);
  }
};

/// v^2/2 + dx^2/8 |C|^2 [J/kg]: the kinetic energy of a particle per mass, inertia dx^2/4 for the
/// affine share.
template <class R>
DM_FN R kinetic_energy(const G2PResult<R>& g, const P2GTerms<R>& now, const SetStep<Scalar<R>>& set) {
  using S = Scalar<R>;
  const R turning = fused_norm2(g.affine_moment[0]) + fused_norm2(g.affine_moment[1]) + fused_norm2(g.affine_moment[2]);
  return R(S(0.5)) * mul_add(turning, R(S(apic_inertia) * set.transfer.affine), fused_norm2(now.own_velocity));
}

/// The open part of the kernel at `u` beside those walls of the box behind which there are no
/// images.
template <class R>
DM_FN R open_fraction_at(const Vec3<R>& u, const BlockWalls<Scalar<R>>& walls) {
  using S = Scalar<R>;
  R open(S(1));
  if (!walls.near) return open;
  for (int a = 0; a < 3; ++a) {
    if (!walls.truncates_kernel[a]) continue;
    const R x = u[a] + R(S(0.5));
    open = open * open_fraction(x - R(walls.low[a])) * open_fraction(R(walls.high[a]) - x);
  }
  return open;
}

/// The slopes of momentum that a stress alone gives in dt.
template <class R>
DM_FN void stress_slopes(const SetStep<Scalar<R>>& set, const Sym3<R>& stress, Scalar<R> dt, Vec3<R> (&slope)[3]) {
  const R force(stress_slope(set, dt));
  const Mat3<R> tau = stress.full();
  for (int a = 0; a < 3; ++a) slope[a] = tau.column(a) * force;
}

/// Computes the slopes of viscous stress in the step from gathered moments.
template <class M, class R>
DM_FN void viscous_slopes(const typename M::template Law<Scalar<R>>& law, const SetStep<Scalar<R>>& set,
                          const typename M::template State<R>& state, const Vec3<R> (&affine_moment)[3],
                          Vec3<R> (&slope)[3]) {
  using S = Scalar<R>;
  StressResponse<R> response{};
  add_viscous(law, state, StrainIncrement<R>{affine_velocity(affine_moment, set.dx, set.dt), R(set.dt), R(S(1)), S(0)},
              response);
  stress_slopes(set, response.tau, set.dt, slope);
}

/// Returns the displacement [cells] that keeps a particle that would move by `move` [cells] out of
/// colliders: within `margin` [cells] it comes no nearer, and a particle inside comes back by
/// put_back_limit a step.
template <class R>
DM_FN Vec3<R> put_back(const G2PResult<R>& g, const Vec3<R>& move, Scalar<R> margin) {
  using S = Scalar<R>;
  const R zero(S(0)), towards = dot(g.clearance_gradient, move), place = g.clearance + towards,
                      entered = max(-towards, zero);
  const R inside =
      min(max(R(S(ColliderContact::inside_margin)) - place, zero), entered + R(S(ColliderContact::put_back_limit)));
  return g.clearance_gradient * max(inside, min(max(R(margin) - place, zero), entered));
}

/// A particle's step between gather and scatter: advance the law with the step's velocity gradient,
/// move, and form what is scattered: m v and m C - dt_next (4/dx^2) V0 tau. `pushed` is set where a
/// wall had to push the particle back.
template <class M, class R>
DM_FN P2GTerms<R> particle_step(const typename M::template Law<Scalar<R>>& law, const SetStep<Scalar<R>>& set,
                                const BlockWalls<Scalar<R>>& walls, const G2PResult<R>& g, Vec3<R>& u,
                                typename M::template State<R>& state, StressResponse<R>& response,
                                typename LaneTraits<R>::Mask& pushed) {
  using S = Scalar<R>;
  P2GTerms<R> out;
  out.swollen = R(S(0));
  StrainIncrement<R> at{affine_velocity(g.affine_moment, set.dx, set.dt), R(set.dt), R(S(1)), set.volume_relaxation};
  // J follows the divergence of the field that moves the particles. That of C errs by +-0.096 dx
  // v'' in turn from particle to particle of a cell, which works as a stiffness.
  if constexpr (M::info.liquid) {
    const R each = g.affine_excess * R(S(1.0 / 3) * set.dt / set.dx);
    for (int a = 0; a < 3; ++a) at.gradient(a, a) = at.gradient(a, a) - each;
  }
  if (measures<M>(set.volume_relaxation)) {
    const R open = max(open_fraction_at(u, walls) - g.blocked, R(S(VolumeCorrection::least_open_fraction)));
    at.volume = R(set.full) * open / g.node_content;
    if constexpr (VolumeRelaxed<M>) {
      at.inside = g.density_state.inside;
      at.surface_filled = g.node_content / (g.node_content + g.density_state.missing);
      at.at_rest = g.density_state.at_rest;
      const R swollen = max(at.volume * at.at_rest - R(S(1)), R(S(0)));
      out.swollen = select(g.node_content > R(S(VolumeCorrection::least_content) * set.full), swollen, R(S(0)));
      at.strain = sqrt(fused_norm2(symmetric_part(at.gradient))) *
                  R(S(VolumeCorrection::relaxation_cells) * set.dx / set.dt * set.volume_relaxation);
    }
  }
  response = law.advance(state, at);
  if (!set.sub_cycled) add_viscous(law, state, at, response);

  // FLIP, ASFLIP: x' = x + dt (v + advance blend (v_p - v_before)), v_p' = v + blend (v_p -
  // v_before)
  Vec3<R> v = g.v, move = g.v;
  if (set.transfer.keeps_velocity()) {
    const Vec3<R> kept = (g.own_velocity - g.velocity_old) * R(set.transfer.blend);
    v = g.v + kept;
    const R share = separated_fraction(law, state) * R(set.transfer.advance);
    for (int a = 0; a < 3; ++a)
      move[a] = g.v[a] + min(max(kept[a] * share, R(-set.max_own_speed)), R(set.max_own_speed));
  }

  const Vec3<R> start = u;
  if (walls.colliders) out.shifted = Vec3<R>{R(S(0)), R(S(0)), R(S(0))};
  if constexpr (VolumeRelaxed<M>)
    if (measures<M>(set.volume_relaxation)) {
      // Strain is what makes disorder; at rest a shift would make clumps.
      const R free = max(R(S(1)) - g.blocked * R(S(VolumeCorrection::shift_keeps_off)), R(S(0)));
      for (int a = 0; a < 3; ++a) {
        const R most = R(S(VolumeCorrection::shift_limit));
        out.shifted[a] = min(max(g.density_state.shift[a] * free * at.strain, -most), most);
        u[a] = u[a] + out.shifted[a];
      }
    }

  const R per_step(set.dt / set.dx);
  pushed = u.x < u.x;
  for (int a = 0; a < 3; ++a) u[a] = mul_add(move[a], per_step, u[a]);
  if (set.keep_inside && walls.colliders) {
    const Vec3<R> back = put_back(g, u - start, set.margin);
    u = u + back, out.shifted = out.shifted + back;
  }
  for (int a = 0; a < 3; ++a) {
    if (set.keep_inside && walls.near) {
      R low(walls.low[a] + S(ColliderContact::inside_margin - 0.5)),
          high(walls.high[a] - S(ColliderContact::inside_margin + 0.5));
      if constexpr (!M::info.liquid) {
        const R room(set.margin - S(ColliderContact::inside_margin));
        low = max(low, min(low + room, start[a])), high = min(high, max(high - room, start[a]));
      }
      pushed = pushed || u[a] < low || u[a] > high;
      u[a] = min(max(u[a], low), high);
    }
  }

  const R force(set.sub_cycled ? S(0) : stress_slope(set, set.dt_next));
  const Mat3<R> tau = response.tau.full();
  out.q = v * R(set.mass);
  out.own_velocity = v;
  for (int a = 0; a < 3; ++a) {
    const Vec3<R> momentum = momentum_slope(g.affine_moment[a], set);
    for (int i = 0; i < 3; ++i) out.slope[a][i] = mul_add(tau(i, a), force, momentum[i]);
  }
  return out;
}

}  // namespace dreampm
