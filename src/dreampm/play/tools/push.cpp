// Push: a cursor that moves over matter takes matter and rigid bodies along; a drag takes hold of
// them, as grab does.
#include <cmath>

#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/grab.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/queries.h"

namespace dreampm::play {
namespace {

class Push final : public ToolOf<Push> {
 public:
  static ToolInfo about() {
    return {.name = "push",
            .key = 'Q',
            .hint = "move the pointer through the matter to push it",
            .needs_matter = true,
            .verbs = {tool_verb<Push, &Push::push>(
                          "push", "X Y Z RADIUS VX VY VZ",
                          "matter and rigid bodies at that place are taken along at that velocity, until release")
                          .by_passing()},
            .chance = 2};
  }

  void press(Gesture& g) override { begin_pick(g); }
  void drag(Gesture& g) override { update_pick(g); }
  void release(Gesture& g) override { end_pick(g); }

  void hover(Gesture& g) override {
    if (g.is_pressed || !g.hit->matter || !last_hit_) {
      rest(g);
      last_hit_ = g.hit;
      return;
    }
    // In the plane of the picture: what the ray meets may jump.
    const Vec3d forward = static_cast<Vec3d>(g.camera.axes().forward);
    Vec3d way = g.hit->at - last_hit_->at;
    way -= forward * dot(way, forward);
    cursor_velocity_ = cursor_velocity_ * 0.5 + way * (0.5 / g.seconds);
    if (const double speed = length(cursor_velocity_); speed > fastest) cursor_velocity_ *= fastest / speed;
    if (length(cursor_velocity_) > slowest) {
      const Vec3d &at = g.hit->at, &v = cursor_velocity_;
      g.post("push", {at.x, at.y, at.z, g.settings.radius, v.x, v.y, v.z});
      is_pushing_ = true;
    } else {
      rest(g);
    }
    last_hit_ = g.hit;
  }
  void leave(Gesture& g) override {
    rest(g);
    last_hit_.reset();
  }

  void push(PlayModel& side, const Action& a) {
    const VelocityBrush stroke{place_at(side, a, 0), size_at(side, a, 3), vector_at(a, 4),
                               rate * side.settings.strength};
    // Strokes that follow one another are one edit.
    if (side.clock.played > pushed_ + same_edit) side.history.separate();
    side.before_edit("push");
    pushed_ = side.clock.played;
    side.simulation->set_brush("push", stroke);
    stroke_ = stroke;
  }
  void tick(PlayModel& side, double) override {
    if (!stroke_) return;
    // One cursor does one thing.
    for (const auto& other : side.tools)
      if (other->holds_body()) return;
    side.simulation->detach();
    for (const auto& [name, distance, is_rigid] : colliders_near(*side.simulation, stroke_->point, stroke_->radius)) {
      if (!is_rigid) continue;
      // As the brush does to matter: the velocity there comes to that of the stroke, at that rate.
      const ColliderState body = side.simulation->collider(name);
      const double own_rate = rate * side.settings.strength;
      side.simulation->attach(name,
                              {body.pose.inverse(stroke_->point), stroke_->point + stroke_->velocity * (1 / own_rate),
                               body.mass * own_rate * own_rate, body.mass * own_rate});
    }
  }
  void end(PlayModel& side) override { reset(side); }
  bool goes_on(std::string_view edit) const override { return edit == "push"; }
  void reset(PlayModel& side) override {
    stroke_.reset();
    side.simulation->remove_brush("push");
    side.simulation->detach();
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    return Action::parse("push " + dice.place(frame) + dice.length(frame, 0.1, 0.4) + dice.vector(-5, 5));
  }

 private:
  /// m/s: a cursor that is faster pushes as if it were this fast, and a slower one not at all.
  static constexpr double fastest = 5, slowest = 0.05;
  /// 1/s at strength 1: how fast what is pushed takes on the velocity of the cursor.
  static constexpr double rate = 60;
  /// s of playing, from one push to the next of the same edit.
  static constexpr double same_edit = 2;

  void rest(Gesture& g) {
    if (is_pushing_) g.post("release");
    is_pushing_ = false;
  }

  // In the window.
  std::optional<Hit> last_hit_;
  Vec3d cursor_velocity_{};  ///< m/s
  bool is_pushing_ = false;
  // In a playground.
  std::optional<VelocityBrush> stroke_;
  double pushed_ = 0;  ///< s of playing: when it was pushed last
};

}  // namespace

std::unique_ptr<Tool> make_push() { return std::make_unique<Push>(); }

}  // namespace dreampm::play
