// Where matter comes in, and where it is taken out.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "dreampm/geometry/region.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// A shape that stays filled with matter which moves through it at one velocity: particles come in
/// on a lattice that moves along, where it enters the shape.
struct Emitter {
  std::string name;
  std::shared_ptr<const Region> shape;
  std::size_t set = 0;                                    ///< of the world, that it gives to
  Vec3d velocity;                                         ///< m/s, not zero
  double start = 0;                                       ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  /// Particles that it may give in all, or, where it recycles, that its set may hold.
  std::uint64_t pool = 0;
  bool recycle = false;
  std::uint64_t born = 0;     ///< particles that it gave so far
  std::uint64_t blocked = 0;  ///< places that it left free, for matter stood there or the pool was used up

  bool gives_within(double from, double to) const { return start <= to && stop >= from; }
};

/// A shape that takes out the matter that comes into it, when particles are sorted: every few
/// steps.
struct Sink {
  std::string name;
  std::shared_ptr<const Region> shape;
  std::uint64_t taken = 0;  ///< particles, so far
  Vec3d momentum{};         ///< kg m/s, that they took along,
  Vec3d angular{};          ///< and angular momentum about the scene's origin [kg m^2/s]
};

}  // namespace dreampm
