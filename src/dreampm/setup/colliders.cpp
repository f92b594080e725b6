#include "dreampm/setup/colliders.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/contact/collider_view.h"
#include "dreampm/level_set/shell.h"
#include "dreampm/setup/body_checks.h"

namespace dreampm {
namespace {

/// Returns the advice that would make the voxels of a shell a third of `width` [m]. They are a
/// third of its thickness, or of a cell where that is less.
std::string coarser(double width, double thickness, const model::Space& space) {
  if (width <= space.dx()) return fmt::format("a thickness of {:.3g} m would do", width);
  return fmt::format("a space.spacing of {:.3g} m{} would do", space.spacing * width / space.dx(),
                     width > thickness ? fmt::format(" and a thickness of {:.3g} m", width) : "");
}

}  // namespace

std::shared_ptr<const Region> collider_region(const model::Collider& collider, const model::Space& space,
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
    // The reach is as far as the distances of other meshes where a cell is two spacings.
    return shell_region(collider.shape, thickness, collider.voxel.value_or(std::min(thickness, dx) / 3), 1.5 * dx,
                        meshes);
  } catch (const ShellTooLarge& e) {
    throw InputError(fmt::format("{}; {}, or a mesh that is smaller or thick by itself", e.what(),
                                 coarser(3.1 * e.voxel, thickness, space)));
  }
}

std::shared_ptr<const MeshSequence> mesh_sequence(const model::Collider& collider, const model::Space& space) {
  if (!collider.sequence) return nullptr;
  const auto& [files, fps, scale] = *collider.sequence;
  return std::make_shared<const MeshSequence>(files, fps, scale, collider.voxel.value_or(space.spacing),
                                              1.5 * space.dx());
}

std::shared_ptr<const MotionPath> motion_path(const std::optional<model::Motion>& given, const Shape& shape,
                                              double spacing, const Meshes& meshes) {
  if (!given) return nullptr;
  const model::Motion& motion = *given;
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

Collider make_collider(const model::Collider& given, const model::Scene& scene, double time, const Meshes& meshes) {
  const model::Space& space = scene.space;
  Collider made{given.name, collider_region(given, space, meshes), given.type, given.friction, given.sticky,
                given.holds};
  made.path = motion_path(given.motion, given.shape, space.spacing, meshes);
  made.changing = mesh_sequence(given, space);
  made.surface_time = time;
  made.take_shape();
  made.follow(time, 1 / scene.time.fps);
  made.surface_pose = made.pose;
  return made;
}

void Overlap::operator+=(const Overlap& other) {
  particles += other.particles;
  depth = std::max(depth, other.depth);
}

namespace {

/// The depth of points in a collider [m], where it and they are repeated.
template <class R>
class Depth {
 public:
  Depth(const World<R>& world, std::size_t c)
      : world_(world),
        collider_(world.colliders[c]),
        copies_(periodic_copies(world, collider_)),
        bounds_(collider_.bounds()),
        length_(world.node_position(world.high) - world.origin) {}

  /// 0 outside, and on a face.
  double operator()(Vec3d p) const {
    for (int a = 0; a < 3; ++a)
      if (world_.periodic[static_cast<std::size_t>(a)])
        p[a] -= length_[a] * std::floor((p[a] - world_.origin[a]) / length_[a]);
    double depth = 0;
    for (const Vec3d& shift : copies_)
      if (bounds_.contains(p - shift)) depth = std::max(depth, -collider_.distance(p - shift));
    return depth > 1e-6 * world_.dx ? depth : 0;
  }

 private:
  const World<R>& world_;
  const Collider& collider_;
  std::vector<Vec3d> copies_;
  Box3d bounds_;
  Vec3d length_;
};

}  // namespace

template <class R>
Overlap matter_inside(const std::vector<Vec3d>& points, const World<R>& world, std::size_t c) {
  const Depth<R> depth_of(world, c);
  return parallel_reduce(points.size(), Overlap{}, [&](Overlap& sum, std::size_t i) {
    if (const double depth = depth_of(points[i]); depth > 0) sum += {1, depth};
  });
}
template Overlap matter_inside(const std::vector<Vec3d>&, const World<float>&, std::size_t);
template Overlap matter_inside(const std::vector<Vec3d>&, const World<double>&, std::size_t);

template <class R>
std::vector<bool> are_inside(const std::vector<Vec3d>& points, const World<R>& world,
                             const std::vector<std::size_t>& colliders) {
  std::vector<char> inside(points.size(), 0);  // a vector of bool is not written to by several threads
  for (const std::size_t c : colliders) {
    const Depth<R> depth_of(world, c);
    parallel_for(points.size(), 256, [&](std::size_t i) {
      if (!inside[i]) inside[i] = depth_of(points[i]) > 0;
    });
  }
  return {inside.begin(), inside.end()};
}
template std::vector<bool> are_inside(const std::vector<Vec3d>&, const World<float>&, const std::vector<std::size_t>&);
template std::vector<bool> are_inside(const std::vector<Vec3d>&, const World<double>&, const std::vector<std::size_t>&);

}  // namespace dreampm
