// How fast sound can get in a material that an impact presses.
#pragma once
#include <string_view>

#include "dreampm/physics/param.h"

namespace dreampm::validate {

struct ImpactBounds {
  double sound_speed = 0;  ///< m/s, the largest on the way
  double viscosity = 0;    ///< m^2/s, what bounds the step
};

/// The load on a material.
struct Load {
  double energy = 0;  ///< J/m^3 of rest volume that it can take up
  double time = 0;    ///< s of a doubling or halving, for what hangs on rates
  double coarse = 0;  ///< the largest change of length of one step, for what hangs on how steps overshoot
};

/// Drives the law of a material from rest, pressed from all sides, pressed along one axis or pulled
/// along it, and then pulled the same ways: an impact that has packed it is followed by others.
/// Each goes on until `energy` of work is done or it is pressed or swollen twentyfold, once in fine
/// steps and once in coarse ones, which may turn a particle inside out. `values`: complete. Throws
/// std::out_of_range for an unknown material.
ImpactBounds impact(std::string_view material, const Values& values, const Load& load);

}  // namespace dreampm::validate
