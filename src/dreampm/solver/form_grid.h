// The grid after an edit.
#pragma once
#include "dreampm/backend/backend.h"

namespace dreampm {

/// Forms the grid after an edit of a world's particles, laws, walls or gravity: chooses the next
/// step anew, sorts the particles, and forms the grid from them as they stand, with the forces of
/// the laws as they are. Nothing of the former grid is left. `motion`: velocities in the particles'
/// order; returned in the order after the sort. `spare`: memory to work with, kept for the next
/// time. Throws, before anything was sorted, NumericalFailure where a particle is not finite,
/// InputError where a fixed time step is too long for the laws as they are.
template <class R>
void form_grid(World<R>& world, Backend<R>& backend, Motion<R>& motion, Motion<R>& spare);

}  // namespace dreampm
