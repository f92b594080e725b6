// Image matter behind walls without friction and behind walls where matter sticks. The kernel of a particle beside a
// wall reaches one node behind it; its image would reach as far inside. Without images the nodes beside a wall miss the
// pressure of the matter that is not there, and the rows at the wall make up for it: 9 % of rho g H at the floor of a
// still column; and a clamp gives way: the velocity gradient at a wall where matter sticks is half of what it should
// be.
#pragma once
#include <array>
#include <vector>

#include "dreampm/backend/backend.h"

namespace dreampm {

/// Whether the matter before this side of the box has an image that weighs (weigh_images): a wall that particles do not
/// pass, three cells or more from the opposite one.
template <class R>
bool image_weighs(const World<R>& world, int side);

/// Adds the masses of the images in the walls to all fields, and what solids take of the nodes' kernels: a density
/// measured beside a wall is then that of as much matter behind it, packed in the same way. To be called when nothing
/// but a gather is to come of this grid. Nothing is done where no material asks for a density.
template <class R>
void weigh_images(World<R>& world);

/// The part of a node's kernel that a collider takes, made so that images of it add up to `blocked` at the nodes before
/// a wall and to its image behind: colliders go on behind walls.
template <class R>
R before_images(const World<R>& world, const Vec3i& node, R blocked);

/// Works on velocities and masses of one grid field, after forces. Two halves of one step: `fold` before contact,
/// `reflect` after it. Masses are not changed.
template <class R>
class MirrorWalls {
 public:
  /// Finds the blocks behind the walls that stick, or separate or slip without friction. None where particles may pass
  /// walls (StepSettings::keep_inside) or walls are nearer than three cells.
  void find(const World<R>& world);

  /// Mixes the image of every node behind a wall into the node that it mirrors, by mass. Behind a wall that lets matter
  /// leave only where matter presses on it.
  void fold(const World<R>& world, std::vector<Node<R>>& nodes, std::array<Push, 6>& walls);
  /// Gives the nodes behind walls that were folded the velocity of their image. Returns the kinetic energy gained [J].
  double reflect(const World<R>& world, std::vector<Node<R>>& nodes, std::array<Push, 6>& walls);

 private:
  /// A block that holds nodes behind a wall, and the block of the nodes before it (-1: there is none).
  struct Layer {
    std::size_t block;
    std::int32_t inward;
    int local;             ///< coordinate of the layer within its block, along the axis
    std::uint16_t folded;  ///< of its 16 nodes
  };
  std::array<std::vector<Layer>, 6> layers_;
  std::vector<Push> pushes_;    ///< of one side's layers, kept for their room
  std::vector<double> energy_;  ///< the same
};

}  // namespace dreampm
