#include "dreampm/play/model/live_foam.h"

#include <algorithm>
#include <utility>

#include "dreampm/foam/from_scene.h"
#include "dreampm/model/scene.h"
#include "dreampm/scene/foam.h"

namespace dreampm::play {
namespace {

/// s of simulated time from one to the next.
constexpr double foam_interval = 1.0 / 20;
/// s: after a longer gap it begins anew.
constexpr double longest_gap = 0.25;
/// At once: what a window draws in time.
constexpr std::size_t most_live = 20000;
/// Limits are found of every fourth, and of the last ones.
constexpr int limits_every = 4;
constexpr std::size_t most_maxima = 150;

FoamingMatter matter_of(const Simulation& simulation, const model::Foam& foam, bool dust) {
  FoamingMatter all;
  const auto kind = dust ? scene::FoamKind::dust : scene::FoamKind::water;
  for (const model::Material& material : simulation.scene().model().materials) {
    if (!scene::foams(foam, material) || scene::foam_kind(material) != kind) continue;
    const ParticleView some = simulation.particles(material.name);
    all.position.insert(all.position.end(), some.position.begin(), some.position.end());
    all.velocity.insert(all.velocity.end(), some.velocity.begin(), some.velocity.end());
    all.volume_ratio.insert(all.volume_ratio.end(), some.J.begin(), some.J.end());
    for (const std::uint32_t id : some.id) all.id.push_back(static_cast<std::int32_t>(id));
  }
  return all;
}

std::vector<std::string> names_of(const std::vector<model::Collider>& colliders) {
  std::vector<std::string> names;
  for (const model::Collider& c : colliders) names.push_back(c.name);
  return names;
}

/// Of foam that of the scene, of dust that of the matter.
Vec3f color_of(const Simulation& simulation, const model::Foam& foam, bool dust) {
  const model::Scene& scene = simulation.scene().model();
  for (const model::Material& m : scene.materials)
    if (dust && scene::foams(foam, m) && scene::foam_kind(m) == scene::FoamKind::dust)
      return static_cast<Vec3f>(scene.render.looks.at(m.name).color);
  return static_cast<Vec3f>(foam.color);
}

std::uint8_t byte(float share) { return static_cast<std::uint8_t>(255 * std::clamp(share, 0.0f, 1.0f) + 0.5f); }

}  // namespace

FrameRecord LiveFoam::record(const Simulation& simulation) const {
  FrameRecord now;
  now.time = simulation.time();
  for (const std::string& name : colliders_) now.poses[name] = simulation.collider(name).pose;
  return now;
}

void LiveFoam::move(Kind& kind, const Simulation& simulation, const model::Foam& foam, const FrameRecord& now) {
  const model::Scene& scene = simulation.scene().model();
  FoamingMatter matter = matter_of(simulation, foam, kind.dust);
  if (matter.position.empty() && kind.foam.size() == 0) return;
  kind.color = color_of(simulation, foam, kind.dust);
  kind.volume = std::max(kind.volume, static_cast<double>(matter.position.size()) * std::pow(scene.space.spacing, 3));
  FoamRules rules = foam_rules(foam, scene, kind.dust, {}, kind.volume);
  rules.most = std::min(rules.most, most_live);
  const std::vector<foam::Obstacle> obstacles = obstacles_->at(now, before_);
  if (!limits_given(foam) && frame_ % limits_every == 0) {
    kind.maxima.push_back(foam_maxima(matter.view(), obstacles, rules));
    if (kind.maxima.size() > most_maxima) kind.maxima.erase(kind.maxima.begin());
  }
  set_limits(rules, foam, found_limits(kind.maxima, rules));
  if (frame_ > 0)
    kind.foam = advance_foam(kind.foam, kind.matter.view(), matter.view(), obstacles,
                             static_cast<float>(now.time - before_.time), frame_, rules)
                    .particles;
  kind.matter = std::move(matter);
}

void LiveFoam::see(const Simulation& simulation) {
  const double time = simulation.time();
  if (!kinds_.empty() && (time < before_.time || time > before_.time + longest_gap)) forget();
  if (!kinds_.empty() && time < before_.time + 0.999 * foam_interval) return;
  const model::Scene& scene = simulation.scene().model();
  if (std::vector<std::string> names = names_of(scene.colliders); !obstacles_ || names != colliders_)
    obstacles_ = std::make_shared<const FoamObstacles>(scene, Vec3d{}), colliders_ = std::move(names);
  FrameRecord now = record(simulation);
  if (kinds_.empty()) kinds_ = {{.dust = false}, {.dust = true}}, before_ = now;
  const model::Foam foam = scene.foam.value_or(model::Foam{});
  for (Kind& kind : kinds_) move(kind, simulation, foam, now);
  before_ = std::move(now), ++frame_;
}

void LiveFoam::show(double time, FoamSprites& in_liquid, FoamSprites& outside) const {
  for (FoamSprites* s : {&in_liquid, &outside}) s->position.clear(), s->radius.clear(), s->color.clear();
  const auto later = static_cast<float>(time - before_.time);
  for (const Kind& kind : kinds_)
    for (std::size_t i = 0; i < kind.foam.size(); ++i) {
      const FoamType type = kind.foam.type[i];
      FoamSprites& to = type == FoamType::bubble ? in_liquid : outside;
      to.position.push_back(kind.foam.position[i] + kind.foam.velocity[i] * later);
      to.radius.push_back(kind.foam.radius[i]);
      to.color.push_back({byte(kind.color.x), byte(kind.color.y), byte(kind.color.z),
                          byte(foam_opacity[static_cast<std::size_t>(type)])});
    }
}

}  // namespace dreampm::play
