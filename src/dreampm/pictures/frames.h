// A world as the particle file of a frame.
#pragma once
#include <string>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/io/ply.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {

/// Where places in files count from, along each axis: 0 where a float holds all places between
/// `min` and `max` to a thousandth of the spacing, or counting from elsewhere gains nothing; else
/// `min`.
Vec3d file_shift(const Vec3d& min, const Vec3d& max, double spacing);

/// Particles in the order of their ids. `attributes`: of scene::particle_attributes; pressure, jp
/// and f read MatterFields::state, all read id, position and motion.
template <class R>
ParticleFrame particle_frame(const World<R>& world, const Motion<R>& motion, const std::vector<BodyRange>& bodies,
                             const std::vector<std::string>& attributes, const Vec3d& shift);

}  // namespace dreampm
