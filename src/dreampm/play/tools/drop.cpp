// Drop: things that fall into the box, rigid or of the chosen matter.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/error.h"
#include "dreampm/import/asset.h"
#include "dreampm/import/import.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/drop.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

/// Something to drop. Rigid ones have a density [kg/m^3] and a look; others are of the chosen
/// matter. Lengths are of one that is 1 m large.
struct DropShape {
  std::string_view name;
  double density;
  model::Look look;
  Vec3d box;              ///< edges; of no box: 0
  double radius;          ///< of a sphere; of none: 0
  std::string_view mesh;  ///< of a scene file; of none: empty
};
constexpr Vec3d no_box{};
/// Falls where it was fetched; else the one that is made by code.
constexpr std::string_view fine_dragon = "asset:stanford-dragon", little_dragon = "asset:dragon";
const std::array drop_shapes{
    DropShape{"box", 0, {}, {1, 1, 1}, 0, ""},
    DropShape{"sphere", 0, {}, no_box, 0.5, ""},
    DropShape{"knot", 0, {}, no_box, 0, "asset:knot"},
    DropShape{"dragon", 0, {}, no_box, 0, fine_dragon},
    DropShape{"crate", 400, model::Look::wood(), {1, 1, 1}, 0, ""},
    DropShape{"brick", 1800, model::Look::opaque({0.62, 0.25, 0.18}, 0.8), {1, 0.35, 0.5}, 0, ""},
    DropShape{"ball", 250, model::Look::plastic({0.95, 0.62, 0.10}), no_box, 0.5, ""},
};

/// Null: it is a file of a mesh.
const DropShape* find_shape(std::string_view name) {
  const auto known =
      std::find_if(drop_shapes.begin(), drop_shapes.end(), [&](const DropShape& s) { return s.name == name; });
  return known == drop_shapes.end() ? nullptr : &*known;
}

Shape form_of(const DropShape& shape, const Vec3d& at, double size) {
  constexpr double turned = 25;  // degrees about the upright axis, of rigid ones: they show two faces
  if (!shape.mesh.empty()) return Shape::mesh(std::string(shape.mesh), size, at);
  if (shape.radius > 0) return Shape::sphere(at, shape.radius * size);
  const Shape box{BoxShape{shape.box * size}, {0, 1, 0}, 0, at};
  return shape.density > 0 ? box.turned({0, 1, 0}, turned) : box;
}

class Drop final : public ToolOf<Drop> {
 public:
  static ToolInfo about() {
    return {.name = "drop",
            .key = 'D',
            .verbs = {tool_verb<Drop, &Drop::drop>("drop", "SHAPE X Y Z SIZE",
                                                   "a box, sphere, knot, dragon, or mesh from a file, of the chosen "
                                                   "matter; or a rigid crate, brick or ball [m]")},
            .chance = 1};
  }

  void press(Gesture& g) override {
    if (!g.hit) return;
    const std::string& name = drop_names().at(g.settings.drop);
    // The shape of a mesh would be crumbs at fewer spacings.
    constexpr double least_of_a_mesh = 24;
    const DropShape* const shape = find_shape(name);
    const Vec3d room = g.domain.size();
    const double least = shape && !shape->mesh.empty() ? least_of_a_mesh * g.spacing : 0;
    const double size = std::max(2 * g.settings.radius, std::min(least, 0.8 * std::min(room.x, room.z)));
    const Vec3d at = above(*g.hit, g.domain, size, g.spacing);
    g.post("drop", {at.x, at.y, at.z, size}, name);
  }

  void drop(PlayModel& side, const Action& a) {
    const Vec3d at = place_at(side, a, 1);
    const double size = size_at(side, a, 4);
    side.history.separate();
    side.before_edit("drop");
    try {
      add(side, a.word(0), at, size);
    } catch (const InputError&) {
      side.history.forget_edit();
      throw;
    }
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    // Files take their time.
    static constexpr std::string_view shapes[] = {"box", "sphere", "crate", "brick", "ball"};
    return Action::parse(fmt::format("drop {} {}{}", shapes[dice.index(std::size(shapes))], dice.place(frame),
                                     dice.length(frame, 0.1, 0.4)));
  }

 private:
  /// Rigid bodies that there may be.
  static constexpr std::size_t most_bodies = 64;

  void add(PlayModel& side, const std::string& name, const Vec3d& at, double size) {
    Simulation& simulation = *side.simulation;
    const DropShape* const known = find_shape(name);
    DropShape shape = known ? *known : DropShape{name, 0, {}, no_box, 0, name};
    if (shape.mesh == fine_dragon && !is_fetched(fine_dragon)) {
      shape.mesh = little_dragon;
      side.say("a little dragon falls; tools/fetch_dragon fetches Stanford's");
    }
    const Vec3d falls{0, -0.5, 0};
    const Shape form = form_of(shape, at, size);
    const model::Scene& scene = simulation.scene().model();
    if (shape.density > 0) {
      const auto rigid = static_cast<std::size_t>(
          std::count_if(scene.colliders.begin(), scene.colliders.end(), [](const auto& c) { return c.rigid; }));
      if (rigid >= most_bodies) throw InputError(fmt::format("drop: {} rigid bodies are the most", most_bodies));
      // A scene that was saved has some of these names.
      std::string own;
      do own = fmt::format("{}-{}", name, ++drops_);
      while (std::any_of(scene.colliders.begin(), scene.colliders.end(), [&](const auto& c) { return c.name == own; }));
      model::Collider body{own, form};
      body.friction = 0.4;
      body.rigid = {.density = shape.density, .velocity = falls};
      simulation.add(body, shape.look);
      return;
    }
    const double spacing = side.play_scene().scene.spacing();
    if (static_cast<double>(simulation.particle_count()) + std::pow(size / spacing, 3) >
        static_cast<double>(side.options.most_particles))
      throw InputError(fmt::format("drop: {} particles are the most", side.options.most_particles));
    // A file that cannot be read leaves no material behind that nothing is made of.
    if (!known) load_mesh(name);
    const std::string material = side.ensure_matter(side.settings.matter);
    simulation.add({fmt::format("drop-{}", ++drops_), material, form, falls});
  }

  int drops_ = 0;  ///< made so far
};

}  // namespace

Vec3d above(const Hit& hit, const Box3d& domain, double size, double spacing) {
  return clamped({hit.at.x, domain.min.y + 0.75 * domain.size().y, hit.at.z}, domain, 0.55 * size + spacing);
}

Action drop_file(const std::string& file, const Vec3d& at, double size) {
  return {"drop", {file, text_of(at.x), text_of(at.y), text_of(at.z), text_of(size)}};
}

const std::vector<std::string>& drop_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const DropShape& s : drop_shapes) all.emplace_back(s.name);
    return all;
  }();
  return names;
}

std::unique_ptr<Tool> make_drop() { return std::make_unique<Drop>(); }

}  // namespace dreampm::play
