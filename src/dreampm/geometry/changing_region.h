// A region whose surface changes with time.
#pragma once
#include <memory>

#include "dreampm/geometry/region.h"

namespace dreampm {

/// Immutable and safe to ask from many threads.
class ChangingRegion {
 public:
  virtual ~ChangingRegion() = default;
  /// Returns the region at a time [s].
  virtual std::shared_ptr<const Region> at(double time) const = 0;
  /// The velocity [m/s] of its surface nearest to `p` [m] at a time [s].
  virtual Vec3d velocity(const Vec3d& p, double time) const = 0;
  /// The largest speed [m/s] of a point of its surface between two times [s].
  virtual double fastest(double from, double to) const = 0;
  /// Returns a bound of the distance that a point of its surface moves between two times [m].
  virtual double farthest(double from, double to) const = 0;
};

}  // namespace dreampm
