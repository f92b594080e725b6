#include "dreampm/foam/from_scene.h"

#include <cmath>

namespace dreampm {
namespace {

constexpr double scales_along = 16;  ///< of the side of a cube of all matter
constexpr double in_a_scale = 5000;  ///< 1/s in its cube, of a cause at its upper limit
constexpr double radii_in_scale = 20;

FoamCause cause(const FoamCause& found, float share, const model::FoamLimits& given) {
  FoamCause c{share, given.from ? static_cast<float>(*given.from) : found.from,
              given.to ? static_cast<float>(*given.to) : found.to};
  // A limit that is given goes before one that is found on its other side.
  if (!(c.to > c.from)) (given.from ? c.to : c.from) = given.from ? 2 * c.from : 0.5f * c.to;
  if (!(c.to > c.from)) c.to = c.from + 1e-6f;
  return c;
}

}  // namespace

FoamRules foam_rules(const model::Foam& foam, FoamRules rules, double volume) {
  const double whole = std::max(std::cbrt(volume) / scales_along, 1e-9);
  // The rate goes by the volume of the matter alone: what cells are made of it must not change it.
  // Where a cell is the scale, what moves seems as much thicker as that is more.
  const double base = foam.scale.value_or(whole);
  rules.scale = std::max(rules.cell, static_cast<float>(base));
  rules.rate = static_cast<float>(foam.amount *
                                  foam.rate.value_or(in_a_scale / (base * base * static_cast<double>(rules.scale))));
  rules.radius = static_cast<float>(foam.radius.value_or(base / radii_in_scale));
  rules.life_min = static_cast<float>(foam.life_min), rules.life_max = static_cast<float>(foam.life_max);
  rules.grow = static_cast<float>(foam.grow), rules.fade = static_cast<float>(foam.fade);
  rules.rise = static_cast<float>(foam.rise.value_or(-1));
  rules.drag = static_cast<float>(foam.drag);
  rules.most = static_cast<std::size_t>(foam.most);
  return rules;
}

FoamRules foam_rules(const model::Foam& foam, const model::Scene& scene, bool dust, const Vec3d& shift, double volume) {
  FoamRules rules;
  rules.room.box = {static_cast<Vec3f>(scene.space.min - shift), static_cast<Vec3f>(scene.space.end() - shift)};
  for (std::size_t w = 0; w < 6; ++w) rules.room.is_wall[w] = scene.space.walls[w].type != WallType::open;
  rules.room.periodic = scene.space.periodic;
  rules.gravity = static_cast<Vec3f>(scene.gravity);
  rules.spacing = static_cast<float>(scene.space.spacing);
  rules.cell = static_cast<float>(std::max(2 * scene.space.spacing, scene.space.dx()));
  rules.seed = scene.seed;
  rules.shift = shift, rules.dust = dust;
  return foam_rules(foam, rules, volume);
}

bool limits_given(const model::Foam& foam) {
  const auto both = [](const model::FoamLimits& l) { return l.from && l.to; };
  return both(foam.speed) && both(foam.trapped_air.limits) && both(foam.crest.limits) && both(foam.vorticity.limits);
}

void set_limits(FoamRules& rules, const model::Foam& foam, const FoamFound& found) {
  const auto of = [](const FoamCause& c, const model::FoamSource& s) {
    return cause(c, static_cast<float>(s.share), s.limits);
  };
  rules.speed = cause(found.speed, 1, foam.speed);
  rules.trapped_air = of(found.trapped_air, foam.trapped_air);
  rules.crest = of(found.crest, foam.crest);
  if (rules.dust) rules.crest.share = 0;  // grains have no waves: what flies whole stays whole
  rules.vorticity = of(found.vorticity, foam.vorticity);
}

}  // namespace dreampm
