// A world as the particle file of a frame.
#pragma once
#include <string>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/io/ply.h"
#include "dreampm/simulation/assemble.h"

namespace dreampm {

/// Where places in files count from [m], along each axis: 0 where a float holds the places in the
/// scene to a thousandth of the spacing, or counting from elsewhere gains nothing; else the low end
/// of the space.
Vec3d file_shift(const scene::Space& space);

/// Particles in the order of their ids. `attributes`: of scene::particle_attributes; pressure, jp
/// and f read MatterFields::state, all read id, position and motion.
template <class R>
ParticleFrame particle_frame(const World<R>& world, const Motion<R>& motion, const std::vector<BodyRange>& bodies,
                             const std::vector<std::string>& attributes, const Vec3d& shift);

}  // namespace dreampm
