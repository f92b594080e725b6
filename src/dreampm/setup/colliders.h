// Colliders of a scene as regions, and whether matter starts inside of them.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/level_set/level_set.h"
#include "dreampm/level_set/mesh_sequence.h"
#include "dreampm/model/scene.h"
#include "dreampm/solver/solids_in_the_way.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Returns the region that a collider fills: the inside of its shape, or the shell about its
/// surface if it has a thickness.
std::shared_ptr<const Region> collider_region(const model::Collider& collider, const model::Space& space,
                                              const Meshes& meshes);

/// Returns the sequence of a collider that is one; else null.
std::shared_ptr<const MeshSequence> mesh_sequence(const model::Collider& collider, const model::Space& space);

/// The motion that the scene gives a shape; null of one that stands. Without `about` the middle of
/// its bounds is what it turns about: `spacing` [m] is for meshes.
std::shared_ptr<const MotionPath> motion_path(const std::optional<model::Motion>& given, const Shape& shape,
                                              double spacing, const Meshes& meshes);

/// A collider of the scene as it stands at that time [s]; no rigid body yet. Throws InputError for
/// what cannot be read or encloses nothing.
Collider make_collider(const model::Collider& given, const model::Scene& scene, double time, const Meshes& meshes);

/// The part of a body's matter that lies inside of a collider.
struct Overlap {
  std::size_t particles = 0;
  double depth = 0;  ///< m, of the deepest particle
  void operator+=(const Overlap& other);
};
/// Returns the overlap of points with collider `c` of the world, whose box was laid. Points on a
/// face are not inside. On periodic axes both the collider and the points are repeated.
template <class R>
Overlap matter_inside(const std::vector<Vec3d>& points, const World<R>& world, std::size_t c);
/// Returns for each point true if it lies inside of one of these colliders of the world.
template <class R>
std::vector<bool> are_inside(const std::vector<Vec3d>& points, const World<R>& world,
                             const std::vector<std::size_t>& colliders);

}  // namespace dreampm
