// How fast sound can get in a material that an impact presses.
#pragma once
#include <string_view>

#include "dreampm/physics/param.h"

namespace dreampm::validate {

struct Crushed {
  double sound_speed = 0;  ///< m/s, the largest on the way
  double viscosity = 0;    ///< m^2/s, likewise: what bounds the step
};

/// Drives the law of a material from rest, pressed from all sides, pressed along one axis and pulled along it, until
/// `energy` [J/m^3 of rest volume] of work is done on it or it is pressed to a twentieth; `time` [s] is that of a
/// doubling or halving, for what hangs on rates. `values`: complete. Throws std::out_of_range for an unknown material.
Crushed crush(std::string_view material, const Values& values, double energy, double time);

}  // namespace dreampm::validate
