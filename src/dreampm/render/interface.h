// What happens to light at a clear surface: water, pane or glass edge.
#pragma once
#include "dreampm/render/intersect.h"

namespace dreampm::trace {

struct Split {
  float reflectance = 0;  ///< share reflected; 1 under total reflection
  Vec3f tint{1, 1, 1};    ///< of what passes
  Vec3f reflected, refracted;
  int reflected_medium = air, refracted_medium = air;
  Vec3f side;  ///< the face's normal on the side that the ray came from
};

/// At a dielectric, pane or bar; `medium` is what the ray came through.
Split split_light(const Geometry& geometry, const Hit& hit, const Vec3f& d, int medium);

/// What a bar lets through along a straight line.
inline constexpr Vec3f bar_shade{0.50f, 0.75f, 0.68f};
inline constexpr Vec3f pane_tint{0.97f, 0.985f, 0.98f};

}  // namespace dreampm::trace
