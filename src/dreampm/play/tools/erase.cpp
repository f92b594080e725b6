// Erase: takes out the matter around, and the rigid body there.
#include <algorithm>

#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class Erase final : public ToolOf<Erase> {
 public:
  static ToolInfo about() {
    return {.name = "erase",
            .key = 'E',
            .needs_matter = true,
            .verbs = {tool_verb<Erase, &Erase::erase>("erase", "X Y Z RADIUS",
                                                      "takes out the matter around, and the rigid body at that place")},
            .chance = 1};
  }

  void press(Gesture& g) override {
    if (g.hit && g.hit->matter) g.post("erase", {g.hit->at.x, g.hit->at.y, g.hit->at.z, g.settings.radius});
  }
  void drag(Gesture& g) override { press(g); }
  void release(Gesture& g) override { g.post("release"); }

  void erase(PlayModel& side, const Action& a) {
    const Vec3d at = place_at(side, a, 0);
    const double radius = std::min(positive_at(a, 3), box_size(side));  // which is all of it
    side.before_edit("erase");
    side.simulation->remove(Shape::sphere(at, radius));
    const std::string body = body_at(side, at);
    if (body.empty()) return;
    for (const auto& tool : side.tools) tool->body_removed(body);
    side.simulation->remove_collider(body);
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    return Action::parse("erase " + dice.place(frame) + dice.length(frame, 0.1, 0.5));
  }
};

}  // namespace

std::unique_ptr<Tool> make_erase() { return std::make_unique<Erase>(); }

}  // namespace dreampm::play
