#include "dreampm/contact/body_surface.h"

#include <Eigen/Dense>
#include <cmath>

#include "dreampm/contact/surface_points.h"

namespace dreampm {
namespace {

/// Voxels along a cell with which the volume of a shape is found.
constexpr int volume_voxels = 4;

/// Sums over points that the divergence theorem gives: of the normals, and of the normals times
/// each coordinate.
constexpr int sums = 12;
using Sums = Eigen::Matrix<double, sums, 1>;

/// A point's part of the sums for each area [1]; `from_middle` in cells.
Sums part_of(const Vec3d& from_middle, const Vec3d& normal, double scale) {
  Sums part;
  for (int k = 0; k < 3; ++k) {
    part[k] = normal[k];
    for (int j = 0; j < 3; ++j) part[3 + 3 * j + k] = from_middle[j] * normal[k] * scale;
  }
  return part;
}

/// Corrects the areas; `volume` in dx^3.
void keep_divergence_theorem(std::vector<SurfacePatch>& patches, const Vec3d& middle, double volume) {
  const double scale = 1 / std::cbrt(volume);  // all sums are then alike in size
  Sums missing = Sums::Zero();
  for (int k = 0; k < 3; ++k) missing[3 + 4 * k] = volume * scale;
  Eigen::Matrix<double, sums, sums> products = Eigen::Matrix<double, sums, sums>::Zero();
  for (const SurfacePatch& p : patches) {
    const Sums part = part_of(p.at - middle, p.normal, scale);
    missing -= part * p.area;
    products += part * part.transpose() * p.area;
  }
  // A rank-revealing solver: some sums of a box are 0 whatever the areas.
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix<double, sums, sums>> solve;
  solve.setThreshold(1e-9);
  const Sums multipliers = solve.compute(products).solve(missing);
  for (SurfacePatch& p : patches) p.area *= std::max(0.0, 1 + multipliers.dot(part_of(p.at - middle, p.normal, scale)));
}

}  // namespace

std::vector<BodyPoint> body_points(const std::shared_ptr<const Region>& shape, double dx) {
  Collider alone;
  alone.shape = shape;
  const Box3d bounds = shape->bounds();
  int half[3];
  Vec3d first;
  for (int a = 0; a < 3; ++a) {
    half[a] = static_cast<int>(std::ceil(0.5 * bounds.size()[a] / dx)) + 1;
    first[a] = bounds.center()[a] - half[a] * dx;
  }
  const std::vector<PlacedCollider> placed{{alone, {Vec3d{}}}};
  const ColliderView view(placed, first, dx);
  std::vector<SurfacePatch> patches;
  for (int i = 0; i < 2 * half[0]; ++i)
    for (int j = 0; j < 2 * half[1]; ++j)
      for (int k = 0; k < 2 * half[2]; ++k) add_patches(view, static_cast<Vec3d>(Vec3i{i, j, k}), patches);
  const double volume = region_volume(*shape, dx / volume_voxels) / (dx * dx * dx);
  keep_divergence_theorem(patches, static_cast<Vec3d>(Vec3i{half[0], half[1], half[2]}), volume);
  std::vector<BodyPoint> points;
  points.reserve(patches.size());
  for (const SurfacePatch& p : patches) points.push_back({first + p.at * dx, p.normal, p.from_edge, p.area});
  return points;
}

}  // namespace dreampm
