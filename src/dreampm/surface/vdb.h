// A surface as a volume of OpenVDB, for other programs.
#pragma once
#include <filesystem>

#include "dreampm/geometry/mesh.h"
#include "dreampm/surface/sparse_field.h"

namespace dreampm {

/// Writes a FloatGrid named "density" of the class fog volume, with a linear transform in meters:
/// values 0 to about 1, the surface at 0.5, which its metadata call "iso". `shift`: where places in
/// the field count from [m]; the transform, in double, has it. The file appears whole or not at
/// all. Throws RunError with the reason if it cannot be written.
void write_fog_vdb(const std::filesystem::path& path, const SparseField& field, const Vec3d& shift = {});

/// Writes a FloatGrid named "surface" of the class level set: distances from a closed mesh [m]
/// within three voxels of it, negative inside. `voxel` [m] and `shift` as above.
void write_level_set_vdb(const std::filesystem::path& path, const TriMesh& mesh, float voxel, const Vec3d& shift = {});

}  // namespace dreampm
