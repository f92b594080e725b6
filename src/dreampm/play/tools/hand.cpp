// What the hand does to matter in each tick.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/error.h"
#include "dreampm/geometry/region.h"
#include "dreampm/math/mat3.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/scene/description.h"
#include "dreampm/solver/emission_pattern.h"

namespace dreampm::play {
namespace {

/// 1/s: how fast what is held comes to the hand, and m/s: no faster than this.
constexpr double hold_rate = 12, most_pull = 6;
/// Part of a shake that is left after a second.
constexpr double shake_left = 1e-4;
/// Spacings from matter within which nothing is poured.
constexpr double clear_way = 0.7;
/// Of the speed of a jet: how fast its rim may come inward.
constexpr double most_contraction = 0.5;

}  // namespace

Turn turn_to(const Vec3d& direction) {
  const Vec3d axis = cross(Vec3d{0, 1, 0}, direction);
  const double sine = length(axis);
  return {sine > 1e-9 ? axis * (1 / sine) : Vec3d{1, 0, 0}, std::atan2(sine, direction.y) * 180 / std::numbers::pi};
}

void Playground::Impl::apply_hand(double seconds) {
  const Vec3d wanted = Vec3d{settings.gravity_x, settings.gravity_y, settings.gravity_z} + shake;
  if (!(wanted == gravity)) simulation->set_gravity(gravity = wanted);
  if (const scene::Time& time = simulation->scene().description().time;
      time.solver == SolverKind::projection && time.cfl != settings.cfl)
    simulation->set_cfl(settings.cfl);
  shake = length(shake) < 0.05 ? Vec3d{} : shake * std::pow(shake_left, seconds);
  if (grab) {
    Vec3d velocity = (grab->hand - grab->middle) * hold_rate;
    if (const double speed = length(velocity); speed > most_pull) velocity *= most_pull / speed;
    if (grab->body.empty())
      simulation->set_brush("grab", {grab->middle, 1.5 * grab->radius, velocity, 200 * settings.strength});
    grab->middle += velocity * seconds;
    if (!grab->body.empty()) hold_body();
  }
  // One hand does one thing.
  if (push && !(grab && !grab->body.empty())) push_bodies();
  if (pour) pour_jet();
  move_walls();
}

/// What an emitter of that disc would give; where matter stands already none is born.
void Playground::Impl::pour_jet() {
  Pour& jet = *pour;
  // As much as has moved on since: a world that is slower than what is asked for is not overfilled.
  const double now = simulation->time(), seconds = now - jet.seen.value_or(now);
  jet.seen = now;
  if (!(seconds > 0)) return;
  const double spacing = play_scene().scene.spacing(), speed = length(jet.velocity);
  const double radius = std::max(jet.radius, least_jet * spacing);
  const Vec3d along = jet.velocity * (1 / speed);
  Shape disc;
  disc.form = CylinderShape{radius, speed * seconds + spacing};
  disc.center = jet.at;
  const Turn turn = turn_to(along);
  disc.rotate_axis = turn.axis, disc.rotate_angle = turn.angle;
  const std::shared_ptr<const Region> region = make_region(disc, spacing, {});
  const double before = jet.travelled;
  jet.travelled += speed * seconds;
  std::vector<Vec3d> places;
  const scene::Space& space = simulation->scene().description().space;
  const Vec3d margin{0.5 * spacing, 0.5 * spacing, 0.5 * spacing};
  const Box3d room{space.min + margin, space.max - margin};
  EmissionPattern(*region, along, spacing).for_entering(before, jet.travelled, false, [&](const Vec3d& at) {
    if (room.contains(at)) places.push_back(at);
  });
  if (places.empty()) return;
  const double far2 = std::pow(radius + 3 * spacing + speed * seconds, 2), near2 = std::pow(clear_way * spacing, 2);
  for (const std::string& material : simulation->scene().materials())
    simulation->visit(material, {}, [&](const ParticleBatch& some) {
      for (const Vec3d& x : some.position) {
        if (const Vec3d off = x - jet.at; dot(off, off) > far2) continue;
        std::erase_if(places, [&](const Vec3d& p) { return dot(x - p, x - p) < near2; });
      }
    });
  for (const ColliderShape& c : simulation->collider_shapes())
    std::erase_if(places, [&](const Vec3d& p) { return c.distance(p) < 0.5 * spacing; });
  if (places.empty()) return;
  if (simulation->particle_count() + places.size() > options.most_particles) {
    pour.reset();
    return say(fmt::format("the jet ends: {} particles are the most", options.most_particles));
  }
  const std::string name = ensure_matter(static_cast<std::size_t>(settings.matter));
  // A jet that gravity draws out becomes as much thinner: its velocity is that of a flow that keeps
  // its volume. Nothing else would bring its particles together again, for liquids do not pull.
  const double most = most_contraction * speed / radius;
  const double drawn_out = std::clamp(dot(gravity, along) / speed, -most, most);
  const Mat3d gradient = (outer(along, along) * 3.0 - Mat3d::identity()) * (0.5 * drawn_out);
  const auto row = [&](int a) { return Vec3d{gradient(a, 0), gradient(a, 1), gradient(a, 2)}; };
  std::vector<NewParticle> particles;
  for (const Vec3d& p : places)
    particles.push_back({p, jet.velocity + gradient * (p - jet.at), {row(0), row(1), row(2)}});
  simulation->add_particles(name, particles);
}

}  // namespace dreampm::play
