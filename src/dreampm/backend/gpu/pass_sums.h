// Sums and bounds over the particles of a pass on a device, from threads to blocks to all of a set.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/arena.h"
#include "dreampm/physics/particle.h"

namespace dreampm::gpu {

/// Sums in numbers of type N. Without constructors, as they lie in the memory of a block.
template <class N>
struct PassSums {
  float wave_speed, viscosity, j_min, j_max;
  N kinetic, viscous, plastic, relaxed;  ///< by mass [J/kg], and by volume at rest [J/m^3]
  N swollen;                             ///< by volume at rest [1]
  N shifted[3], turned[3];               ///< cells, and cells m/s
  ScatterBounds scattered;
  /// Counts of mass that particles gave, less those that came to nodes: not 0 where a node's ran
  /// over.
  std::int64_t counts;
  std::uint32_t pushed;
  bool finite;

  static DM_FN PassSums none() {
    return {0, 0, 1e30f, -1e30f, 0, 0, 0, 0, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, 0, 0}, 0, 0, true};
  }

  /// Adds one particle, now at `u`.
  template <class M>
  DM_FN void add_particle(const SetStep<float>& step, const BlockWalls<float>& walls, const G2PResult<float>& g,
                          const P2GTerms<float>& s, float j, const StressResponse<float>& response,
                          const Vec3<float>& u, bool was_pushed) {
    wave_speed = max(response.sound_speed, wave_speed);
    viscosity = max(response.kinematic_viscosity, viscosity);
    j_min = min(j, j_min), j_max = max(j, j_max);
    if (was_pushed) ++pushed;
    kinetic += kinetic_energy(g, s, step);
    viscous += response.dissipation.viscous;
    plastic += response.dissipation.plastic;
    relaxed += response.dissipation.relaxed;
    bool shifts = walls.colliders;
    if constexpr (VolumeRelaxed<M>)
      if (measures<M>(step.volume_relaxation)) {
        shifts = true;
        swollen += s.swollen;
      }
    if (shifts) {
      const Vec3<float> turn = cross(s.shifted, s.own_velocity);
      for (int a = 0; a < 3; ++a) shifted[a] += s.shifted[a], turned[a] += turn[a];
    }
    float all = u.x + u.y + u.z + j + response.sound_speed + s.q.x + s.q.y + s.q.z;
    for (int a = 0; a < 3; ++a) all += s.slope[a].x + s.slope[a].y + s.slope[a].z;
    const Sym3<float>& tau = response.tau;
    all += tau.xx + tau.xy + tau.xz + tau.yy + tau.yz + tau.zz;
    finite = finite && all - all == 0;
  }

  template <class Other>
  DM_FN void add(const PassSums<Other>& b) {
    wave_speed = max(wave_speed, b.wave_speed), viscosity = max(viscosity, b.viscosity);
    j_min = min(j_min, b.j_min), j_max = max(j_max, b.j_max);
    kinetic += b.kinetic, viscous += b.viscous, plastic += b.plastic, relaxed += b.relaxed, swollen += b.swollen;
    for (int a = 0; a < 3; ++a) shifted[a] += b.shifted[a], turned[a] += b.turned[a];
    scattered = largest(scattered, b.scattered);
    counts += b.counts;
    pushed += b.pushed;
    finite = finite && b.finite;
  }
};

/// Of the particles of one thread, and of a block's threads: a few hundred, of which floats lose
/// nothing that a ledger would see.
using ParticleSums = PassSums<float>;
/// Of a block of particles, and of all of a set.
using BlockSums = PassSums<double>;

}  // namespace dreampm::gpu
