// Blocks of liquid for tests of foam.
#pragma once
#include <numeric>

#include "dreampm/foam/from_scene.h"
#include "dreampm/math/rng.h"

namespace dreampm::test {

/// A block of liquid, a shaken lattice of spacing h, in arrays.
struct Liquid {
  std::vector<Vec3f> position, velocity;
  std::vector<std::int32_t> id;
  float spacing;

  template <class Velocity>
  Liquid(const Vec3f& size, float h, const Velocity& velocity_at) : spacing(h) {
    const auto n = [&](float s) { return static_cast<int>(std::lround(s / h)); };
    std::uint64_t lot = 0;
    const auto off = [&] { return 0.25f + 0.5f * static_cast<float>(uniform(1, lot++)); };
    for (int k = 0; k < n(size.z); ++k)
      for (int j = 0; j < n(size.y); ++j)
        for (int i = 0; i < n(size.x); ++i) {
          const float x = off(), y = off(), z = off();
          position.push_back(Vec3f{static_cast<float>(i) + x, static_cast<float>(j) + y, static_cast<float>(k) + z} *
                             h);
          velocity.push_back(velocity_at(position.back()));
        }
    id.resize(position.size());
    std::iota(id.begin(), id.end(), 0);
  }
  FoamMatter matter() const { return {position, velocity, id, {}}; }
  Liquid moved(const Vec3f& way) const {
    Liquid other = *this;
    for (Vec3f& p : other.position) p += way;
    return other;
  }
};

/// Rules of a basin from the origin to `size`, open above, of liquid that fills `volume` [m^3].
inline FoamRules basin_rules(const Vec3f& size, float spacing, double volume, const model::Foam& foam = {}) {
  FoamRules rules;
  rules.room.box = {{0, 0, 0}, size};
  rules.room.is_wall = {true, true, true, false, true, true};
  rules.spacing = spacing, rules.cell = 2 * spacing;
  rules = foam_rules(foam, rules, volume);
  set_limits(rules, foam, found_limits({}, rules));
  return rules;
}

/// One particle of foam.
inline FoamParticles single(FoamType type, const Vec3f& at, const Vec3f& velocity = {}, float life = 3) {
  FoamParticles one;
  one.position = {at}, one.velocity = {velocity}, one.type = {type};
  one.age = {1}, one.life = {life}, one.radius = {1e-3f}, one.id = {0}, one.next_id = 1;
  return one;
}

inline Vec3f at_rest(const Vec3f&) { return {}; }

}  // namespace dreampm::test
