// Rigid bodies in the playground: dropped, held, and taken out.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/error.h"
#include "dreampm/import/asset.h"
#include "dreampm/import/import.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/play/tools/cursor.h"
#include "dreampm/queries.h"
#include "dreampm/scene/description.h"
#include "dreampm/scene/emit.h"

namespace dreampm::play {
namespace {

/// 1/s: how fast the spring of a hand of strength 1 is, and m: how far it stretches at most.
constexpr double hold_frequency = 30, most_stretch = 0.15;
/// Spacings from the surface of a body within which a hand touches it.
constexpr double touching = 0.5;
/// Rigid bodies that there may be.
constexpr std::size_t most_bodies = 64;

/// Something to drop. Rigid ones have a density [kg/m^3] and a look, as in `render.looks`; others
/// are of the chosen matter. `form`: of a scene file, for a size of 1 m.
struct Thing {
  std::string_view name;
  double density;
  std::string_view look;
  Vec3d box;              ///< edges; of no box: 0
  double radius;          ///< of a sphere; of none: 0
  std::string_view mesh;  ///< of a scene file; of none: empty
};
constexpr Vec3d none{};
/// Falls where it was fetched; else the one that is made by code.
constexpr std::string_view fine_dragon = "asset:stanford-dragon", little_dragon = "asset:dragon";
constexpr std::array things{
    Thing{"box", 0, "", {1, 1, 1}, 0, ""},
    Thing{"sphere", 0, "", none, 0.5, ""},
    Thing{"knot", 0, "", none, 0, "asset:knot"},
    Thing{"dragon", 0, "", none, 0, fine_dragon},
    Thing{"crate", 400, "{type: wood}", {1, 1, 1}, 0, ""},
    Thing{"brick", 1800, "{type: opaque, color: [0.62, 0.25, 0.18], roughness: 0.8}", {1, 0.35, 0.5}, 0, ""},
    Thing{"ball", 250, "{type: plastic, color: [0.95, 0.62, 0.10]}", none, 0.5, ""},
};
/// Degrees about the upright axis that rigid ones are turned by, so that they show two faces.
constexpr double turned = 25;

std::string shape_of(const Thing& thing, const Vec3d& at, double size) {
  const std::string center = scene::flow_text(at);
  if (!thing.mesh.empty())
    return fmt::format("{{mesh: '{}', fit: {{longest: {}}}, center: {}}}", thing.mesh, size, center);
  if (thing.radius > 0) return fmt::format("{{sphere: {{radius: {}}}, center: {}}}", thing.radius * size, center);
  return fmt::format("{{box: {{size: {}}}, center: {}{}}}", scene::flow_text(thing.box * size), center,
                     thing.density > 0 ? fmt::format(", rotate: {{axis: y, angle: {}}}", turned) : "");
}

}  // namespace

double least_drop(const std::string& name) {
  const auto thing = std::find_if(things.begin(), things.end(), [&](const Thing& t) { return t.name == name; });
  constexpr double of_a_mesh = 24;
  return thing == things.end() || thing->mesh.empty() ? 0 : of_a_mesh;
}

const std::vector<std::string>& drop_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Thing& t : things) all.emplace_back(t.name);
    return all;
  }();
  return names;
}

void Playground::Impl::drop(const std::string& name, const Vec3d& at, double size) {
  const auto known = std::find_if(things.begin(), things.end(), [&](const Thing& t) { return t.name == name; });
  Thing thing = known == things.end() ? Thing{name, 0, "", none, 0, name} : *known;
  if (thing.mesh == fine_dragon && !is_fetched(fine_dragon)) {
    thing.mesh = little_dragon;
    say("a little dragon falls; tools/fetch_dragon fetches Stanford's");
  }
  const Vec3d falls{0, -0.5, 0};
  const SceneShape shape = SceneShape::yaml(shape_of(thing, at, size));
  const scene::SceneDescription& scene = simulation->scene().description();
  if (thing.density > 0) {
    const auto rigid = static_cast<std::size_t>(
        std::count_if(scene.colliders.begin(), scene.colliders.end(), [](const auto& c) { return c.rigid; }));
    if (rigid >= most_bodies) throw InputError(fmt::format("drop: {} rigid bodies are the most", most_bodies));
    // A scene that was saved has some of these names.
    std::string own;
    do own = fmt::format("{}-{}", name, ++drops);
    while (std::any_of(scene.colliders.begin(), scene.colliders.end(), [&](const auto& c) { return c.name == own; }));
    NewRigid body{own, shape};
    body.density = thing.density, body.velocity = falls, body.look = thing.look;
    simulation->add_rigid(body);
    return;
  }
  const double spacing = play_scene().scene.spacing();
  if (static_cast<double>(simulation->particle_count()) + std::pow(size / spacing, 3) >
      static_cast<double>(options.most_particles))
    throw InputError(fmt::format("drop: {} particles are the most", options.most_particles));
  // A file that cannot be read leaves no material behind that nothing is made of.
  if (known == things.end()) load_mesh(name);
  const std::string material = ensure_matter(static_cast<std::size_t>(settings.matter));
  simulation->add({fmt::format("drop-{}", ++drops), material, shape, falls});
}

std::string Playground::Impl::body_at(const Vec3d& at) const {
  std::string name;
  double nearest = touching * play_scene().scene.spacing();
  for (const NearCollider& body : colliders_near(*simulation, at, nearest))
    if (body.is_rigid && body.distance < nearest) nearest = body.distance, name = body.name;
  return name;
}

void Playground::Impl::take_hold(const Vec3d& at, double radius) {
  grab = Grab{at, at, radius, body_at(at), {}};
  if (!grab->body.empty()) grab->at = simulation->collider(grab->body).pose.inverse(at);
}

void Playground::Impl::hold_body() {
  const ColliderState body = simulation->collider(grab->body);
  const Vec3d held = body.pose(grab->at);
  if (const double far = length(grab->middle - held); far > most_stretch)
    grab->middle = held + (grab->middle - held) * (most_stretch / far);
  const double frequency = hold_frequency * std::sqrt(settings.strength);
  simulation->hold(grab->body, {grab->at, grab->middle, body.mass * frequency * frequency, 2 * body.mass * frequency});
}

void Playground::Impl::push_bodies() {
  simulation->let_go();
  for (const auto& [name, distance, is_rigid] : colliders_near(*simulation, push->at, push->radius)) {
    if (!is_rigid) continue;
    // As the brush does to matter: the velocity there comes to that of the hand, at that rate.
    const ColliderState body = simulation->collider(name);
    const double rate = push_rate * settings.strength;
    simulation->hold(name, {body.pose.inverse(push->at), push->at + push->velocity * (1 / rate),
                            body.mass * rate * rate, body.mass * rate});
  }
}

void Playground::Impl::erase(const Vec3d& at, double radius) {
  simulation->remove(SceneShape::sphere(at, radius));
  const std::string body = body_at(at);
  if (body.empty()) return;
  if (grab && grab->body == body) grab.reset();
  simulation->remove_rigid(body);
}

}  // namespace dreampm::play
