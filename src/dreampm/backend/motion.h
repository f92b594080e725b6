// The motion of particles, as a pass over them reports it.
#pragma once
#include <vector>

#include "dreampm/math/mat3.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// Particle velocities of a pass, in the particles' order, for output: looking never changes the
/// bits.
template <class R>
struct Motion {
  struct Set {
    std::vector<Vec3<R>> velocity;  ///< m/s
    std::vector<Mat3<R>> gradient;  ///< C [1/s]
    std::vector<R> energy;          ///< J/m^3 of rest volume
    std::vector<R> volume_ratio;    ///< J
  };
  std::vector<Set> sets;
};

}  // namespace dreampm
