// Pin: holds matter where it is, by brushes of the simulation that stand still.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class Pin final : public ToolOf<Pin> {
 public:
  static ToolInfo about() {
    return {.name = "pin",
            .key = 'N',
            .needs_matter = true,
            .verbs = {tool_verb<Pin, &Pin::pin>("pin", "X Y Z RADIUS | off",
                                                "holds matter where it is; off: lets all of it go")},
            .chance = 2};
  }

  void press(Gesture& g) override { g.post("pin", {g.hit->at.x, g.hit->at.y, g.hit->at.z, g.settings.radius}); }

  void pin(PlayModel& side, const Action& a) {
    Simulation& simulation = *side.simulation;
    const Pins all = pins_of(simulation);
    if (is_off(a)) {
      if (all.empty()) throw InputError("pin: nothing is held");
      side.before_own_edit("pin off");
      for (const auto& [name, stroke] : all) simulation.remove_brush(name);
      return;
    }
    const VelocityBrush hold{place_at(side, a, 0), size_at(side, a, 3), {}, rate};
    const auto name = [](int number) { return fmt::format("{}{}", prefix, number); };
    int number = 1;
    while (std::any_of(all.begin(), all.end(), [&](const auto& pin) { return pin.first == name(number); })) ++number;
    side.before_own_edit("pin");
    simulation.set_brush(name(number), hold);
  }

  /// Pins of a saved scene are fields there, and can be let go here.
  void load(Scene& scene) override {
    for (const model::ForceField& field : scene.model().fields)
      if (is_pin(field))
        loaded_.emplace_back(field.name, VelocityBrush{field.vectors.at("point"), field.numbers["radius"],
                                                       field.vectors.at("velocity"), field.numbers["rate"]});
    if (loaded_.empty()) return;
    model::Scene bare = scene.model();
    std::erase_if(bare.fields, is_pin);
    scene = Scene(std::move(bare), scene.file());
  }
  void start(Simulation& simulation) override {
    for (const auto& [name, stroke] : std::exchange(loaded_, {})) simulation.set_brush(name, stroke);
  }
  void save(const Simulation& simulation, model::Scene& scene) const override {
    for (const auto& [name, hold] : pins_of(simulation))
      scene.fields.push_back({name,
                              "brush",
                              {{"radius", hold.radius}, {"rate", hold.rate}},
                              {{"point", hold.point}, {"velocity", hold.velocity}},
                              {}});
  }
  void marks(const PlayModel& side, Frame& frame) const override {
    const Pins all = pins_of(*side.simulation);
    for (const auto& [name, stroke] : all)
      frame.marks.push_back({static_cast<Vec3f>(stroke.point), static_cast<float>(stroke.radius)});
    if (!all.empty())
      frame.buttons.push_back({all.size() == 1 ? "let the pin go" : "let all pins go", {"pin", {"off"}}});
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    if (dice.index(2) == 0) return {"pin", {"off"}};
    return Action::parse("pin " + dice.place(frame) + dice.length(frame, 0.05, 0.3));
  }

 private:
  using Pins = std::vector<std::pair<std::string, VelocityBrush>>;
  static constexpr std::string_view prefix = "pin-";
  /// 1/s: how fast what is pinned comes to rest.
  static constexpr double rate = 1e4;

  static bool is_pin(const model::ForceField& field) { return field.name.starts_with(prefix) && field.type == "brush"; }
  static Pins pins_of(const Simulation& simulation) {
    Pins all;
    for (const std::string& name : simulation.names().brushes)
      if (name.starts_with(prefix)) all.emplace_back(name, *simulation.brush(name));
    return all;
  }

  Pins loaded_;  ///< on their way from a scene to its simulation
};

}  // namespace

std::unique_ptr<Tool> make_pin() { return std::make_unique<Pin>(); }

}  // namespace dreampm::play
