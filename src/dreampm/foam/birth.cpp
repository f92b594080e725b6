#include "dreampm/foam/birth.h"

#include "dreampm/foam/rates.h"
#include "dreampm/math/rng.h"

namespace dreampm::foam {
namespace {

/// Numbers of one birth, all of a stream of its own.
class Lot {
 public:
  Lot(std::uint64_t stream, std::uint64_t child) : stream_(mix64(stream ^ mix64(child + 1))) {}
  float next() { return static_cast<float>(uniform(stream_, used_++)); }
  /// Within the ball of radius 1.
  Vec3f in_ball() {
    const float z = 2 * next() - 1, turn = 6.2831853f * next(), r = std::cbrt(next()), s = std::sqrt(1 - z * z);
    return Vec3f{s * std::cos(turn), s * std::sin(turn), z} * r;
  }

 private:
  std::uint64_t stream_, used_ = 0;
};

/// A piece of the way of a particle between two frames: the cubic by places and velocities at both.
struct Piece {
  Vec3f x0, v0, x1, v1;  ///< m, m/s
  float dt;              ///< s
  Vec3f place(float t) const {
    const float a = t * t * (3 - 2 * t);
    return x0 + (x1 - x0) * a + (v0 * (t * (1 - t) * (1 - t)) - v1 * (t * t * (1 - t))) * dt;
  }
  Vec3f velocity(float t) const { return v0 + (v1 - v0) * t; }
};

enum class Cause { crest, trapped_air, vorticity };

/// One that begins somewhere on the way of its particle, and goes on to the later frame.
One child(const Piece& piece, Cause cause, Lot lot, std::int32_t id, const Between& between) {
  const FoamRules& rules = between.rules;
  const float t = lot.next(), rest = (1 - t) * piece.dt;
  One one;
  one.full_radius = full_radius(id, rules);
  one.life = rules.life_min + (rules.life_max - rules.life_min) * lot.next();
  const Vec3f off = lot.in_ball() * (0.62f * rules.spacing);  // the ball of a particle's volume
  const float more = lot.next();
  const Vec3f aside = lot.in_ball();
  if (rules.dust || cause == Cause::crest) {
    // Crests throw it: up to a fifth faster than the matter, and a little to all sides.
    one.type = rules.dust ? FoamType::dust : FoamType::spray;
    one.position = piece.place(t) + off;
    const Vec3f v = piece.velocity(t);
    one.velocity = v * (1 + 0.2f * more) + aside * (0.1f * length(v));
    move(one, rest, between);
  } else {
    one.age = rest;
    one.position = rules.room.wrapped(piece.x1 + off);
    one.velocity = piece.v1;
    settle(one, between);
  }
  return one;
}

/// True if a wall of the room is nearer than the scale; `floor`: the floor counts.
bool beside_wall(const Vec3f& p, const FoamRules& rules, bool floor) {
  const Room& room = rules.room;
  for (int a = 0; a < 3; ++a) {
    if (room.wall(a, false) && p[a] - room.box.min[a] < rules.scale && (floor || a != 1)) return true;
    if (room.wall(a, true) && room.box.max[a] - p[a] < rules.scale) return true;
  }
  return false;
}

bool beside_obstacle(const Vec3f& p, const Between& between) {
  const float near = between.rules.scale;
  return std::any_of(between.obstacles.begin(), between.obstacles.end(),
                     [&](const Obstacle& o) { return o.distance(p, near) < near; });
}

/// How fast grains and what is within the scale hit each other since the frame before, at whatever
/// angle [m/s]: what was stopped at a wall or an obstacle, and what an obstacle came at. `before`
/// and `now`: the grains' velocities.
float hit_speed(const Vec3f& p, const Vec3f& before, const Vec3f& now, const Between& between) {
  const FoamRules& rules = between.rules;
  float fastest = 0;
  if (const float stopped = length(now - before - rules.gravity * between.dt);
      stopped > rules.speed.from && (beside_wall(p, rules, true) || beside_obstacle(p, between)))
    fastest = stopped;
  for (const Obstacle& o : between.obstacles) {
    if (!(o.dt > 0) || o.distance(p, rules.scale) >= rules.scale) continue;
    const Vec3f way = o.velocity(p) - before;
    if (dot(way, o.normal(p)) > 0) fastest = std::max(fastest, length(way));
  }
  return fastest;
}

}  // namespace

Born births(const FoamMatter& from, const FoamMatter& to, std::span<const std::int32_t> earlier, const Between& between,
            int frame, std::uint32_t next_id, std::size_t room) {
  const FoamRules& rules = between.rules;
  const std::size_t n = to.position.size();
  const std::uint64_t stream = mix64(rules.seed ^ mix64(static_cast<std::uint64_t>(frame) * 0x9e3779b97f4a7c15ull));
  const auto lot_of = [&](std::size_t i) { return mix64(stream ^ static_cast<std::uint64_t>(to.id[i])); };
  const Measures measures(to, between.obstacles, rules);
  std::vector<Rates> rates(n);
  std::vector<std::uint32_t> first(n + 1, 0);
  parallel_for(n, 1024, [&](std::size_t i) {
    float hit = 0;
    if (rules.dust && earlier[i] >= 0)
      hit = hit_speed(to.position[i], from.velocity[static_cast<std::size_t>(earlier[i])], to.velocity[i], between);
    if (!(std::max(length(to.velocity[i]), hit) > rules.speed.from)) return;
    rates[i] = rates_of(causes_of(measures.at(to.position[i]), to.velocity[i], hit), rules);
    const double mean =
        static_cast<double>(rates[i].sum() * volume_of(to, i, rules.spacing)) * static_cast<double>(between.dt);
    first[i + 1] = static_cast<std::uint32_t>(std::min(1e6, mean + uniform(lot_of(i), 0)));
  });
  std::uint64_t wanted = 0;
  for (std::size_t i = 0; i < n; ++i) wanted += first[i + 1];
  Born out;
  if (wanted > room) {  // each by lot, so that none is preferred
    const double keep = static_cast<double>(room) / static_cast<double>(wanted);
    std::uint64_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
      first[i + 1] = static_cast<std::uint32_t>(first[i + 1] * keep + uniform(lot_of(i), 1));
      first[i + 1] = static_cast<std::uint32_t>(std::min<std::uint64_t>(first[i + 1], room - kept));
      kept += first[i + 1];
    }
    out.counts.thinned = wanted - kept;
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  out.all.resize(first[n]);
  std::vector<Cause> causes(first[n]);
  parallel_for(n, 256, [&](std::size_t i) {
    if (first[i] == first[i + 1]) return;
    Piece piece{to.position[i], to.velocity[i], to.position[i], to.velocity[i], between.dt};
    if (earlier[i] >= 0) {
      const auto e = static_cast<std::size_t>(earlier[i]);
      piece.x0 = to.position[i] - rules.room.way(from.position[e], to.position[i]), piece.v0 = from.velocity[e];
    } else {
      piece.x0 = to.position[i] - to.velocity[i] * between.dt;
    }
    for (std::uint32_t c = first[i]; c < first[i + 1]; ++c) {
      const float pick = static_cast<float>(uniform(lot_of(i), 2 + (c - first[i]))) * rates[i].sum();
      causes[c] = pick < rates[i].crest                          ? Cause::crest
                  : pick < rates[i].crest + rates[i].trapped_air ? Cause::trapped_air
                                                                 : Cause::vorticity;
      out.all[c] =
          child(piece, causes[c], Lot(lot_of(i), c - first[i]), static_cast<std::int32_t>(next_id + c), between);
    }
  });
  for (std::size_t c = 0; c < out.all.size(); ++c) {
    (causes[c] == Cause::crest         ? out.counts.crest
     : causes[c] == Cause::trapped_air ? out.counts.trapped_air
                                       : out.counts.vorticity)++;
    out.counts.place += static_cast<Vec3d>(out.all[c].position);
    out.counts.beside_walls +=
        beside_wall(out.all[c].position, rules, false) || beside_obstacle(out.all[c].position, between);
  }
  return out;
}

}  // namespace dreampm::foam
