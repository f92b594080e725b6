// Point clouds from files.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/geometry/model.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// The points of a file (point_file.h), times `scale`. Throws InputError naming the file and what
/// is wrong: what its reader refuses, no points.
std::vector<Vec3d> read_point_cloud(const std::filesystem::path& path, double scale = 1);

struct MovingCloud {
  std::vector<Vec3d> points;                        ///< m
  std::vector<Vec3d> velocities;                    ///< m/s, one a point, or empty
  std::vector<std::int64_t> ids;                    ///< as the file has them, or empty
  std::vector<std::array<std::uint8_t, 4>> colors;  ///< red green blue alpha, or empty
};
/// The same with what else the file says of its points; `scale` is for places and velocities.
MovingCloud read_moving_cloud(const std::filesystem::path& path, double scale = 1);

/// The cloud of a model that was read from the file `name`, whose warnings go to the log.
MovingCloud moving_cloud(Model model, const std::string& name, double scale = 1);

/// The spacing of a cloud, found from its points.
struct CloudLook {
  std::optional<double> spacing;  ///< m, about the side of the cube that each point has for itself; absent for a few
  std::size_t coincident = 0;     ///< points in the place of another
};

/// The spacing is the median distance to the fourth of the nearest neighbors, which in a lattice,
/// a shaken one and among points by chance is that of the cells, inside and at faces, within 10 %;
/// points in one place count once.
CloudLook look_at_cloud(const std::vector<Vec3d>& points);

/// Returns warnings about a cloud whose points count as spacing^3 each: points in one place, and a
/// spacing of its own that is more than a quarter off. `name` is for the text.
std::vector<std::string> cloud_warnings(const std::vector<Vec3d>& points, double spacing, const std::string& name);

}  // namespace dreampm
