// Sorting particles into blocks, and laying the grid's blocks around them.
#pragma once
#include "dreampm/math/mat3.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// A particle in scene coordinates, before it belongs to a block.
struct Newborn {
  std::uint32_t id;
  Vec3d position;         ///< m
  Vec3d velocity;         ///< m/s
  Mat3<double> gradient;  ///< affine velocity C [1/s]: grad v
};

/// Puts new particles, brought into the domain on periodic axes, at rest state into set `set`; their motion is not
/// stored (birth scatters it). Regroups.
template <class R>
void insert(World<R>& world, std::size_t set, std::span<const Newborn> newborns);

/// Sorts particles by block, stably; removes and counts those more than one box length outside; lays grid blocks around
/// all and carries their nodes over. Sets drift to 0.
template <class R>
void regroup(World<R>& world);

}  // namespace dreampm
