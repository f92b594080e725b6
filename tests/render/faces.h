// The clear faces that a ray meets which is always let through.
#pragma once
#include <vector>

#include "dreampm/render/interface.h"

namespace dreampm {

struct Face {
  Vec3f at;  ///< m
  float reflectance;
  float before, behind;  ///< indices of refraction
  Vec3f direction;       ///< behind it, unit length
};

inline std::vector<Face> faces(const trace::Geometry& geometry, Vec3f o, Vec3f d) {
  std::vector<Face> list;
  trace::Media media;
  for (int i = 0; i < 20; ++i) {
    const trace::Hit hit = cast_visible(geometry, o, d, media);
    if (hit.kind != trace::Kind::dielectric) break;
    const trace::Split s = split_light(geometry, hit, d, media);
    const Vec3f p = o + d * hit.t;
    list.push_back({p, s.reflectance, ior(geometry, media), ior(geometry, s.refracted_media), s.refracted});
    o = p - s.side * geometry.epsilon(), d = s.refracted, media = s.refracted_media;
  }
  return list;
}

}  // namespace dreampm
