#include "dreampm/geometry/point_cloud.h"

#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/geometry/ply.h"

namespace dreampm {

std::vector<Vec3d> read_point_cloud(const std::filesystem::path& path, double scale) {
  if (!(scale > 0) || !std::isfinite(scale))
    fail_input("{}: a scale of {}: a number above 0 is wanted", path.string(), scale);
  std::vector<Vec3d> points = parse_ply(read_file(path), path.string(), false).vertices;
  if (points.empty()) fail_input("{}: holds no points", path.string());
  for (Vec3d& p : points) p *= scale;
  return points;
}

}  // namespace dreampm
