// A world as the particle file of a frame.
#pragma once
#include <string>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/io/ply.h"
#include "dreampm/pipeline/assemble.h"

namespace dreampm {

/// Particles in the order of their ids. `attributes`: of scene::particle_attributes.
template <class R>
ParticleFrame particle_frame(const World<R>& world, const Motion<R>& motion, const std::vector<BodyRange>& bodies,
                             const std::vector<std::string>& attributes);

}  // namespace dreampm
