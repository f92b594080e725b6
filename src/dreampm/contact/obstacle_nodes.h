// Nodes near colliders: their distances, and the parts of their kernels that each collider blocks.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/contact/block_distances.h"
#include "dreampm/contact/body_kernel.h"
#include "dreampm/contact/collider_view.h"

namespace dreampm {

struct ObstacleNode {
  std::uint8_t node;       ///< index within the block
  bool inside;             ///< true if the node's distance is <= 0
  bool deep;               ///< true if the node is deeper inside than `deep_nodes`
  std::uint16_t collider;  ///< index within World::colliders
  float blocked;           ///< fraction of the node's kernel inside the collider, as a plane; for several, their shares
  float taken;             ///< the same for the whole solid, exact at edges too: densities are read with it
  Vec3d normal;            ///< outward; of nodes inside
  Vec3d velocity{};        ///< the collider's there [m/s]; of nodes inside one that moves
};

/// The part of a quadratic B-spline beyond distance d on its positive side: how much of a node's
/// kernel lies inside a plane obstacle at signed distance d [cells].
double kernel_inside(double d);

/// Cubes along each side of a kernel's support over which its part inside of colliders is added up.
/// Those that move are looked at in every step: for them it has to be quick.
enum class Cubes { fixed = 6, moving = 3 };

/// Adds the nodes of the block whose kernels reach into that collider.
void add_nodes(ExposedNodes& exposed, std::uint16_t collider, std::vector<ObstacleNode>& nodes);

/// Shares a node's kernel among several colliders, whose parts do not simply add up. Of two faces
/// that meet at a right angle the second takes its part of what the first one left; one that
/// continues the first takes nothing more. These are the shares of `blocked`; at edges, and in
/// layers on a wall of the box, those of `taken` are scaled to the part of the solid as a whole.
void share_kernels(const ColliderView& view, Cubes cubes, std::vector<ObstacleNode>& nodes);

/// Adds the nodes of a rigid body to `nodes`, those of the other colliders with their shares;
/// `own`: the distances from its faces. Solids that do not overlap take their parts of a kernel
/// side by side.
void add_body_nodes(ExposedNodes& exposed, std::uint16_t body, const BlockDistances& own, const BodyKernel& kernel,
                    std::vector<ObstacleNode>& nodes);

/// The order of a block's nodes: by index, those of one by collider.
bool in_order(const ObstacleNode& a, const ObstacleNode& b);

}  // namespace dreampm
