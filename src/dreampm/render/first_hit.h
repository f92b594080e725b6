// What a camera ray meets first, for depth, motion, normals and reflectance beside a picture.
#pragma once
#include "dreampm/render/floor.h"
#include "dreampm/render/intersect.h"
#include "dreampm/render/sky.h"

namespace dreampm::trace {

struct FirstHit {
  bool found = false;
  Vec3f point, velocity;  ///< m, m/s; only where something was found
  Vec3f normal;           ///< towards the camera, unit length; 0 of the sky
  Vec3f albedo;           ///< of the sky what it shines with, at most 1
};

class FirstHits {
 public:
  FirstHits(const Geometry& geometry, const Sky& sky, const FloorPattern& pattern, float pixel_angle)
      : geometry_(geometry), sky_(sky), pattern_(pattern), pixel_angle_(pixel_angle) {}
  /// Along the unit vector d from o at a time of the exposure. Panes, and grains that cover less
  /// than half, are looked through.
  FirstHit at(Vec3f o, Vec3f d, float time) const;

 private:
  Vec3f albedo_of(const Hit& hit, const Vec3f& p, const Vec3f& d, float way) const;

  const Geometry& geometry_;
  const Sky& sky_;
  const FloorPattern& pattern_;
  float pixel_angle_;
};

}  // namespace dreampm::trace
