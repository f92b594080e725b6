#include "dreampm/level_set/shell.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/base/error.h"
#include "dreampm/import/import.h"
#include "dreampm/level_set/vdb_distance.h"

namespace dreampm {
namespace {

Box3d grown(Box3d box, double by) {
  const Vec3d all{by, by, by};
  box.min -= all, box.max += all;
  return box;
}

/// About the faces of a mesh: distances from them, on a grid.
class MeshShell final : public Region {
 public:
  MeshShell(BrickGrid field, const Vec3d& origin, double voxel, double half, const Box3d& bounds)
      : field_(std::move(field)), origin_(origin), voxel_(voxel), half_(half), bounds_(bounds) {}

  double distance(const Vec3d& p) const override { return field_.sample((p - origin_) / voxel_) * voxel_ - half_; }
  Vec3d normal(const Vec3d& p) const override { return field_.direction((p - origin_) / voxel_); }
  Box3d bounds() const override { return bounds_; }

 private:
  BrickGrid field_;
  Vec3d origin_;
  double voxel_, half_;
  Box3d bounds_;
};

/// About the surface of a region.
class Shell final : public Region {
 public:
  Shell(std::shared_ptr<const Region> of, double half) : of_(std::move(of)), half_(half) {}
  double distance(const Vec3d& p) const override { return std::abs(of_->distance(p)) - half_; }
  void distances(const PointColumns& points, double* to) const override {
    of_->distances(points, to);
    for (std::size_t i = 0; i < points.count; ++i) to[i] = std::abs(to[i]) - half_;
  }
  Vec3d normal(const Vec3d& p) const override {
    const Vec3d n = of_->normal(p);
    return of_->distance(p) < 0 ? -n : n;
  }
  Box3d bounds() const override {
    const Box3d box = of_->bounds();
    return box.empty() ? box : grown(box, half_);
  }

 private:
  std::shared_ptr<const Region> of_;
  double half_;
};

/// Bytes of the grid: voxels in a band on both sides of the faces, whole bricks of them, and a
/// number a brick.
double bytes_of(double area, const Vec3d& size, double band, double voxel) {
  const double bricks = (size.x / voxel / 8 + 3) * (size.y / voxel / 8 + 3) * (size.z / voxel / 8 + 3);
  return 4 * std::min(512 * bricks, area / (voxel * voxel) * (2 * band + 12)) + 4 * bricks;
}

}  // namespace

std::shared_ptr<const Region> mesh_shell(const Model& mesh, double factor, double thickness, double voxel, double reach,
                                         const std::string& name) {
  if (!(thickness > 0) || !std::isfinite(thickness))
    fail_input("a thickness of {} m: a length above 0 is wanted", thickness);
  if (!(voxel > 0) || !std::isfinite(voxel)) fail_input("a voxel of {} m: a length above 0 is wanted", voxel);
  if (mesh.triangles.empty()) fail_input("{}: has no faces", name);
  Box3d bounds = bounds_of(mesh);
  bounds.min *= factor, bounds.max *= factor;
  const Vec3d size = bounds.size(), origin = bounds.center();
  const double area = surface_area(mesh) * factor * factor;
  constexpr double most_bytes = 1 << 30;
  const auto bytes = [&](double v) {
    return bytes_of(area, size, (0.5 * std::max(thickness, 3 * v) + std::max(reach, 4.5 * v)) / v + 1, v);
  };
  if (!(bytes(voxel) < most_bytes)) {
    double enough = voxel;
    while (!(bytes(enough) < most_bytes) && enough < 1e30) enough *= 1.05;
    throw ShellTooLarge(fmt::format("{}: a shell {:.4g} m thick about {:.4g} m^2 would need {:.3g} GiB", name,
                                    thickness, area, bytes(voxel) / most_bytes),
                        enough);
  }
  TriMesh local;
  local.vertices.reserve(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) local.vertices.push_back(Vec3f((v * factor - origin) / voxel));
  local.triangles = mesh.triangles;
  const auto band = static_cast<float>((0.5 * thickness + reach) / voxel + 1);
  return std::make_shared<MeshShell>(unsigned_distance(local, band), origin, voxel, 0.5 * thickness,
                                     grown(bounds, 0.5 * thickness));
}

std::shared_ptr<const Region> shell_region(const Shape& shape, double thickness, double voxel, double reach,
                                           const Meshes& meshes) {
  if (std::holds_alternative<MeshShape>(shape.form)) return make_region(shape, voxel, meshes.shells(thickness, reach));
  // The meshes in it must know how deep half the thickness is.
  return std::make_shared<Shell>(make_region(shape, voxel, meshes.regions(0.5 * thickness + reach)), 0.5 * thickness);
}

}  // namespace dreampm
