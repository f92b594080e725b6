// The particles of one set in a substep, in the order of the papers: MLS-MPM (Hu et al. 2018) with
// the affine velocities of APIC (Jiang et al. 2015).
//
//   1. P2G     particles to grid: particles_to_grid()
//   2. grid    momentum to velocity, forces, walls: backend/grid_update.cpp, for all backends
//   3. G2P     grid to particles: grid_to_particles()
//   4. update  law, stress and move of each particle: update_particles()
//
// This is a circle, and a step of the solver begins with 2 (ARCHITECTURE.md, "The step"): a pass is
// 3, 4, 1. Terms that the papers lack stand in optional_terms.h, each under a name of its own.
#pragma once
#include <vector>

#include "dreampm/backend/reference/optional_terms.h"
#include "dreampm/backend/reference/pass_sums.h"
#include "dreampm/physics/divergence.h"

namespace dreampm::reference {

template <class M, class R>
class ParticlePass {
 public:
  explicit ParticlePass(const SetContext<R>& context)
      : context_(context), law_(M::template Law<R>::from(context.set.values)), particles_(context.set.size()) {}

  /// 1. P2G, at the new position:
  ///   m_i += w_ip m_p,   (m v)_i += w_ip [m_p v_p + (m_p C_p - dt (4/dx^2) V_p tau_p) (x_i - x_p)]
  /// The bracket is linear in x_i - x_p: its value `q` and its slope are those that particle_step()
  /// formed.
  void particles_to_grid() {
    context_.for_each_particle([&](std::size_t block, std::size_t p) {
      const ParticleNodes<R> nodes = context_.nodes_of(block, p);
      const PassParticle<R>& particle = particles_[p];
      nodes.add(context_.next.field(context_.field), particle.scattered.q, particle.scattered.slope,
                context_.step.mass);

      if (context_.step.sub_cycled) scatter_stress(context_, nodes, particle);
      if (keeps_velocity(context_)) scatter_old_velocity(context_, nodes, particle);
      if (has_mixture(context_)) scatter_mixture(context_, nodes, particle);
    });
  }

  /// 3. G2P, at the old position:
  ///   v_p = sum_i w_ip v_i,   B_p = sum_i w_ip v_i (x_i - x_p)^T
  void grid_to_particles() {
    context_.for_each_particle([&](std::size_t block, std::size_t p) {
      const ParticleNodes<R> nodes = context_.nodes_of(block, p);
      const auto found = nodes.template moments<M::info.liquid ? all_bends : no_bends>(context_.velocities());
      G2PResult<R>& g = particles_[p].gathered;
      g.v = vector_of(found.value);
      for (int a = 0; a < 3; ++a) g.affine_moment[a] = vector_of(found.first_moment[a]);

      if constexpr (M::info.liquid) g.affine_excess = divergence_excess(found, nodes.stencil);
      if (measures<M>(context_.step.volume_relaxation)) gather_density<M>(context_, nodes, g);
      if (context_.around.colliders_near(block)) gather_clearance(context_, nodes, block, p, g);
      if (keeps_velocity(context_)) gather_old_velocity(context_, nodes, p, g);
    });
  }

  /// 4. Update:
  ///   C_p = (4/dx^2) B_p,   state_p, tau_p = law(state_p, dt C_p),   x_p += dt v_p
  /// All of it is physics/particle.h:particle_step. `motion` is filled if not null.
  PassStats update_particles(typename Motion<R>::Set* motion) {
    PassStats sums;
    context_.for_each_particle([&](std::size_t block, std::size_t p) {
      PassParticle<R>& particle = particles_[p];
      const BlockWalls<R> walls = context_.walls_of(block);
      Vec3<R> u = context_.position(p);
      auto state = context_.template state<M>(p);
      bool pushed;
      particle.scattered =
          particle_step<M, R>(law_, context_.step, walls, particle.gathered, u, state, particle.response, pushed);
      particle.volume_ratio = volume_ratio(law_, state);
      context_.template store<M>(p, u, state);

      if (keeps_velocity(context_)) store_own_velocity(context_, p, particle);
      add_to_sums<M>(sums, context_, particle, u, walls.colliders, pushed);
      if (motion) write_motion(context_, particle, *motion);
    });
    return sums;
  }

 private:
  SetContext<R> context_;
  const typename M::template Law<R> law_;
  std::vector<PassParticle<R>> particles_;
};

}  // namespace dreampm::reference
