#include "dreampm/pipeline/loose_clouds.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/surface/surface.h"

namespace dreampm {

void check_spacing(const std::optional<double>& spacing, const std::vector<Vec3d>& points, const std::string& file) {
  if (spacing && *spacing > 0 && std::isfinite(*spacing)) return;
  if (spacing) fail_input("--spacing is {}: must be above 0", *spacing);
  const std::optional<double> own = look_at_cloud(points).spacing;
  fail_input("files need --spacing, the distance between particles{}",
             own ? fmt::format("; those of {} lie about {:.3g} apart", file, *own) : "");
}

void check_extent(const std::vector<Vec3d>& points, double spacing, const std::string& file) {
  Box3d box;
  for (const Vec3d& p : points) box.add(p);
  const Vec3d size = box.size();
  if (std::max({size.x, size.y, size.z}) <= static_cast<double>(surface_reach) * spacing) return;
  Vec3d middle;  // of most: the median along each axis
  std::vector<double> along(points.size());
  for (int a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = points[i][a];
    const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), half, along.end());
    middle[a] = *half;
  }
  const auto farthest = std::max_element(points.begin(), points.end(), [&](const Vec3d& a, const Vec3d& b) {
    return length(a - middle) < length(b - middle);
  });
  fail_input(
      "{}: point {} at ({:.6g}, {:.6g}, {:.6g}) lies {:.2g} spacings of {:.3g} from most others, over {:.0f}: leave it "
      "out, or use a larger --spacing",
      file, farthest - points.begin(), farthest->x, farthest->y, farthest->z, length(*farthest - middle) / spacing,
      spacing, surface_reach);
}

}  // namespace dreampm
