// The grid after an edit.
#pragma once
#include "dreampm/backend/backend.h"

namespace dreampm {

/// After an edit of a world's particles, laws, walls or gravity: sorts the particles, chooses the
/// next step anew, and forms the grid from them as they stand, with the forces of the laws as they
/// are. Nothing of the former grid is left. `motion`: velocities in the particles' order; returned
/// in the order after the sort. Throws NumericalFailure.
template <class R>
void form_grid(World<R>& world, Backend<R>& backend, Motion<R>& motion);

}  // namespace dreampm
