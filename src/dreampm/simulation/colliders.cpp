#include "dreampm/simulation/colliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/shell.h"
#include "dreampm/simulation/body_checks.h"
#include "dreampm/state/collider_view.h"

namespace dreampm {
namespace {

/// What would make the voxels of a shell a third of `width` [m]. They are a third of its thickness,
/// or of a cell where that is less.
std::string coarser(double width, double thickness, const scene::Space& space) {
  if (width <= space.dx()) return fmt::format("a thickness of {:.3g} m would do", width);
  return fmt::format("a space.spacing of {:.3g} m{} would do", space.spacing * width / space.dx(),
                     width > thickness ? fmt::format(" and a thickness of {:.3g} m", width) : "");
}

}  // namespace

std::shared_ptr<const Region> collider_region(const scene::Collider& collider, const scene::Space& space,
                                              const Meshes& meshes) {
  if (!collider.thickness) try {
      return collider.voxel ? make_region(collider.shape, *collider.voxel, meshes.regions(1.5 * space.dx()))
                            : make_region(collider.shape, space.spacing, meshes.fine_regions());
    } catch (const EnclosesNothing& e) {
      throw EnclosesNothing(fmt::format("{}; a collider with a `thickness` is a wall about its faces", e.what()));
    }
  const double dx = space.dx();
  const double thickness = *collider.thickness;
  try {
    // As far as the distances of other meshes reach where a cell is two spacings.
    return shell_region(collider.shape, thickness, collider.voxel.value_or(std::min(thickness, dx) / 3), 1.5 * dx,
                        meshes);
  } catch (const ShellTooLarge& e) {
    throw InputError(fmt::format("{}; {}, or a mesh that is smaller or thick by itself", e.what(),
                                 coarser(3.1 * e.voxel, thickness, space)));
  }
}

std::shared_ptr<const MeshSequence> mesh_sequence(const scene::Collider& collider, const scene::Space& space) {
  if (!collider.sequence) return nullptr;
  const auto& [files, fps, scale] = *collider.sequence;
  return std::make_shared<const MeshSequence>(files, fps, scale, collider.voxel.value_or(space.spacing),
                                              1.5 * space.dx());
}

std::shared_ptr<const MotionPath> motion_path(const std::optional<scene::Motion>& given, const Shape& shape,
                                              double spacing, const Meshes& meshes) {
  if (!given) return nullptr;
  const scene::Motion& motion = *given;
  Vec3d center{};
  if (motion.about) {
    center = *motion.about;
  } else if (const Box3d bounds = shape_bounds(shape, spacing, meshes);
             is_finite(bounds.min) && is_finite(bounds.max)) {
    center = bounds.center();
  }
  return std::make_shared<const MotionPath>(
      MotionPath{motion.keys, motion.smooth, center, motion.velocity, motion.spin});
}

void Overlap::operator+=(const Overlap& other) {
  particles += other.particles;
  depth = std::max(depth, other.depth);
}

template <class R>
Overlap matter_inside(const std::vector<Vec3d>& points, const World<R>& world, std::size_t c) {
  const Collider& collider = world.colliders[c];
  const std::vector<Vec3d> copies = periodic_copies(world, collider);
  const Box3d bounds = collider.bounds();
  const Vec3d low = world.origin, length = world.node_position(world.high) - low;
  const double slack = 1e-6 * world.dx;
  return parallel_reduce(points.size(), Overlap{}, [&](Overlap& sum, std::size_t i) {
    Vec3d p = points[i];
    for (int a = 0; a < 3; ++a)
      if (world.periodic[static_cast<std::size_t>(a)]) p[a] -= length[a] * std::floor((p[a] - low[a]) / length[a]);
    double depth = 0;
    for (const Vec3d& shift : copies)
      if (bounds.contains(p - shift)) depth = std::max(depth, -collider.distance(p - shift));
    if (depth > slack) sum += {1, depth};
  });
}
template Overlap matter_inside(const std::vector<Vec3d>&, const World<float>&, std::size_t);
template Overlap matter_inside(const std::vector<Vec3d>&, const World<double>&, std::size_t);

}  // namespace dreampm
