// The paper of a studio: it lies on the floor, bends up behind the basin and stands there.
#pragma once
#include "dreampm/geometry/mesh.h"
#include "dreampm/math/vec.h"

namespace dreampm::trace {

/// Its reflectance.
inline constexpr Vec3f studio_paper{0.72f, 0.72f, 0.72f};

/// Places on the sheet are measured along it, from below the basin's middle away from the camera,
/// and across [m].
class Backdrop {
 public:
  struct Place {
    float along, across;
  };
  /// Behind the basin as seen from `eye` [m].
  Backdrop(const Box3f& basin, const Vec3f& eye);
  /// What of it does not lie on the floor.
  TriMesh mesh() const;
  /// Of a point on it [m], or on the floor before it.
  Place place_of(const Vec3f& p) const;
  Vec3f point_at(const Place& place) const;
  /// Of unit length, towards the basin.
  Vec3f normal_at(const Place& place) const;
  /// How far it reaches to either side, and along [m].
  float wide() const { return wide_; }
  float end() const { return begin_ + quarter() + high_ - bend_; }
  /// m, along the sheet: where it leaves the floor.
  float bend_begin() const { return begin_; }
  /// m: the longer side of the basin.
  float scale() const { return scale_; }

 private:
  float quarter() const;
  Vec3f foot_, back_, side_;
  float scale_, begin_, bend_, high_, wide_;
};

}  // namespace dreampm::trace
