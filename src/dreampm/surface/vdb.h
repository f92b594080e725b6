// The surface's field as an OpenVDB file, for other programs.
#pragma once
#include <filesystem>

#include "dreampm/surface/sparse_field.h"

namespace dreampm {

/// Writes a FloatGrid named "density" (values 0..about 1, surface at 0.5, fog-volume class) with a
/// linear transform in meters. `shift`: where places in the field count from [m]; the transform, in
/// double, has it. The file appears whole or not at all. Throws RunError with the reason if it
/// cannot be written.
void write_vdb(const std::filesystem::path& path, const SparseField& field, const Vec3d& shift = {});

}  // namespace dreampm
