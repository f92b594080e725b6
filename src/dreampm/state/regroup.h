// Sorting particles into blocks, and laying the grid's blocks around them.
#pragma once
#include <memory>
#include <span>

#include "dreampm/math/mat3.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// A particle in scene coordinates, before it is inserted into a block.
struct ParticleSeed {
  std::uint32_t id;
  Vec3d position;         ///< m
  Vec3d velocity;         ///< m/s
  Mat3<double> gradient;  ///< affine velocity C [1/s]: grad v
};

/// Puts new particles, brought into the domain on periodic axes, at rest state into set `set`;
/// their motion is not stored (insert_particles scatters it). Regroups.
template <class R>
void insert(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds);

/// Takes the particles of set `set` out for which keep[p] is false, p in their order; the others
/// keep theirs. Returns how many were taken out. The grid is left as it is: sort before the next
/// step.
template <class R>
std::size_t erase(World<R>& world, std::size_t set, const std::vector<bool>& keep);

/// Sorts particles by block and cell, stably; removes and counts those more than one box length
/// outside, and those in sinks; lays grid blocks around all and carries their nodes over. Sets
/// drift to 0. The result does not depend on the number of threads.
///
/// Keeps the memory that it works with: 8 bytes a particle and one column of each set. It takes
/// more only when there is more matter, or more blocks, than ever before.
template <class R>
class Regroup {
 public:
  Regroup();
  ~Regroup();
  /// `spare` lends the memory of its fields and gets the world's former ones for it, as long as the
  /// new ones; their contents are undefined before and after. Throws RunError where a block holds
  /// 2^26 particles of a set or more. `far`: whether particles may have come two blocks on, not
  /// one.
  void operator()(World<R>& world, GridFields<R>& spare, bool far = false);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Once, with memory of its own.
template <class R>
void regroup(World<R>& world);

}  // namespace dreampm
