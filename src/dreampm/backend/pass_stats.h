// The report of a pass over the particles. Kernels add to it too, so this header needs vectors
// alone.
#pragma once
#include <cstdint>

#include "dreampm/math/vec.h"

namespace dreampm {

/// Energies of the particles in a pass [J].
struct PassEnergy {
  double kinetic = 0;
  double kept_kinetic = 0;                       ///< the part of sets that keep velocities
  double viscous = 0, plastic = 0, relaxed = 0;  ///< parts turned into heat in this step
  PassEnergy& operator+=(const PassEnergy& b) {
    const auto& [b_kinetic, b_kept_kinetic, b_viscous, b_plastic, b_relaxed] = b;
    kinetic += b_kinetic, kept_kinetic += b_kept_kinetic;
    viscous += b_viscous, plastic += b_plastic, relaxed += b_relaxed;
    return *this;
  }
};

/// The result of one pass over every particle.
struct PassStats {
  double wave_speed = 0;  ///< m/s
  double viscosity = 0;   ///< m^2/s
  double j_min = 1e30, j_max = -1e30;
  std::uint64_t pushed = 0;  ///< particles that a wall had to push back inside
  bool finite = true;
  PassEnergy energy;
  Vec3d shifted{};     ///< mass times shift of the liquids [kg m]
  Vec3d turned{};      ///< angular momentum gained by shifts [kg m^2/s]
  double swollen = 0;  ///< volume of liquids beyond that at rest [m^3] (P2GTerms::swollen)
  void add(const PassStats& b);
};

}  // namespace dreampm
