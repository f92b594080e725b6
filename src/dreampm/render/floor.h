// The tiled floor and the light that lies on it. Everything else in a picture of water is clear, so
// with the floor's light baked a camera path ends there almost free of noise.
#pragma once
#include <functional>
#include <vector>

#include "dreampm/render/backdrop.h"
#include "dreampm/render/intersect.h"
#include "dreampm/render/light_grid.h"
#include "dreampm/render/sampler.h"
#include "dreampm/render/sky.h"

namespace dreampm::trace {

/// The floor's reflectance.
class FloorPattern {
 public:
  /// Tiles of 11 cm for a basin about 1 m long, doubled or halved for others; paper in a studio.
  explicit FloorPattern(const Box3f& basin, model::Place place = model::Place::terrace);
  /// At (x, z) [m], averaged over `footprint` [m].
  Vec3f albedo(float x, float z, float footprint) const;
  /// How far the floor has faded into the horizon there, 0 to 1.
  float fade(float x, float z) const;

 private:
  float tile_, grout_, grain_, scale_, middle_x_, middle_z_;
  bool has_tiles_;
  float shade_;  ///< of dark tiles, below 1
};

/// Irradiance of the floor, on grids round the basin; open floor beyond.
class FloorLight {
 public:
  /// Starts as open floor.
  FloorLight(const Geometry& geometry, const Sky& sky, const Box3f& basin);
  /// Sunlight by photons: each takes one splat from where it would land unhindered and adds splats
  /// where it does, so open floor keeps no noise. Both ways are followed at every interface. `bend`
  /// false: straight on, only dimmed.
  void bake_sun(bool bend, int photons, std::uint64_t seed);
  /// Radiance that arrives at a floor point from a direction, without the sun's own light through
  /// clear surfaces.
  using Gather = std::function<Vec3f(const Vec3f& point, const Vec3f& direction, Sampler&)>;
  /// All other light by `rays` rays a cell; `gather` may ask this object's irradiance, which
  /// changes only at the end.
  void bake_sky(const Gather& gather, int rays, std::uint64_t seed);
  /// At (x, z) [m]. `ior` is 1 in air; in a medium the sun's part is divided by ior^2, because
  /// paths here do not scale radiance where they enter a medium.
  Vec3f irradiance(float x, float z, float ior) const;

 private:
  const Geometry& geometry_;
  const Sky& sky_;
  float x0_, z0_, x1_, z1_, top_, scale_;
  LightGrid sun_, sky_grid_;  ///< sun: share of the open floor's; sky: irradiance
};

}  // namespace dreampm::trace
