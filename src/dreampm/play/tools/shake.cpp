// Shake: a push of the whole box by the arrow keys, which fades.
#include <cmath>

#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class Shake final : public ToolOf<Shake> {
 public:
  static ToolInfo about() {
    return {
        .name = "shake",
        .verbs = {tool_verb<Shake, &Shake::shake>("shake", "X Y Z", "a push of the whole box [m/s^2], which fades")},
        .chance = 1};
  }

  void shake(PlayModel&, const Action& a) { acceleration_ = vector_at(a, 0); }
  Vec3d acceleration() const override { return acceleration_; }
  void tick(PlayModel&, double seconds) override {
    acceleration_ = length(acceleration_) < least ? Vec3d{} : acceleration_ * std::pow(left_after_a_second, seconds);
  }
  void reset(PlayModel&) override { acceleration_ = {}; }

  Action random(RandomActions& dice, const Frame&) const override {
    return Action::parse("shake" + dice.vector(-20, 20));
  }

 private:
  static constexpr double left_after_a_second = 1e-4;
  static constexpr double least = 0.05;  ///< m/s^2

  Vec3d acceleration_{};  ///< m/s^2
};

}  // namespace

std::unique_ptr<Tool> make_shake() { return std::make_unique<Shake>(); }

}  // namespace dreampm::play
