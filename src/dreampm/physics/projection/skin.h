// The boundary layer of a liquid along a wall, on a staggered grid.
#pragma once
#include "dreampm/physics/contact.h"

namespace dreampm {

/// Velocity along a smooth wall of the cell beside it, which moves at `speed` > 0 [m/s] half a cell
/// from the wall, over what it was: after a step of `kick_per_dx` [s/m] in which the wall's shear
/// acts on the whole cell, taken implicitly. `viscosity` > 0 [m^2/s]. The shear is that of
/// Spalding's law (physics/contact.h:wall_shear).
template <class R>
DM_FN R skin_slows(const R& speed, const R& viscosity, const R& dx, const R& kick_per_dx) {
  using S = Scalar<R>;
  const R one(1);
  return one / (one + wall_shear(speed * dx * R(S(0.5)) / viscosity) * speed * kick_per_dx);
}

}  // namespace dreampm
