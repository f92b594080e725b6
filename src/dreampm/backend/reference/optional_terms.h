// The terms of a pass that the papers' loops lack, one function each: what liquids gather,
// colliders, transfers that keep velocities, several materials, stages of viscosity.
#pragma once
#include <optional>

#include "dreampm/backend/mixture_share.h"
#include "dreampm/backend/reference/set_context.h"

namespace dreampm::reference {

/// True if sets share nodes with others, or with colliders.
template <class R>
bool has_mixture(const SetContext<R>& context) {
  return !context.world.grid.mixture.empty();
}

/// Gathers for laws that measure density: the content of the nodes around, and the part of it that
/// others take; for liquids whose volume is relaxed also where surfaces are, and the shift.
template <class M, class R>
void gather_density(const SetContext<R>& context, const ParticleNodes<R>& nodes, G2PResult<R>& g) {
  const Nodes<R>&masses = context.velocities(), &mixture = context.world.grid.mixture;
  const bool shares = M::info.liquid && has_mixture(context);
  const auto held = [&](std::size_t i) {
    return context.by_volume ? mixture::filled(mixture[i], context.field) : masses[i].m;
  };
  const auto taken = [&](std::size_t i) { return shares ? mixture::blocked(mixture[i]) : R(0); };
  g.node_content = nodes.sum(held);
  g.blocked = nodes.sum(taken);
  if constexpr (VolumeRelaxed<M>) {
    const Stencil<R>& s = nodes.stencil;
    g.density_state = density_state(Shared<R, 3>(s.w[0], s.t[0]), Shared<R, 3>(s.w[1], s.t[1]), LinePlace<R>(s.t[2]),
                                    s.t, context.step.full, nodes.splines(held), nodes.splines(taken));
  }
}

/// Near colliders: the distance from them and its gradient, at thin walls exactly, elsewhere from
/// the nodes.
template <class R>
void gather_clearance(const SetContext<R>& context, const ParticleNodes<R>& nodes, std::size_t block, std::size_t p,
                      G2PResult<R>& g) {
  const ThinWalls& thin = context.around.thin_walls[block];
  if (const std::optional<Node<R>> exact = thin.any() ? thin.at(context.position(p)) : std::nullopt) {
    g.clearance_gradient = vector_of(*exact), g.clearance = exact->m;
    return;
  }
  const Nodes<float>& clearance = context.around.obstacles.clearance();
  g.clearance_gradient = nodes.sum([&](std::size_t i) { return static_cast<Vec3<R>>(vector_of(clearance[i])); });
  g.clearance = nodes.sum([&](std::size_t i) { return static_cast<R>(clearance[i].m); });
}

// FLIP and ASFLIP: particles keep a velocity of their own, and get of the grid what its forces
// changed.

template <class R>
bool keeps_velocity(const SetContext<R>& context) {
  return context.set.transfer.keeps_velocity();
}
template <class R>
void gather_old_velocity(const SetContext<R>& context, const ParticleNodes<R>& nodes, std::size_t p, G2PResult<R>& g) {
  const Nodes<R>& old = context.world.grid.velocity_old[context.field];
  g.own_velocity = {context.set.own_velocity[0][p], context.set.own_velocity[1][p], context.set.own_velocity[2][p]};
  g.velocity_old = nodes.sum([&](std::size_t i) { return vector_of(old[i]); });
}
template <class R>
void store_own_velocity(const SetContext<R>& context, std::size_t p, const PassParticle<R>& particle) {
  for (std::size_t a = 0; a < 3; ++a)
    context.set.own_velocity[a][p] = particle.scattered.own_velocity[static_cast<int>(a)];
}
template <class R>
void scatter_old_velocity(const SetContext<R>& context, const ParticleNodes<R>& nodes,
                          const PassParticle<R>& particle) {
  const OldVelocityTerm<R> old(particle.scattered, particle.gathered.affine_moment, context.step);
  nodes.add(context.next.velocity_old[context.field], old.q, old.slope, old.mass);
}

/// Scatters the momentum of stress in a step in stages of viscosity, kept apart from that of the
/// matter.
template <class R>
void scatter_stress(const SetContext<R>& context, const ParticleNodes<R>& nodes, const PassParticle<R>& particle) {
  Vec3<R> slopes[3];
  stress_slopes(context.step, particle.response.tau, context.step.dt_next, slopes);
  nodes.add(context.next.stress[context.field], {}, slopes, R(0));
}

/// Several materials, or colliders: the volume that the particle fills and its viscosity, or what
/// it blocks.
template <class R>
void scatter_mixture(const SetContext<R>& context, const ParticleNodes<R>& nodes, const PassParticle<R>& particle) {
  const R viscosity = particle.response.kinematic_viscosity + particle.response.implicit_viscosity;
  const MixtureShare<R> share(context.world, context.set, context.step, viscosity, particle.volume_ratio);
  nodes.for_each([&](R w, std::size_t i) { share.add_to(context.next.mixture[i], w); });
}

/// Scatters the momentum that the viscous stress of the nodes' velocities gives in the whole step;
/// for a stage of viscosity.
template <class M, class R>
void scatter_viscous_forces(const SetContext<R>& context) {
  const auto law = M::template Law<R>::from(context.set.values);
  context.for_each_particle([&](std::size_t block, std::size_t p) {
    const ParticleNodes<R> nodes = context.nodes_of(block, p);
    const auto found = nodes.template moments<no_bends>(context.velocities());
    Vec3<R> affine_moment[3], slopes[3];
    for (int a = 0; a < 3; ++a) affine_moment[a] = vector_of(found.first_moment[a]);
    viscous_slopes<M, R>(law, context.step, context.template state<M>(p), affine_moment, slopes);
    nodes.add(context.next.field(context.field), {}, slopes, R(0));
  });
}

}  // namespace dreampm::reference
