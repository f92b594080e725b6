// Surface points of colliders in a block of the grid: the points at which contact acts.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/contact/collider_view.h"
#include "dreampm/contact/exposed_nodes.h"
#include "dreampm/physics/collider_contact.h"

namespace dreampm {

/// A point of a collider's surface, and the part of the surface that it stands for: what lies in
/// one cell and faces one way. Found where lines along the three axes meet the surface; a line
/// along axis a stands for n_a^2 of the surface there, so that the three together stand for all of
/// it once, whichever way it faces.
struct SurfacePoint {
  Vec3<float> at;         ///< cells from the block's first node: in [0, 4]
  Vec3<float> normal;     ///< outward
  Vec3<float> from_edge;  ///< along the surface, away from an edge less than a cell off [1]; 0 of other points
  float area;             ///< [dx^2]
  std::uint32_t deep;     ///< deep nodes of its stencil, a bit each, z fastest: they take no part in its contact
  std::array<std::int8_t, 3> first;  ///< node of its stencil
  std::uint16_t collider;
  // Velocities, set for colliders that move (Obstacles::set_velocities), 0 for others:
  Vec3<float> velocity{};  ///< of the surface [m/s]
  Vec3<float> spin{};      ///< of the collider [rad/s]
  Vec3d arm{};  ///< vector from the center of the collider's twist to the point [m]: moments are exact with it
};

/// Eight ways of a cell along a surface with that normal.
std::array<Vec3d, 8> ways_along(const Vec3d& normal);

/// The part of a surface that lies in one cell and faces one way, in the cells of a view.
struct SurfacePatch {
  Vec3d at;         ///< its middle
  Vec3d normal;     ///< outward
  Vec3d from_edge;  ///< as SurfacePoint::from_edge
  double area;      ///< [dx^2]
  std::uint16_t collider;
};

/// Adds the patches of the surfaces in `view` that matter can touch, in the cell that begins at
/// `first`.
void add_patches(const ColliderView& view, const Vec3d& first, std::vector<SurfacePatch>& patches);

/// The point of a patch, whose middle lies in the block of `exposed`.
SurfacePoint surface_point(ExposedNodes& exposed, const SurfacePatch& patch);

/// Adds those of the colliders in view but rigid bodies (contact/body_surface.h), cell after cell
/// of its block.
void add_points(ExposedNodes& exposed, std::vector<SurfacePoint>& points);

}  // namespace dreampm
