// A world as the particle file of a frame.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/io/ply.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {

/// Where places in files count from, along each axis: 0 where a float holds all places between
/// `min` and `max` to a thousandth of the spacing, or counting from elsewhere gains nothing; else
/// `min`.
Vec3d file_shift(const Vec3d& min, const Vec3d& max, double spacing);

/// The columns that an attribute of particles has: nine of a matrix, else one of its name.
std::vector<std::string> columns_of(std::string_view attribute);
/// What particles of a material keep beside `f` and `jp`, by name.
std::vector<std::string> other_columns(std::string_view material);
/// Adds a column of set `s`, in the order of its particles; of `f` and `jp`, which its material may
/// not have, what they are at rest. Reads MatterFields::position, state and motion.
template <class R>
void add_column(const World<R>& world, const Motion<R>& motion, std::size_t s, std::string_view column,
                std::vector<float>& out);

/// Particles in the order of their ids. `attributes`: of model::particle_attributes; of what came
/// in from emitters, color is of its emitter. pressure, jp
/// and f read MatterFields::state, all read id, position and motion.
template <class R>
ParticleFrame particle_frame(const World<R>& world, const Motion<R>& motion, const std::vector<BodyRange>& bodies,
                             const std::vector<std::string>& attributes, const Vec3d& shift);

}  // namespace dreampm
