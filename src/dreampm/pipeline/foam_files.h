// Files of foam: one a frame, which is all that the next frame needs of it.
#pragma once
#include <filesystem>

#include "dreampm/foam/foam.h"
#include "dreampm/io/ply.h"

namespace dreampm {

struct FoamFrame {
  FoamParticles particles;
  Vec3d shift{};  ///< m, from which places count
};

/// PLY with x y z, vx vy vz, id, type, age, life and radius, through replace_file. Throws RunError
/// if it cannot be written.
void write_foam(const std::filesystem::path& file, const FoamParticles& foam, const Vec3d& shift);
/// Reads what write_foam wrote. Throws InputError naming the file and what is wrong.
FoamFrame read_foam(const std::filesystem::path& file);

}  // namespace dreampm
