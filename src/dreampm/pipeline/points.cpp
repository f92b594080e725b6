#include "dreampm/pipeline/points.h"

#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/geometry/level_set.h"
#include "dreampm/io/ply.h"

namespace dreampm {

PointsReport write_points(const PointsRequest& request, const std::filesystem::path& file) {
  const auto check = [](const char* name, double v) {
    if (!(v > 0) || !std::isfinite(v)) fail_input("{} is {}: must be above 0", name, v);
  };
  check("spacing", request.spacing);
  if (request.longest && request.scale) fail_input("fit and scale are both given: one of them says the size");
  if (request.longest) check("fit", *request.longest);
  if (request.scale) check("scale", *request.scale);

  const MeshShape shape{request.model, request.longest, request.scale};
  const auto region = mesh_regions()(shape, request.spacing);
  PointsReport report;
  report.volume = level_set_volume(*region);
  const std::vector<Vec3d> points = sample_region(*region, request.spacing, request.pattern, request.seed);
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    fail_input("{}: {} points are more than a file holds; use a larger spacing", request.model, points.size());
  ParticleFrame frame;
  frame.material_names = {"points"};
  frame.material.assign(points.size(), 0);
  frame.velocity.assign(points.size(), Vec3f{});
  frame.position.reserve(points.size());
  for (const Vec3d& p : points) {
    frame.id.push_back(static_cast<std::int32_t>(frame.position.size()));
    frame.position.push_back(static_cast<Vec3f>(p));
  }
  if (file.has_parent_path()) make_folder(file.parent_path());
  write_particles(file, frame);
  report.points = points.size();
  return report;
}

}  // namespace dreampm
