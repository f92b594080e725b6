// The places at which an emitter gives particles.
#pragma once
#include <cstdint>
#include <functional>

#include "dreampm/geometry/region.h"

namespace dreampm {

/// Blue noise that moves along a direction through a shape: one place a spacing^3 on average, no
/// two nearer than 0.89 spacings, and no layers or columns. It repeats a tile (geometry/poisson.h),
/// which lies so askew to the direction that no line along it meets the same places again. A place
/// depends on nothing but the arguments: it is the same after a restart. The shape must outlive the
/// pattern.
class EmissionPattern {
 public:
  /// `along`: a unit vector. `seed`: patterns of different ones have different places.
  EmissionPattern(const Region& shape, const Vec3d& along, double spacing, std::uint64_t seed = 0);

  /// The area of the shape's section, as seen along the direction [m^2]: matter that moves at u
  /// comes in at u times this.
  double area() const;

  /// Calls body(place) for each place that came into the shape since the pattern had moved
  /// `moved_before` [m], where it is now that it has moved `moved`: in the shape, or out of its rim
  /// again; for all that are in the shape, if `first`. Where it was is computed as where it is, so
  /// that none is missed between two calls by rounding.
  void for_entering(double moved_before, double moved, bool first, const std::function<void(const Vec3d&)>& body) const;

 private:
  /// Returns the place in the scene for coordinates of the tiles [spacings].
  Vec3d place(const Vec3d& own, double moved) const;

  const Region& shape_;
  double spacing_;
  Vec3d along_, across_, over_, middle_;
  Vec3d half_;    ///< m: how far the shape reaches along these three
  Vec3d offset_;  ///< spacings: of the tiles, by the seed
};

}  // namespace dreampm
