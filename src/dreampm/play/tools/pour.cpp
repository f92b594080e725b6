// Pour: a jet of the chosen matter, which comes down where the cursor is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/error.h"
#include "dreampm/geometry/region.h"
#include "dreampm/math/mat3.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/solver/emission_pattern.h"

namespace dreampm::play {
namespace {

class Pour final : public ToolOf<Pour> {
 public:
  static ToolInfo about() {
    return {.name = "pour",
            .key = 'O',
            .held_key = 'P',
            .hint = "hold P to pour; F1 shows all keys",
            .verbs = {tool_verb<Pour, &Pour::pour>("pour", "X Y Z RADIUS VX VY VZ | off",
                                                   "a jet of the chosen matter, three spacings in radius at least")},
            .chance = 3};
  }

  void press(Gesture& g) override {
    if (!g.hit) return;
    onto_ = g.hit->at;
    drag(g);
  }
  void drag(Gesture& g) override {
    if (!onto_) return;
    onto_ = below(g);
    const double height = std::min(g.domain.max.y - 2 * g.spacing, onto_->y + 0.4 * g.domain.size().y);
    const double radius = std::max(0.5 * g.settings.radius, least_jet * g.spacing);
    const Vec3d at = clamped({onto_->x, height, onto_->z}, g.domain, radius + g.spacing);
    g.post("pour", {at.x, at.y, at.z, radius, 0, -drag_speed, 0});
  }
  void release(Gesture& g) override {
    g.post("pour", {}, "off");
    onto_.reset();
  }

  void pour(PlayModel& side, const Action& a) {
    if (is_off(a)) {
      jet_.reset();
      return side.history.separate();
    }
    const Jet wanted{place_at(side, a, 0), vector_at(a, 4), size_at(side, a, 3)};
    constexpr double fastest = 1000;  // m/s
    if (const double speed = length(wanted.velocity); !(speed > 0 && speed <= fastest))
      throw InputError(fmt::format("pour: the velocity must be above 0, and {} m/s at most", fastest));
    side.before_edit("pour");
    if (jet_)
      jet_->at = wanted.at, jet_->velocity = wanted.velocity, jet_->radius = wanted.radius;
    else
      jet_ = wanted;
  }
  void tick(PlayModel& side, double) override {
    if (jet_) give(side);
  }
  void reset(PlayModel&) override { jet_.reset(); }

  Action random(RandomActions& dice, const Frame& frame) const override {
    if (dice.index(3) == 0) return {"pour", {"off"}};
    return Action::parse(fmt::format("pour {}{} {} {} {}", dice.place(frame), dice.length(frame, 0.05, 0.2),
                                     dice.number(-2, 2), dice.number(-4, -0.5), dice.number(-2, 2)));
  }

 private:
  struct Jet {
    Vec3d at, velocity;
    double radius;
    double travelled = 0;          ///< m
    std::optional<double> seen{};  ///< s: until when it has come out; absent: it begins
  };
  /// m/s, of the jet of a drag.
  static constexpr double drag_speed = 1.5;
  /// Spacings from matter within which nothing is poured.
  static constexpr double clear_way = 0.7;
  /// Of the speed of a jet: how fast its rim may come inward.
  static constexpr double most_contraction = 0.5;

  /// Where the cursor is at the height at which the jet began: what is poured is not aimed at.
  Vec3d below(const Gesture& g) const {
    const gl::Ray ray = g.ray();
    const double t = (onto_->y - static_cast<double>(ray.origin.y)) / static_cast<double>(ray.direction.y);
    // Of a ray that misses the plane within the box, or goes up, the jet stays where it is.
    if (!(std::isfinite(t) && t > 0)) return *onto_;
    Vec3d at = clamped(ray_at(ray, t), g.domain, g.spacing);
    at.y = onto_->y;
    return at;
  }

  /// What an emitter of that disc would give; where matter stands already none is born.
  void give(PlayModel& side) {
    Jet& jet = *jet_;
    Simulation& simulation = *side.simulation;
    // As much as has moved on since: a world that is slower than what is asked for is not
    // overfilled.
    const double now = simulation.time(), seconds = now - jet.seen.value_or(now);
    jet.seen = now;
    if (!(seconds > 0)) return;
    const double spacing = side.play_scene().scene.spacing(), speed = length(jet.velocity);
    const double radius = std::max(jet.radius, least_jet * spacing);
    const Vec3d along = jet.velocity * (1 / speed);
    Shape disc;
    disc.form = CylinderShape{radius, speed * seconds + spacing};
    disc.center = jet.at;
    const Rotation rotation = rotation_to(along);
    disc.rotate_axis = rotation.axis, disc.rotate_angle = rotation.angle;
    const std::shared_ptr<const Region> region = make_region(disc, spacing, {});
    const double before = jet.travelled;
    jet.travelled += speed * seconds;
    std::vector<Vec3d> places;
    const model::Space& space = simulation.scene().model().space;
    const Vec3d margin{0.5 * spacing, 0.5 * spacing, 0.5 * spacing};
    const Box3d room{space.min + margin, space.end() - margin};
    EmissionPattern(*region, along, spacing).for_entering(before, jet.travelled, false, [&](const Vec3d& at) {
      if (room.contains(at)) places.push_back(at);
    });
    if (places.empty()) return;
    const double far2 = std::pow(radius + 3 * spacing + speed * seconds, 2), near2 = std::pow(clear_way * spacing, 2);
    for (const std::string& material : simulation.scene().materials())
      simulation.visit(material, {}, [&](const ParticleBatch& some) {
        for (const Vec3d& x : some.position) {
          if (const Vec3d off = x - jet.at; dot(off, off) > far2) continue;
          std::erase_if(places, [&](const Vec3d& p) { return dot(x - p, x - p) < near2; });
        }
      });
    for (const ColliderShape& c : simulation.collider_shapes())
      std::erase_if(places, [&](const Vec3d& p) { return c.distance(p) < 0.5 * spacing; });
    if (places.empty()) return;
    if (simulation.particle_count() + places.size() > side.options.most_particles) {
      jet_.reset();
      return side.say(fmt::format("the jet ends: {} particles are the most", side.options.most_particles));
    }
    const std::string name = side.ensure_matter(side.settings.matter);
    // A jet that gravity draws out becomes as much thinner: its velocity is that of a flow that
    // keeps its volume. Nothing else would bring its particles together again, for liquids do not
    // pull.
    const double most = most_contraction * speed / radius;
    const double drawn_out = std::clamp(dot(side.gravity, along) / speed, -most, most);
    const Mat3d gradient = (outer(along, along) * 3.0 - Mat3d::identity()) * (0.5 * drawn_out);
    const auto row = [&](int a) { return Vec3d{gradient(a, 0), gradient(a, 1), gradient(a, 2)}; };
    std::vector<NewParticle> particles;
    for (const Vec3d& p : places)
      particles.push_back({p, jet.velocity + gradient * (p - jet.at), {row(0), row(1), row(2)}});
    simulation.add_particles(name, particles);
  }

  std::optional<Vec3d> onto_;  ///< m: what the jet of a drag is poured onto; in the window
  std::optional<Jet> jet_;     ///< in a playground
};

}  // namespace

std::unique_ptr<Tool> make_pour() { return std::make_unique<Pour>(); }

}  // namespace dreampm::play
