// Radiance along a path: clear surfaces split it, matte ones are lit by the sun directly and by a
// bounce, and the floor's light is looked up, or traced like any other surface when none was baked.
#pragma once
#include "dreampm/render/floor.h"
#include "dreampm/render/interface.h"
#include "dreampm/render/rough_surface.h"

namespace dreampm::trace {

struct PathOptions {
  const FloorLight* floor_light = nullptr;  ///< absent: the floor is traced plainly
  bool physical = false;                    ///< no glow inside the water, no glow of the glass edges
  bool looks = true;                        ///< false for gathering: no polish, no glow
  bool sun_disc = true;                     ///< paths through clear surfaces alone see the sun
  int splits = 2;                           ///< follow both ways at this many first interfaces
  float pixel_angle = 0;                    ///< rad, to filter the tiles
};

class Integrator {
 public:
  Integrator(const Geometry& geometry, const Sky& sky, const FloorPattern& pattern, float scale,
             const PathOptions& options)
      : geometry_(geometry), surfaces_(geometry), sky_(sky), pattern_(pattern), scale_(scale), options_(options) {}
  /// From o along the unit vector d, starting in air, or in the medium of the first surface that is
  /// met from inside. `time`: through the exposure, 0 to 1.
  Vec3f radiance(const Vec3f& o, const Vec3f& d, Sampler& random, float time = 0.5f) const;

 private:
  struct Path;
  struct Stack;
  struct SunSample {
    Vec3f direction, irradiance;  ///< towards it; square to it, with what dims it on its way
  };
  bool at_floor(Path& path, const Vec3f& p, Sampler& random, Vec3f& sum) const;
  bool at_opaque(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const;
  bool at_rough(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const;
  bool at_clear(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const;
  bool scatter_matte(Path& path, const Vec3f& p, const Vec3f& n, const Vec3f& face, const Vec3f& albedo,
                     const SunSample& sun, Sampler& random, Vec3f& sum) const;
  bool at_grain(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, Stack& stack) const;
  /// `away` [m]: as far along the face's normal from p the way to the sun begins.
  SunSample sunlight(const Vec3f& p, const Vec3f& n, const Vec3f& face, const Media& media, Sampler& random,
                     float away = 0) const;
  Vec3f transmitted_sun(Vec3f o, Vec3f d, const Vec3f& to_sun, Media media) const;

  const Geometry& geometry_;
  RoughSurfaces surfaces_;
  const Sky& sky_;
  const FloorPattern& pattern_;
  float scale_;
  PathOptions options_;
};

}  // namespace dreampm::trace
