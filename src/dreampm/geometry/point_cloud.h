// Point clouds from PLY files.
#pragma once
#include <filesystem>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

/// The vertices of a PLY file (ASCII or binary of either byte order; x y z of any number type; other properties and
/// elements are skipped), times `scale`. Throws InputError naming the file and what is wrong: missing, empty, cut
/// short, not a PLY, a count that the file cannot hold, no x y z, a point that is not finite, no points.
std::vector<Vec3d> read_point_cloud(const std::filesystem::path& path, double scale = 1);

}  // namespace dreampm
