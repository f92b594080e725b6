// Colliders and rigid bodies as foam meets them.
#pragma once
#include <memory>
#include <span>

#include "dreampm/geometry/region.h"
#include "dreampm/pose.h"

namespace dreampm::foam {

/// A shape where it stands at a frame, and where it stood at the frame before.
struct Obstacle {
  std::shared_ptr<const Region> shape;  ///< as the scene gives it
  Pose pose{}, before{};
  Vec3d shift{};   ///< m: places here count from it
  double dt = 0;   ///< s between the poses; 0: it stands
  Box3d bounds{};  ///< m, of the shape

  /// Signed distance [m], negative inside; far where p is more than `reach` away from the bounds.
  float distance(const Vec3f& p, float reach) const {
    const Vec3d own = local(p);
    for (int a = 0; a < 3; ++a)
      if (own[a] < bounds.min[a] - reach || own[a] > bounds.max[a] + reach) return 2 * reach;
    return static_cast<float>(shape->distance(own));
  }
  /// Outward, unit length.
  Vec3f normal(const Vec3f& p) const { return static_cast<Vec3f>(pose.rotation(shape->normal(local(p)))); }
  /// Of its matter at p [m/s].
  Vec3f velocity(const Vec3f& p) const {
    if (!(dt > 0)) return {};
    return static_cast<Vec3f>((static_cast<Vec3d>(p) + shift - before(local(p))) / dt);
  }

 private:
  Vec3d local(const Vec3f& p) const { return pose.inverse(static_cast<Vec3d>(p) + shift); }
};

}  // namespace dreampm::foam
