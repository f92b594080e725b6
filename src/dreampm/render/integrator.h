// Radiance along a path: clear surfaces split it, others are lit by the lights directly and by a
// bounce, cloudy matter scatters it, and the floor's light is looked up, or traced like that of any
// other surface when none was baked.
#pragma once
#include "dreampm/render/floor.h"
#include "dreampm/render/interface.h"
#include "dreampm/render/lamps.h"
#include "dreampm/render/paper_light.h"
#include "dreampm/render/photons.h"
#include "dreampm/render/surfaces.h"

namespace dreampm::trace {

struct FreePath;
struct Path;
struct PathStack;
struct Shading;

struct PathOptions {
  const FloorLight* floor_light = nullptr;  ///< absent: the floor is traced plainly
  const PaperLight* paper_light =
      nullptr;  ///< of a studio, with the object that is its backdrop; absent: traced plainly
  int paper = air;
  const PhotonMap* photons = nullptr;  ///< absent: light goes straight through clear matter, only dimmed
  const Lamps* lamps = nullptr;        ///< absent: none
  bool physical = false;               ///< no glow inside the water, no glow of the glass edges
  bool looks = true;                   ///< false for gathering: no polish, no glow
  bool sun_disc = true;                ///< paths through clear surfaces alone see the sun and the lamps
  int splits = 2;                      ///< follow both ways at this many first interfaces
  float pixel_angle = 0;               ///< rad, to filter the tiles
};

class Integrator {
 public:
  Integrator(const Geometry& geometry, const Sky& sky, const FloorPattern& pattern, float scale,
             const PathOptions& options)
      : geometry_(geometry), surfaces_(geometry), sky_(sky), pattern_(pattern), scale_(scale), options_(options) {}
  /// From o along the unit vector d, starting in air, or in the medium of the first surface that is
  /// met from inside. `time`: through the exposure, 0 to 1.
  Vec3f radiance(const Vec3f& o, const Vec3f& d, Sampler& random, float time = 0.5f) const;
  /// A sample of the irradiance at p of a surface in air that faces along n.
  Vec3f arriving(const Vec3f& p, const Vec3f& n, Sampler& random, float time = 0.5f) const;

 private:
  void follow(PathStack& stack, Sampler& random, Vec3f& sum) const;
  bool step(Path& path, Sampler& random, Vec3f& sum, PathStack& stack) const;
  Vec3f beyond(const Path& path) const;
  bool at_floor(Path& path, const Vec3f& p, Sampler& random, Vec3f& sum, PathStack& stack) const;
  bool at_surface(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, PathStack& stack) const;
  bool at_clear(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum, PathStack& stack) const;
  bool at_grain(Path& path, const Hit& hit, const Vec3f& p, Sampler& random, Vec3f& sum) const;
  bool bounce(Path& path, const Shading& at, Sampler& random, PathStack& stack) const;

  // The light that arrives at surfaces: direct.cpp.
  /// What a surface sends to the path of light that comes straight from lights, and of photons.
  Vec3f lit(const Path& path, const Shading& at, Sampler& random) const;
  static Vec3f lit_by(const LightSample& light, const Shading& at);
  Vec3f lit_by_sky(const Path& path, const Shading& at, Sampler& random) const;
  Vec3f lit_by_photons(const Path& path, const Shading& at) const;
  /// Sunlight at p that comes over the side of both normals. `away` [m]: as far along the face's
  /// normal the way to the sun begins.
  LightSample sunlight(const Vec3f& p, const Vec3f& n, const Vec3f& face, const Media& media, Sampler& random,
                       float away = 0) const;
  /// What of a light is left on the way from o along d; it leaves clear matter along `outside`.
  /// `through_clear` false: clear matter other than the basin's glass stops it.
  Vec3f transmitted(Vec3f o, Vec3f d, const Vec3f& outside, Media media, float reach, bool through_clear) const;

  // Cloudy matter: cloudy.cpp.
  FreePath free_path(const Path& path, const Interior& in, Sampler& random) const;
  bool scatter(Path& path, const Interior& in, const FreePath& free, Sampler& random, Vec3f& sum) const;
  /// Brings the path most of the way to the nearest surface in one step, where that is far.
  void leap(Path& path, const Interior& in, Sampler& random) const;
  Vec3f lit_within(const Path& path, const Interior& in, const LightSample& light, Sampler& random) const;

  const Geometry& geometry_;
  Surfaces surfaces_;
  const Sky& sky_;
  const FloorPattern& pattern_;
  float scale_;
  PathOptions options_;
  Matte matte_;
};

}  // namespace dreampm::trace
