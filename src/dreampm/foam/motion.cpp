#include "dreampm/foam/motion.h"

#include "dreampm/math/rng.h"

namespace dreampm::foam {
namespace {

/// Shares of space between which foam is on the surface: deeper it is a bubble, farther out spray.
constexpr float deep = 0.95f, outside = 0.08f, at_surface = 0.5f;
constexpr float dust_fall = 0.5f;  ///< m/s: fine grains in air at rest

float smooth(float t) {
  t = std::clamp(t, 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// Ages, and says whether it begins to fade by that.
End grow_old(One& one, float dt, const FoamRules& rules) {
  one.age += dt;
  const float fade = fade_of(rules), before = one.life;
  // What fades goes on fading, whatever it is by then.
  if (one.type == FoamType::foam || one.type == FoamType::dust || one.life <= fade) one.life -= dt;
  return before > fade && one.life <= fade ? End::aged : End::none;
}

/// Begins to fade for another reason than age.
End doom(One& one, End why, const FoamRules& rules) {
  const float fade = fade_of(rules);
  if (one.life <= fade) return End::none;
  one.life = fade;
  return why;
}

/// Holds it inside of walls and out of obstacles. What flies loses what drives it in, and half of
/// the rest. Returns whether it met one.
bool hold(One& one, const Between& between) {
  const Room& room = between.rules.room;
  const float reach = one.full_radius;
  bool met = false;
  const auto stop = [&](const Vec3f& normal, const Vec3f& wall) {
    met = true;
    const Vec3f v = one.velocity - wall;
    const float in = std::min(0.0f, dot(v, normal));
    one.velocity = wall + (v - normal * in) * (one.type == FoamType::spray || one.type == FoamType::dust ? 0.5f : 1.0f);
  };
  one.position = room.wrapped(one.position);
  for (int a = 0; a < 3; ++a)
    for (const bool high : {false, true}) {
      if (!room.wall(a, high)) continue;
      const float wall = high ? room.box.max[a] - reach : room.box.min[a] + reach;
      if (high ? one.position[a] <= wall : one.position[a] >= wall) continue;
      one.position[a] = wall;
      Vec3f normal;
      normal[a] = high ? -1.0f : 1.0f;
      stop(normal, {});
    }
  for (const Obstacle& o : between.obstacles) {
    const float d = o.distance(one.position, 2 * reach);
    if (d >= reach) continue;
    const Vec3f normal = o.normal(one.position);
    one.position += normal * (reach - d);
    stop(normal, o.velocity(one.position));
  }
  return met;
}

/// Whether it left by an open side to which it does not come back.
bool has_left(const One& one, const FoamRules& rules) {
  for (int a = 0; a < 3; ++a) {
    if (rules.room.periodic[static_cast<std::size_t>(a)]) continue;
    if (one.position[a] < rules.room.box.min[a] && !(rules.gravity[a] > 0)) return true;
    if (one.position[a] > rules.room.box.max[a] && !(rules.gravity[a] < 0)) return true;
  }
  return false;
}

Vec3f up(const FoamRules& rules) { return -normalized(rules.gravity); }

/// With matter, and a bubble up through it.
void go_along(One& one, float dt, const Between& between) {
  const FoamRules& rules = between.rules;
  float share;
  const float part = between.dt > 0 ? dt / between.dt : 1;
  Vec3f way;
  const bool known = between.way.at(one.position, way);
  const Vec3f carried = known ? one.position + way * part : one.position + one.velocity * dt;
  Vec3f relative;
  if (one.type == FoamType::bubble) {
    // Its mass is half that of the liquid that it moves, so that it has its speed at once.
    const float g = std::max(1e-6f, length(rules.gravity));
    const float speed = rules.rise >= 0 ? rules.rise : bubble_speed(one.full_radius, g);
    const float time = std::max(1e-6f, speed / (2 * g)), decay = std::exp(-dt / time);
    const Vec3f end = up(rules) * speed, start = one.velocity - between.before.velocity(one.position, share);
    relative = end + (start - end) * decay;
    const Vec3f rise = end * dt + (start - end) * (time * (1 - decay));
    one.position = carried + rise;
    // Not beyond the surface.
    if (between.now.fill(one.position) < at_surface && between.now.fill(carried) >= at_surface) {
      float low = 0, high = 1;
      for (int k = 0; k < 6; ++k) {
        const float middle = 0.5f * (low + high);
        (between.now.fill(carried + rise * middle) >= at_surface ? low : high) = middle;
      }
      one.position = carried + rise * low;
      one.type = FoamType::foam;
    }
  } else {
    one.position = carried;
  }
  const Vec3f v = between.now.velocity(one.position, share);
  if (share > 0) one.velocity = v + relative;
}

/// Flies, and lands where it comes down on matter. Returns whether it met a wall.
bool fly(One& one, float dt, const Between& between) {
  const FoamRules& rules = between.rules;
  const float step = 0.4f * between.now.cell() / std::max(0.1f, length(one.velocity) + length(rules.gravity) * dt);
  const int steps = std::clamp(static_cast<int>(std::ceil(dt / step)), 4, 64);
  const float h = dt / static_cast<float>(steps), since = between.dt - dt;
  bool met = false;
  for (int s = 1; s <= steps; ++s) {
    const Vec3f before = one.velocity;
    const float speed = length(before);
    const float drag = one.type == FoamType::dust ? length(rules.gravity) / dust_fall
                                                  : rules.drag * drop_drag(one.full_radius, speed) * speed;
    one.velocity = (before + rules.gravity * h) / (1 + drag * h);
    one.position += (before + one.velocity) * (0.5f * h);
    met = hold(one, between) || met;
    const float t = between.dt > 0 ? (since + h * static_cast<float>(s)) / between.dt : 1;
    const float fill = (1 - t) * between.before.fill(one.position) + t * between.now.fill(one.position);
    if (fill <= at_surface) continue;
    float share;
    const Vec3f flow = between.now.velocity(one.position, share);
    Vec3f inward;
    between.now.fill(one.position, inward);
    if (dot(one.velocity - flow, inward) <= 0) continue;  // on its way out
    if (one.type == FoamType::spray) one.type = FoamType::foam;
    one.velocity = flow;
    break;
  }
  return met;
}

}  // namespace

float bubble_speed(float radius, float gravity) {
  constexpr float tension_per_density = 0.072f / 1000;
  const float d = 2 * std::max(radius, 0.65e-3f);
  return std::sqrt(2.14f * tension_per_density / d + 0.505f * gravity * d);
}

float drop_drag(float radius, float speed) {
  constexpr float air = 1.2f, air_viscosity = 1.81e-5f, water = 1000;
  const float r = std::min(radius, 2.5e-3f);
  const float re = std::max(1e-3f, air * speed * 2 * r / air_viscosity);
  const float coefficient = re < 1000 ? 24 / re * (1 + 0.15f * std::pow(re, 0.687f)) : 0.44f;
  return 0.375f * coefficient * air / water / r;
}

void settle(One& one, const Between& between) {
  const MotionField& now = between.now;
  const float fill = now.fill(one.position);
  if (fill > deep) {
    one.type = FoamType::bubble;
    return;
  }
  if (fill < outside) {
    one.type = FoamType::spray;
    return;
  }
  one.type = FoamType::foam;
  for (int k = 0; k < 3; ++k) {
    Vec3f g;
    const float off = now.fill(one.position, g) - at_surface, slope = length(g);
    if (slope * now.cell() < 0.05f || std::fabs(off) < 0.01f) break;
    one.position -= g * (std::clamp(off / slope, -0.3f * now.cell(), 0.3f * now.cell()) / slope);
  }
  hold(one, between);
  float share;
  const Vec3f v = now.velocity(one.position, share);
  if (share > 0) one.velocity = v;
}

End move(One& one, float dt, const Between& between) {
  const FoamRules& rules = between.rules;
  End end = grow_old(one, dt, rules);
  bool met = false;
  if (one.type == FoamType::spray || one.type == FoamType::dust) {
    met = fly(one, dt, between);
    if (one.type == FoamType::foam) settle(one, between);
  } else {
    const bool bubble = one.type == FoamType::bubble;
    go_along(one, dt, between);
    hold(one, between);
    if (!bubble || one.type == FoamType::foam || between.now.fill(one.position) < deep) settle(one, between);
  }
  if (end != End::none) return end;
  if (has_left(one, rules)) return doom(one, End::outside, rules);
  return met && one.type == FoamType::spray ? doom(one, End::wall, rules) : End::none;
}

float drawn_radius(const One& one, const FoamRules& rules) {
  const float grown = rules.grow > 0 ? smooth(one.age / rules.grow) : 1;
  return one.full_radius * grown * smooth(one.life / fade_of(rules));
}

float full_radius(std::int32_t id, const FoamRules& rules) {
  return rules.radius *
         (0.5f + static_cast<float>(uniform(rules.seed ^ 0x666f616dull, static_cast<std::uint64_t>(id))));
}

}  // namespace dreampm::foam
