// Grab: takes hold of matter, which a brush draws to the cursor, or of a rigid body, which a spring
// does.
#include <algorithm>
#include <cmath>

#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/grab.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class Grab final : public ToolOf<Grab> {
 public:
  static ToolInfo about() {
    return {.name = "grab",
            .key = 'G',
            .hint = "drag matter to grab it, drag elsewhere to turn the view",
            .needs_matter = true,
            .verbs = {tool_verb<Grab, &Grab::begin>(
                          "grab", "X Y Z RADIUS",
                          "takes hold of the rigid body or the matter at that place, until release"),
                      tool_verb<Grab, &Grab::update>("pull", "X Y Z", "draws what is held to that place"),
                      Verb{"release", "", "ends push and grab", &Grab::end_all}.by_passing()},
            .chance = 3};
  }

  void press(Gesture& g) override { begin_pick(g); }
  void drag(Gesture& g) override { update_pick(g); }
  void release(Gesture& g) override { end_pick(g); }

  void begin(PlayModel& side, const Action& a) {
    const Vec3d at = place_at(side, a, 0);
    const double radius = size_at(side, a, 3);
    side.before_edit("grab");
    side.simulation->detach();
    pick_ = PickConstraint{at, at, radius, body_at(side, at), {}};
    if (holds_body()) pick_->at = side.simulation->collider(pick_->body).pose.inverse(at);
  }
  static void end_all(PlayModel& side, const Action&) {
    for (const auto& tool : side.tools) tool->end(side);
    const std::string& edit = side.history.last_edit();
    if (std::none_of(side.tools.begin(), side.tools.end(), [&](const auto& tool) { return tool->goes_on(edit); }))
      side.history.separate();
  }
  void update(PlayModel& side, const Action& a) {
    if (pick_) pick_->target = place_at(side, a, 0);
  }
  void tick(PlayModel& side, double seconds) override {
    if (!pick_) return;
    Vec3d velocity = (pick_->target - pick_->middle) * rate;
    if (const double speed = length(velocity); speed > fastest) velocity *= fastest / speed;
    if (!holds_body())
      side.simulation->set_brush("grab",
                                 {pick_->middle, 1.5 * pick_->radius, velocity, brush_rate * side.settings.strength});
    pick_->middle += velocity * seconds;
    if (holds_body()) hold(side);
  }
  void end(PlayModel& side) override { reset(side); }
  void reset(PlayModel& side) override {
    pick_.reset();
    side.simulation->remove_brush("grab");
    side.simulation->detach();
  }
  bool holds_body() const override { return pick_ && !pick_->body.empty(); }
  void body_removed(std::string_view name) override {
    if (holds_body() && pick_->body == name) pick_.reset();
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    switch (dice.index(3)) {
      case 0:
        return Action::parse("grab " + dice.place(frame) + dice.length(frame, 0.1, 0.3));
      case 1:
        return Action::parse("pull " + dice.place(frame));
      default:
        return {"release", {}};
    }
  }

 private:
  /// What is held.
  struct PickConstraint {
    Vec3d target;  ///< m: where the cursor is
    Vec3d middle;  ///< m, of the matter that is held; of a body where the spring ends
    double radius;
    std::string body;  ///< name; empty: matter
    Vec3d at;          ///< m, of the body's shape: where it is held
  };
  /// 1/s: how fast what is held comes to the cursor, and m/s: no faster than this.
  static constexpr double rate = 12, fastest = 6;
  /// 1/s at strength 1: how fast matter takes on that velocity.
  static constexpr double brush_rate = 200;
  /// 1/s: how fast the spring of strength 1 is, and m: how far it stretches at most.
  static constexpr double spring_frequency = 30, most_stretch = 0.15;

  void hold(PlayModel& side) {
    const ColliderState body = side.simulation->collider(pick_->body);
    const Vec3d held = body.pose(pick_->at);
    if (const double far = length(pick_->middle - held); far > most_stretch)
      pick_->middle = held + (pick_->middle - held) * (most_stretch / far);
    const double frequency = spring_frequency * std::sqrt(side.settings.strength);
    side.simulation->attach(pick_->body,
                            {pick_->at, pick_->middle, body.mass * frequency * frequency, 2 * body.mass * frequency});
  }

  std::optional<PickConstraint> pick_;
};

}  // namespace

void begin_pick(Gesture& g) { g.post("grab", {g.hit->at.x, g.hit->at.y, g.hit->at.z, g.settings.radius}); }
void update_pick(Gesture& g) {
  const Vec3d to = clamped(g.on_drag_plane(), g.domain, g.spacing);
  g.post("pull", {to.x, to.y, to.z});
}
void end_pick(Gesture& g) { g.post("release"); }

std::unique_ptr<Tool> make_grab() { return std::make_unique<Grab>(); }

}  // namespace dreampm::play
