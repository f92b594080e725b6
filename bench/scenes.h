// The scenes that are measured: matter of one material, 8 particles a cell, moving a twentieth of a
// cell a step, so that sorting has its share.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dreampm/physics/param.h"
#include "dreampm/state/regroup.h"
#include "dreampm/state/world.h"

namespace dreampm {

inline constexpr double bench_dx = 0.02;  ///< m, a cell

/// A world without matter yet, and its matter: what begin() takes.
struct BenchScene {
  World<float> world;
  std::vector<std::vector<ParticleSeed>> seeds;
};

/// A column of that many cells in the corner of a box twice as long and one and a half times as
/// high, collapsing.
BenchScene column_scene(const MaterialInfo& material, const Vec3i& cells);

/// Returns a scene of that many cells of a material at rest, from wall to wall in a box half as
/// high again.
BenchScene tank_scene(const MaterialInfo& material, const Vec3i& cells);

/// Drops of 8 particles in a cell each, 8 cells apart, so that no node takes part in two; falling.
BenchScene droplets_scene(const MaterialInfo& material, std::uint64_t count);

/// A cube of `width`^3 cells that falls in the middle of a domain of `domain` cells.
BenchScene drop_scene(const MaterialInfo& material, int width, const Vec3i& domain);

/// Returns the material of that name. Throws InputError where there is none.
const MaterialInfo& bench_material(const std::string& name);

/// Throws InputError for a number of particles with which nothing can be measured.
void check_particles(std::uint64_t particles);

/// Cells of a column of about `particles` particles, of the shape 2:2:1.
Vec3i column_cells(std::uint64_t particles);

}  // namespace dreampm
