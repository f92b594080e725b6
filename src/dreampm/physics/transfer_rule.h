// How velocities pass between particles and grid, as four numbers (Fei et al. 2021, section 4 and
// its table of schemes; the memory is ours).
#pragma once
#include <string_view>

#include "dreampm/math/explog.h"
#include "dreampm/math/scalar.h"
#include "dreampm/math/vec.h"
#include "dreampm/physics/member_param.h"

namespace dreampm {

template <class S>
struct TransferRule {
  S affine = 1;   ///< share of C that goes to the grid
  S blend = 0;    ///< v_p' = v + blend (v_p - v_before): v of the grid now, v_before of the grid before its forces
  S advance = 0;  ///< x' = x + dt (v + advance blend (v_p - v_before)) where matter separates (law.h)
  S memory = 0;   ///< s: a step of dt keeps blend exp(-dt/memory), the same for steps of any length; 0: blend

  /// Returns the share of own velocities that a step of dt [s] keeps. It is never 0, as the grid's
  /// velocities are weighed by it.
  S kept(S dt) const { return memory > S(0) ? blend * max(exp(-dt / memory), S(1e-3)) : blend; }
  /// Particles store a velocity, and the grid the one before its forces.
  DM_FN bool keeps_velocity() const { return blend > S(0); }
  template <class T>
  explicit operator TransferRule<T>() const {
    return {static_cast<T>(affine), static_cast<T>(blend), static_cast<T>(advance), static_cast<T>(memory)};
  }
};

}  // namespace dreampm
