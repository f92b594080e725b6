// Stop: matter under the brush comes to rest while the button is held.
#pragma once
#include <memory>

#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {

class Stop final : public ToolOf<Stop> {
 public:
  static ToolInfo about() {
    return {.name = "stop",
            .key = 'T',
            .needs_matter = true,
            .verbs = {tool_verb<Stop, &Stop::stop>("stop", "X Y Z RADIUS",
                                                   "matter at that place comes to rest, until release")}};
  }

  // In the window: what drags post.
  void press(Gesture& g) override { g.post("stop", {g.hit->at.x, g.hit->at.y, g.hit->at.z, g.settings.radius}); }
  void drag(Gesture& g) override {
    if (g.hit->matter) press(g);
  }
  void release(Gesture& g) override { g.post("release"); }

  // In a playground: what verbs do.
  void stop(PlayModel& side, const Action& a) {
    const VelocityBrush stroke{place_at(side, a, 0), size_at(side, a, 3), {}, rate * side.settings.strength};
    side.before_edit("stop");
    side.simulation->set_brush("stop", stroke);
  }
  void end(PlayModel& side) override { side.simulation->remove_brush("stop"); }
  void reset(PlayModel& side) override { end(side); }

 private:
  static constexpr double rate = 100;  ///< 1/s at strength 1: how fast matter comes to rest
};

inline std::unique_ptr<Tool> make_stop() { return std::make_unique<Stop>(); }

}  // namespace dreampm::play
