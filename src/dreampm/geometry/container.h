// Containers: a hollow of any shape, turned the right way up, in a block or in a wall that follows
// it, and cut open at the top.
#pragma once
#include <memory>

#include "dreampm/geometry/region.h"

namespace dreampm {

/// The default part of the height of its hollow, below the highest point, that is cut off a
/// container.
inline constexpr double default_cut = 0.05;

/// A container before it is placed: its hollow lies as its own shape says, turned about the middle
/// of its bounds.
struct ContainerParts {
  std::shared_ptr<const Region> solid;   ///< with the hollow (hollow_of)
  std::shared_ptr<const Region> hollow;  ///< ends at the mouth
  Box3d box;                             ///< m: the block, or the box about the wall; the mouth lies in its upper side
  double mouth = 0;                      ///< m^2: the section of the hollow in that side
};

/// The hollow is turned so that `up` is +Y. Its tight bounds, grown by the wall on five sides, are
/// the box, whose upper side lies `cut` [m] below the highest point. A block is all of the box but
/// the hollow. A shell is what lies within the wall's thickness of the hollow, without the hollow
/// and below the mouth. `voxel` and `reach` are for meshes. Throws InputError where a number is out
/// of range, the hollow encloses nothing or is endless, the cut takes all of it, and where the
/// mouth is less than a thousandth of the box's floor.
ContainerParts container_parts(const ContainerShape& container, double voxel, const MeshRegions& meshes, double reach);

/// The hollow of a container where it stands, with its mouth.
struct PlacedHollow {
  std::shared_ptr<const Region> region;
  Vec3d mouth;   ///< m: a point of the mouth's plane
  Vec3d normal;  ///< of that plane, out of the hollow
  double area;   ///< m^2, of the mouth
};

/// The hollow that goes with the region of a container; null for every other region, unions with a
/// container too.
const PlacedHollow* hollow_of(const Region& region);
/// The same region, with a hollow that hollow_of finds.
std::shared_ptr<const Region> with_hollow(std::shared_ptr<const Region> solid, PlacedHollow hollow);

/// The bounds [m] of a bounded region to a tolerance [m]; its own where these are as tight. What is
/// thinner than that may be missed at an end. Empty if nothing of it is found.
Box3d tight_bounds(const Region& region, double tolerance);

}  // namespace dreampm
