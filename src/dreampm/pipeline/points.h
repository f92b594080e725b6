// A model as a point cloud.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/geometry/sample.h"

namespace dreampm {

struct PointsRequest {
  std::string model;              ///< a mesh or a point cloud, or asset:NAME
  double spacing = 0;             ///< m, between points; > 0
  std::optional<double> longest;  ///< m: the model's longest side becomes this
  std::optional<double> scale;    ///< or a plain factor
  Pattern pattern = Pattern::jitter;
  std::uint64_t seed = 1;
};

struct PointsReport {
  std::size_t points = 0;
  std::optional<double> volume;       ///< m^3, of the model's level set; absent for a point cloud
  std::vector<std::string> warnings;  ///< points that hold another volume than the model; clouds of another spacing
  double nearest = 0;                 ///< m, between the two nearest points; resolved up to the spacing
  std::size_t outside = 0;            ///< points outside the level set
};

/// Fills the model with points, about its own coordinates, and writes them as a particle PLY. A
/// point cloud is taken as it is, one particle a point, with the velocities, ids and colors of its
/// file, and only scaled. Coordinates are written as
/// float, or as double where float does not hold a thousandth of the spacing. Throws InputError for
/// a spacing, fit or scale that is not above 0, both of these at once, a model that cannot be read
/// or encloses nothing, and one in which no point lies, with the spacing that would do.
PointsReport write_points(const PointsRequest& request, const std::filesystem::path& file);

}  // namespace dreampm
