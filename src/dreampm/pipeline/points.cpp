#include "dreampm/pipeline/points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/parallel.h"
#include "dreampm/import/asset.h"
#include "dreampm/import/import.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/io/ply.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/setup/body_checks.h"
#include "dreampm/surface/cells.h"

namespace dreampm {
namespace {

/// Nothing of a mesh.
std::optional<MovingCloud> scaled_cloud(const PointsRequest& request) {
  if (is_asset(request.model)) return std::nullopt;
  std::optional<MovingCloud> cloud = read_if_cloud(request.model, request.scale.value_or(1));
  if (!cloud || !request.longest) return cloud;
  Box3d bounds;
  for (const Vec3d& p : cloud->points) bounds.add(p);
  const Vec3d size = bounds.size();
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0)) fail_input("{}: all its points lie in one place: fit cannot scale it", request.model);
  for (Vec3d& p : cloud->points) p *= *request.longest / longest;
  for (Vec3d& v : cloud->velocities) v *= *request.longest / longest;
  return cloud;
}

/// Whether coordinates in float are off by less than a thousandth of a spacing.
bool float_holds(const std::vector<Vec3d>& points, double spacing) {
  double farthest = 0;
  for (const Vec3d& p : points) farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return farthest * std::numeric_limits<float>::epsilon() < 1e-3 * spacing;
}

constexpr std::int64_t most_id = std::numeric_limits<std::int32_t>::max();
/// The first point whose id is beyond what a file of particles holds.
std::optional<std::size_t> beyond_id(const std::vector<std::int64_t>& ids) {
  const auto found =
      std::find_if(ids.begin(), ids.end(), [](std::int64_t id) { return id < -most_id || id > most_id; });
  if (found == ids.end()) return std::nullopt;
  return static_cast<std::size_t>(found - ids.begin());
}

/// The cloud as particles, with what its file says of them; points without ids are counted.
ParticleFrame particles_of(const MovingCloud& cloud, double spacing) {
  const std::size_t n = cloud.points.size();
  ParticleFrame frame;
  frame.material_names = {"points"};
  frame.material.assign(n, 0);
  frame.velocity.assign(n, Vec3f{});
  for (std::size_t i = 0; i < cloud.velocities.size(); ++i) frame.velocity[i] = static_cast<Vec3f>(cloud.velocities[i]);
  if (!float_holds(cloud.points, spacing)) frame.exact = cloud.points;
  frame.position.reserve(n), frame.id.reserve(n);
  const bool ids = !cloud.ids.empty() && !beyond_id(cloud.ids);
  for (std::size_t i = 0; i < n; ++i) {
    frame.position.push_back(static_cast<Vec3f>(cloud.points[i]));
    frame.id.push_back(static_cast<std::int32_t>(ids ? cloud.ids[i] : static_cast<std::int64_t>(i)));
  }
  frame.color = cloud.colors;
  return frame;
}

/// The distance of the two nearest points, or `most` if none are nearer than that.
double nearest_pair(const std::vector<Vec3f>& points, float most) {
  const surface::CellGrid cells(points, most);
  std::vector<float> least(points.size() / 4096 + 1, most * most);
  parallel_for(least.size(), 1, [&](std::size_t part) {
    for (std::size_t i = part * 4096; i < std::min(points.size(), (part + 1) * 4096); ++i) {
      const float r = std::sqrt(least[part]);
      const Vec3f reach{r, r, r};
      surface::for_cells(cells, points[i] - reach, points[i] + reach, [&](std::size_t c) {
        for (std::uint32_t k = cells.first[c]; k < cells.first[c + 1]; ++k)
          if (cells.order[k] != i) least[part] = std::min(least[part], length2(points[cells.order[k]] - points[i]));
      });
    }
  });
  return std::sqrt(*std::min_element(least.begin(), least.end()));
}

/// In float, which holds distances within the cloud wherever it lies.
std::vector<Vec3f> about_first(const std::vector<Vec3d>& points) {
  std::vector<Vec3f> local;
  for (const Vec3d& p : points) local.push_back(static_cast<Vec3f>(p - points[0]));
  return local;
}

std::size_t count_outside(const Region& region, const std::vector<Vec3d>& points) {
  std::vector<std::size_t> outside(points.size() / 4096 + 1);
  parallel_for(outside.size(), 1, [&](std::size_t part) {
    for (std::size_t i = part * 4096; i < std::min(points.size(), (part + 1) * 4096); ++i)
      outside[part] += region.distance(points[i]) >= 0;
  });
  std::size_t all = 0;
  for (const std::size_t n : outside) all += n;
  return all;
}

}  // namespace

PointsReport write_points(const PointsRequest& request, const std::filesystem::path& file) {
  const auto check = [](const char* name, double v) {
    if (!(v > 0) || !std::isfinite(v)) fail_input("{} is {}: must be above 0", name, v);
  };
  check("spacing", request.spacing);
  if (request.longest && request.scale) fail_input("fit and scale are both given: one of them says the size");
  if (request.longest) check("fit", *request.longest);
  if (request.scale) check("scale", *request.scale);

  PointsReport report;
  MovingCloud cloud;
  std::vector<Vec3d>& points = cloud.points;
  if (std::optional<MovingCloud> own = scaled_cloud(request)) {
    cloud = std::move(*own);
    report.warnings = cloud_warnings(points, request.spacing, request.model);
    if (const auto at = beyond_id(cloud.ids))
      report.warnings.push_back(
          fmt::format("{}: the id of point {} is {}; a particle file holds {} to {}, so all points are counted anew",
                      request.model, *at, cloud.ids[*at], -most_id, most_id));
  } else {
    const Shape shape{MeshShape{request.model, request.longest, request.scale}, {}, 0, {}};
    const Meshes meshes(Meshes::Say::log);
    const Sampling sampling{request.pattern, request.seed};
    const auto region = body_region(shape, request.spacing, sampling, meshes);
    report.volume = level_set_volume(*region);
    points = sample_region(*region, request.spacing, request.pattern, request.seed);
    if (points.empty())
      fail_input("{}: holds no point at a spacing of {} m, which is too coarse for it{}", request.model,
                 request.spacing, finer_spacing(shape, request.spacing, sampling, meshes));
    VolumeCheck volumes(request.spacing, meshes);
    volumes.add(request.model, shape, *region, sampling, points.size());
    report.warnings = volumes.warnings();
    report.outside = count_outside(*region, points);
  }
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    fail_input("{}: {} points are more than a file holds; use a larger spacing", request.model, points.size());
  if (file.has_parent_path()) make_folder(file.parent_path());
  write_particles(file, particles_of(cloud, request.spacing));
  report.points = points.size();
  report.nearest = nearest_pair(about_first(points), static_cast<float>(request.spacing));
  return report;
}

}  // namespace dreampm
