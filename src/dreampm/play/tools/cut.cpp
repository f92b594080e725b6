// Cut: takes out a thin disc, so that what a stroke crosses is in two. It parts matter by a gap,
// for what is nearer than a cell holds together.
#include <fmt/format.h>

#include "dreampm/error.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class Cut final : public ToolOf<Cut> {
 public:
  static ToolInfo about() {
    return {
        .name = "cut",
        .key = 'C',
        .verbs = {tool_verb<Cut, &Cut::cut>("cut", "X Y Z NX NY NZ RADIUS",
                                            "takes out a thin disc of that normal: what it went through is in two")},
        .chance = 1};
  }

  void release(Gesture& g) override {
    // The plane through the eye and both ends of the drag.
    const gl::Ray first = g.ray(g.from_x, g.from_y), last = g.ray();
    const Vec3d normal = static_cast<Vec3d>(cross(first.direction, last.direction));
    if (length(normal) < shortest) return;
    const Vec3d middle = g.domain.center();
    const Vec3d n = normalized(normal);
    const Vec3d at = middle - n * dot(middle - static_cast<Vec3d>(first.origin), n);
    g.post("cut", {at.x, at.y, at.z, n.x, n.y, n.z, length(g.domain.size())});
    g.post("release");
  }

  void cut(PlayModel& side, const Action& a) {
    const Vec3d at = place_at(side, a, 0), normal = vector_at(a, 3);
    if (!(length(normal) > 0)) throw InputError("cut: the normal must not be 0");
    const Rotation rotation = rotation_to(normalized(normal));
    const Shape disc = Shape::cylinder(at, size_at(side, a, 6), 2 * side.play_scene().scene.spacing())
                           .turned(rotation.axis, rotation.angle);
    side.before_edit("cut");
    const std::size_t before = side.simulation->particle_count();
    side.say(taken_text(side.simulation->remove(disc), before));
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    return Action::parse("cut " + dice.place(frame) + dice.vector(-1, 1) + dice.length(frame, 2, 2));
  }

 private:
  /// Sine of the angle between the rays of a stroke: a shorter one is none.
  static constexpr double shortest = 1e-3;

  static std::string taken_text(std::size_t taken, std::size_t before) {
    if (taken == 0) return "cut: no matter was in its way";
    return fmt::format("cut: {} particle{} taken out for a gap, {:.2g} % of all: Undo", grouped(taken),
                       taken == 1 ? "" : "s", 100 * static_cast<double>(taken) / static_cast<double>(before));
  }
};

}  // namespace

std::unique_ptr<Tool> make_cut() { return std::make_unique<Cut>(); }

}  // namespace dreampm::play
