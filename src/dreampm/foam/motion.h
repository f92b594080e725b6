// How one particle of foam moves from frame to frame.
#pragma once
#include "dreampm/foam/fields.h"

namespace dreampm::foam {

/// The matter of two frames as foam sees it.
struct Between {
  const FoamRules& rules;
  const MotionField &before, &now;
  const WayField& way;
  std::span<const Obstacle> obstacles;  ///< as at the later frame
  float dt = 0;                         ///< s from frame to frame
};

struct One {
  Vec3f position{}, velocity{};
  FoamType type = FoamType::foam;
  float age = 0, life = 0;
  float full_radius = 0;  ///< m, between birth and fading
};

/// What ends it, if something began to.
enum class End : std::uint8_t { none, aged, wall, outside };

/// The speed [m/s] at which an air bubble of that radius [m] rises in water at rest (Clift, Grace
/// and Weber, "Bubbles, Drops, and Particles", 1978, eq. 7-3); of smaller ones than a radius of
/// 0.65 mm that of these.
float bubble_speed(float radius, float gravity);
/// 1/m: a drop's deceleration by air is this times its speed squared. By Schiller and Naumann
/// (1933) for a sphere up to Re 1000, 0.44 beyond. Of larger drops than a radius of 2.5 mm, which
/// burst, that of these.
float drop_drag(float radius, float speed);

/// Moves it on for `dt` [s], at most between.dt, to the later frame.
End move(One& one, float dt, const Between& between);
/// Gives foam of the later frame its type by its depth, and its place on the surface.
void settle(One& one, const Between& between);

/// The radius that is drawn.
float drawn_radius(const One& one, const FoamRules& rules);
/// Of a particle by its number: half to one and a half of the mean.
float full_radius(std::int32_t id, const FoamRules& rules);
inline float fade_of(const FoamRules& rules) { return std::min(rules.fade, rules.life_min); }

}  // namespace dreampm::foam
