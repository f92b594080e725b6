// Image matter behind walls without friction and behind walls where matter sticks; of liquids
// behind all, since friction is for solids and grains. The kernel of a particle beside a wall
// reaches one node behind it; its image would reach as far inside. Without images the nodes beside
// a wall miss the pressure of the matter that is not there, and the rows at the wall make up for
// it: 9 % of rho g H at the floor of a still column; and a clamp gives way: the velocity gradient
// at a wall where matter sticks is half of what it should be.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/node_loops.h"
#include "dreampm/base/thread_team.h"

namespace dreampm {

/// True if the matter before this side of the box has an image with mass: at a wall that particles
/// do not pass, three cells or more from the opposite one.
template <class R>
bool has_image_mass(const World<R>& world, int side);

/// The part of a node's kernel that a collider takes, made so that images of it add up to `blocked`
/// at the nodes before a wall and to its image behind: colliders go on behind walls.
template <class R>
R without_images(const World<R>& world, const Vec3i& node, R blocked);

/// True if a law asks for a density in a step of `dt` [s].
template <class R>
bool measures_density(const World<R>& world, double dt);

/// The images of one grid. What they do to velocities are two halves of one step: `fold_ghosts`
/// before contact, `reflect_ghosts` after it; masses are not changed by these. All threads of a
/// team call them together.
template <class R>
class MirrorWalls {
 public:
  /// Finds the blocks behind walls: after every change of the grid's block list.
  void prepare(const World<R>& world);

  /// True if fold_ghosts or reflect_ghosts may change nodes of this grid block.
  bool changes(std::size_t block) const { return changes_[block] != 0; }

  /// Mixes the image of every node behind a wall that sticks, or separates or slips without
  /// friction for what moves in the node's field, into the node that it mirrors, by mass. Behind a
  /// wall that lets matter leave only where matter presses on it; of solids and grains only where
  /// they touch it.
  void fold_ghosts(ThreadTeam& team, World<R>& world, const NodeLoops<R>& loops, const ContactGaps& gaps);
  /// Gives the nodes behind walls that were folded the velocity of their image.
  void reflect_ghosts(ThreadTeam& team, World<R>& world, const NodeLoops<R>& loops);
  /// Adds the impulses of walls in the last fold_ghosts and reflect_ghosts. Returns the kinetic
  /// energy gained [J].
  double add_impulses(std::array<ImpulseSum, 6>& walls) const;

  /// Adds the masses of the images to all fields, and what matter takes of the nodes' kernels: a
  /// density measured beside a wall is then that of as much matter behind it, packed in the same
  /// way. To be called when nothing but a gather is to come of this grid. Nothing is done where no
  /// material asks for a density in a step of `dt` [s].
  void add_image_mass(ThreadTeam& team, World<R>& world, double dt) const;

  /// A block's nodes behind a wall, with those on it and those that they mirror: the numbers of the
  /// planes' first nodes.
  struct Layer {
    std::size_t ghosts, walls, inners;
    int side;
    std::array<bool, 2> folds;  ///< by field
  };
  /// The layers across an axis: no two of them share a node.
  std::span<const Layer> layers(int axis) const {
    const std::size_t begin = axes_[static_cast<std::size_t>(axis)];
    return {layers_.data() + begin, axes_[static_cast<std::size_t>(axis) + 1] - begin};
  }
  /// True if any field is folded anywhere.
  bool folds() const { return folds_; }

 private:
  /// Sums of a layer's change of one field.
  struct Done {
    ImpulseSum impulses;
    double gained = 0;
    std::uint16_t folded = 0;  ///< of its 16 nodes
  };
  template <class Body>
  void for_axis(ThreadTeam& team, int axis, const Body& body) const;
  /// Calls body(field, planes, what was done to them) for the fields that a layer folds.
  template <class Body>
  void for_fields(World<R>& world, std::size_t layer, const Body& body);

  std::vector<Layer> layers_;              ///< axis after axis
  std::array<std::size_t, 4> axes_{};      ///< where those of an axis begin
  std::array<std::vector<Done>, 2> done_;  ///< by field
  std::vector<std::uint8_t> changes_;      ///< by grid block
  bool folds_ = false;
};

}  // namespace dreampm
