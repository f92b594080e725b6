// What drags beside matter, and those with other buttons, do: they turn the view, or shift it.
#include <cmath>

#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class Turn final : public ToolOf<Turn> {
 public:
  static ToolInfo about() { return {.name = "turn"}; }
  void drag(Gesture& g) override {
    g.camera.orbit(static_cast<float>(-g.dx * 4 / g.height), static_cast<float>(g.dy * 4 / g.height));
  }
};

class Shift final : public ToolOf<Shift> {
 public:
  static ToolInfo about() { return {.name = "shift"}; }
  void drag(Gesture& g) override {
    // What is under the cursor stays there.
    const double wide = std::tan(static_cast<double>(g.seen_by().view_angle) / 2) /
                        std::tan(static_cast<double>(g.camera.view_angle) / 2) / g.height;
    g.camera.pan(static_cast<float>(-g.dx * wide), static_cast<float>(g.dy * wide));
  }
};

}  // namespace

std::unique_ptr<Tool> make_turn() { return std::make_unique<Turn>(); }
std::unique_ptr<Tool> make_shift() { return std::make_unique<Shift>(); }

}  // namespace dreampm::play
