// Sums over the particles of a pass, for the ledger and the next step, and their motion for output.
// Nothing of it acts on the matter.
#pragma once
#include <algorithm>
#include <cmath>

#include "dreampm/backend/reference/set_context.h"

namespace dreampm::reference {

/// Adds one particle, now at `u`. `colliders`: whether there are any about; `pushed`: whether a
/// wall pushed it back.
template <class M, class R>
void add_to_sums(PassStats& sums, const SetContext<R>& context, const PassParticle<R>& particle, const Vec3<R>& u,
                 bool colliders, bool pushed) {
  const auto& [gathered, response, ratio, scattered] = particle;
  sums.wave_speed = std::max(sums.wave_speed, static_cast<double>(response.sound_speed));
  sums.viscosity = std::max(sums.viscosity, static_cast<double>(response.kinematic_viscosity));
  sums.j_min = std::min(sums.j_min, static_cast<double>(ratio));
  sums.j_max = std::max(sums.j_max, static_cast<double>(ratio));
  sums.pushed += pushed;
  sums.finite = sums.finite && std::isfinite(u.x + u.y + u.z + ratio + response.sound_speed);

  const double mass = static_cast<double>(context.step.mass), volume = static_cast<double>(context.step.volume);
  const double kinetic = static_cast<double>(kinetic_energy(gathered, scattered, context.step)) * mass;
  sums.energy += {.kinetic = kinetic,
                  .kept_kinetic = context.set.transfer.keeps_velocity() ? kinetic : 0,
                  .viscous = static_cast<double>(response.dissipation.viscous) * volume,
                  .plastic = static_cast<double>(response.dissipation.plastic) * volume,
                  .relaxed = static_cast<double>(response.dissipation.relaxed) * volume};

  bool shifts = colliders;
  if constexpr (VolumeRelaxed<M>)
    if (measures<M>(context.step.volume_relaxation)) {
      shifts = true;
      sums.swollen += static_cast<double>(scattered.swollen) * volume;
    }
  if (shifts) {
    const Vec3d shifted = static_cast<Vec3d>(scattered.shifted) * (context.set.mass * context.world.dx);
    sums.shifted += shifted, sums.turned += cross(shifted, static_cast<Vec3d>(scattered.own_velocity));
  }
}

template <class R>
void write_motion(const SetContext<R>& context, const PassParticle<R>& particle, typename Motion<R>::Set& motion) {
  motion.velocity.push_back(particle.scattered.own_velocity);
  motion.gradient.push_back(affine_velocity(particle.gathered.affine_moment, context.step.dx));
  motion.energy.push_back(particle.response.energy);
  motion.volume_ratio.push_back(particle.volume_ratio);
}

}  // namespace dreampm::reference
