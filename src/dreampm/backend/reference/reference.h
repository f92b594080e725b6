// The reference for other backends: scalar loops over the particles in the order of the papers, in
// float or double. Slow on purpose. particle_pass.h is where to begin.
#pragma once
#include <memory>

#include "dreampm/backend/backend.h"

namespace dreampm {

template <class R>
std::unique_ptr<Backend<R>> make_reference_backend();

}  // namespace dreampm
