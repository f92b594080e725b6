#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/log.h"
#include "dreampm/base/progress.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/import/point_file.h"
#include "dreampm/io/ply.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/pipeline/loose_files.h"
#include "dreampm/pipeline/loose_names.h"
#include "dreampm/surface/surface.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

MovingCloud read_cloud(const std::string& file) {
  Model model = read_point_file(file);
  if (!model.triangles.empty()) fail_input("{}: is a mesh; dreampm surface wraps particles", file);
  const Vec3d shift = read_ply_shift(file);
  for (Vec3d& p : model.vertices) p += shift;
  return moving_cloud(std::move(model), file);
}

void wrap(const MovingCloud& cloud, const LooseSurfaces& request, const fs::path& target) {
  const double spacing = *request.spacing;
  Box3d box;
  for (const Vec3d& p : cloud.points) box.add(p);
  const Vec3d shift = file_shift(box.min, box.max, spacing);
  std::vector<Vec3f> positions, velocities;
  positions.reserve(cloud.points.size()), velocities.reserve(cloud.velocities.size());
  for (const Vec3d& p : cloud.points) positions.push_back(static_cast<Vec3f>(p - shift));
  for (const Vec3d& v : cloud.velocities) velocities.push_back(static_cast<Vec3f>(v));
  SurfaceInput input;
  input.positions = positions, input.velocities = velocities;
  input.spacing = static_cast<float>(spacing);
  SurfaceSettings settings;
  settings.voxel = static_cast<float>(request.voxel * spacing);
  settings.smooth = request.smooth;
  write_mesh(target, reconstruct(input, settings).mesh, shift, "in the unit and the axes of its particles");
}

void check_spacing(const LooseSurfaces& request) {
  if (request.spacing && *request.spacing > 0 && std::isfinite(*request.spacing)) return;
  if (request.spacing) fail_input("--spacing is {}: must be above 0", *request.spacing);
  const std::optional<double> own = look_at_cloud(read_cloud(request.files[0]).points).spacing;
  fail_input("files need --spacing, the distance between particles{}",
             own ? fmt::format("; those of {} lie about {:.3g} apart", request.files[0], *own) : "");
}

}  // namespace

std::vector<fs::path> surface_files(const LooseSurfaces& request) {
  const std::vector<fs::path> names = loose_names(request.files, request.out, ".ply");
  check_spacing(request);
  Progress progress("surface: file", names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (interrupted()) throw Interrupted(fmt::format("surface: interrupted before {}", request.files[i]));
    progress.update(i);
    const MovingCloud cloud = read_cloud(request.files[i]);
    if (i == 0)
      for (const std::string& w : cloud_warnings(cloud.points, *request.spacing, request.files[i])) warn("{}", w);
    make_folder(request.out);
    wrap(cloud, request, names[i]);
  }
  progress.update(names.size());
  return names;
}

}  // namespace dreampm
