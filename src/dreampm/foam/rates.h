// What each particle of matter emits, by cause.
#pragma once
#include "dreampm/foam/fields.h"

namespace dreampm::foam {

/// 1/(m^3 s), by cause.
struct Rates {
  float crest = 0, trapped_air = 0, vorticity = 0;
  float sum() const { return crest + trapped_air + vorticity; }
};

/// Less matter than this about a place, as a share of space, is a drop that has left already.
inline constexpr float drop_fill = 0.12f;
/// A crest moves the way it points: the cosine at least (Ihmsen 2012, eq. 7).
inline constexpr float crest_cosine = 0.6f;

/// The causes of one particle, each by its unit, before any limit.
struct Causes {
  float speed = 0, crest = 0, trapped_air = 0, vorticity = 0;
};
/// `hit`: how fast something came at it since the frame before [m/s]. Of grains at rest that is all
/// there is: they stop what hits them within a frame.
inline Causes causes_of(const Measures::At& m, const Vec3f& velocity, float hit = 0) {
  Causes c;
  const float own = length(velocity);
  c.speed = std::max(own, hit);
  if (m.fill < drop_fill || !(c.speed > 0)) return c;
  c.trapped_air = std::max(m.trapped_air, image_factor * hit) * m.near_surface;
  c.vorticity = m.vorticity * m.near_surface;
  if (dot(velocity, m.outward) >= crest_cosine * own) c.crest = m.curvature * m.near_surface;
  return c;
}

/// Ihmsen 2012, eq. 8: the energy times the sum of what causes give.
inline Rates rates_of(const Causes& c, const FoamRules& rules) {
  // Energies, not speeds, rise evenly.
  const FoamCause& s = rules.speed;
  const float energy = std::clamp((c.speed * c.speed - s.from * s.from) / (s.to * s.to - s.from * s.from), 0.0f, 1.0f);
  const auto rate = [&](const FoamCause& cause, float value) {
    return rules.rate * energy * cause.share * cause.part(value);
  };
  return {rate(rules.crest, c.crest), rate(rules.trapped_air, c.trapped_air), rate(rules.vorticity, c.vorticity)};
}

}  // namespace dreampm::foam
