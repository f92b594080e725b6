// Walls: sides of the box that are dragged. Each is a slab behind the wall, wider than the box,
// which is put in where the wall is first dragged and taken out where it is back at its place.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/tools/arguments.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/play/tools/wall_face.h"

namespace dreampm::play {
namespace {

struct WallAxis {
  int axis;
  bool is_high;
  double sign() const { return is_high ? 1 : -1; }  ///< outward
  /// m: where the scene has the wall.
  double own(const model::Space& space) const { return is_high ? space.end()[axis] : space.min[axis]; }
};
/// Sides count as in Side.
WallAxis axis_of(std::size_t side) { return {static_cast<int>(side) / 2, side % 2 == 1}; }

/// Whether some part of a body lies on that plane across the wall's axis.
bool reaches(const ColliderShape& body, int axis, double plane) {
  constexpr int samples = 16;
  const Box3d box = body.bounds();
  if (plane < box.min[axis] || plane > box.max[axis]) return false;
  for (int n = 0; n < samples * samples; ++n) {
    Vec3d p;
    p[axis] = plane;
    for (const int a : {(axis + 1) % 3, (axis + 2) % 3}) {
      const int part = a == (axis + 1) % 3 ? n / samples : n % samples;
      p[a] = box.min[a] + (part + 0.5) / samples * box.size()[a];
    }
    if (body.distance(p) < 0) return true;
  }
  return false;
}

/// Of the collider that stands for a wall that was dragged.
std::string collider_name(std::size_t side) { return fmt::format("wall-{}", side_names.at(side)); }

const model::Space& space_of(const Simulation& simulation) { return simulation.scene().model().space; }

bool has_slab(const Simulation& simulation, std::size_t side) {
  const auto& colliders = simulation.scene().model().colliders;
  return std::any_of(colliders.begin(), colliders.end(), [&](const auto& c) { return c.name == collider_name(side); });
}

/// m, along its axis: where the inner face of a wall is.
double wall_at(const Simulation& simulation, std::size_t side) {
  const WallAxis w = axis_of(side);
  if (!has_slab(simulation, side)) return w.own(space_of(simulation));
  const std::string name = collider_name(side);
  const Box3d box = simulation.collider_shape(name).own_bounds();
  return simulation.collider(name).pose.position[w.axis] + (w.is_high ? box.min : box.max)[w.axis];
}

/// What is between the walls.
Box3d room_of(const Simulation& simulation) {
  const model::Space& space = space_of(simulation);
  Box3d box{space.min, space.end()};
  for (std::size_t side = 0; side < 6; ++side)
    if (has_slab(simulation, side)) {
      const WallAxis w = axis_of(side);
      (w.is_high ? box.max : box.min)[w.axis] = wall_at(simulation, side);
    }
  return box;
}

/// As a wall that was dragged is drawn.
BodyFrame plane_of(const Simulation& simulation, std::size_t side) {
  const WallAxis w = axis_of(side);
  const int u = (w.axis + 1) % 3, v = (w.axis + 2) % 3;
  Box3d face = room_of(simulation);
  (w.is_high ? face.min : face.max)[w.axis] = wall_at(simulation, side);
  TriMesh quad;
  for (int n = 0; n < 4; ++n) {
    Vec3d corner = face.min;
    if (n == 1 || n == 2) corner[u] = face.max[u];
    if (n >= 2) corner[v] = face.max[v];
    quad.vertices.push_back(static_cast<Vec3f>(corner));
  }
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  return BodyFrame{collider_name(side),   false, std::make_shared<const TriMesh>(std::move(quad)), {},
                   {0.45f, 0.62f, 0.85f}, 0.3f};
}

class Walls final : public ToolOf<Walls> {
 public:
  static ToolInfo about() {
    return {.name = "walls",
            .key = 'W',
            .needs_matter = true,
            .verbs = {tool_verb<Walls, &Walls::wall>(
                "wall", "SIDE POSITION | off",
                "drags a wall, as x_min, to that place along its axis [m], as fast as matter gives way; off: all go "
                "back")},
            .chance = 1};
  }

  // It takes walls in place of matter.
  Hit pick(const Frame& frame, const gl::Ray& ray) override {
    const std::optional<WallFace> face = pick_wall(frame.room, ray);
    under_ = face ? std::optional(face->side) : std::nullopt;
    return face ? Hit{face->at, true} : Hit{play::pick(frame, ray).at, false};
  }
  bool picks_while_dragged() const override { return false; }
  std::optional<CursorMark> mark(const Gesture& g) const override {
    if (g.is_drag || !g.hit) return std::nullopt;
    CursorMark ring{static_cast<Vec3f>(g.hit->at), {}, static_cast<float>(g.settings.radius)};
    if (under_)
      ring.normal[static_cast<int>(*under_) / 2] = 1;
    else
      ring.normal.y = 1;
    return ring;
  }
  void drag(Gesture& g) override {
    if (!under_) return;
    const std::optional<double> to = drawn_to(*under_, g.from, g.ray());
    if (!to) return;
    const auto side = static_cast<std::size_t>(*under_);
    const int axis = axis_of(side).axis;
    const double least = least_room * g.domain.size()[axis];
    // Within what the verb takes.
    const double at = axis_of(side).is_high
                          ? std::clamp(*to, std::min(g.room.min[axis] + least, g.domain.max[axis]), g.domain.max[axis])
                          : std::clamp(*to, g.domain.min[axis], std::max(g.room.max[axis] - least, g.domain.min[axis]));
    g.post("wall", {at}, std::string(side_names.at(side)));
  }
  void release(Gesture& g) override { g.post("release"); }

  void wall(PlayModel& side, const Action& a) {
    if (is_off(a)) {
      for (std::size_t n = 0; n < 6; ++n)
        if (has_slab(*side.simulation, n)) drag_to(side, n, axis_of(n).own(space_of(*side.simulation)));
      return;
    }
    const auto name = std::find(side_names.begin(), side_names.end(), a.word(0));
    if (name == side_names.end())
      throw InputError(fmt::format("wall: no wall '{}'; there are {}", a.word(0), fmt::join(side_names, ", ")));
    drag_to(side, static_cast<std::size_t>(name - side_names.begin()), a.number(1));
  }
  void tick(PlayModel& side, double) override {
    for (std::size_t n = 0; n < 6; ++n)
      if (targets_[n]) move(side, n);
  }
  void reset(PlayModel& side) override {
    targets_ = {};
    Simulation& simulation = *side.simulation;
    for (std::size_t n = 0; n < 6; ++n)
      if (has_slab(simulation, n) && !simulation.collider(collider_name(n)).twist.at_rest())
        simulation.set_motion(collider_name(n), {});
  }
  void marks(const PlayModel& side, Frame& frame) const override {
    frame.room = room_of(*side.simulation);
    for (std::size_t n = 0; n < 6; ++n)
      if (has_slab(*side.simulation, n)) frame.bodies.push_back(plane_of(*side.simulation, n));
  }
  bool draws(std::string_view collider) const override {
    for (std::size_t n = 0; n < 6; ++n)
      if (collider == collider_name(n)) return true;
    return false;
  }

  Action random(RandomActions& dice, const Frame& frame) const override {
    if (dice.index(4) == 0) return {"wall", {"off"}};
    const std::size_t side = dice.index(6);
    const int axis = axis_of(side).axis;
    const Box3d& box = frame.domain;
    const double in = dice.number(0, 0.6) * box.size()[axis];
    return {
        "wall",
        {std::string(side_names.at(side)), text_of(axis_of(side).is_high ? box.max[axis] - in : box.min[axis] + in)}};
  }

 private:
  /// 1/s: how fast a wall comes to the cursor. Lengths of the box in a second, and parts of a cell
  /// in a step, that it moves at most.
  static constexpr double rate = 15, most_lengths = 0.8, most_cells = 0.05, most_cells_projected = 0.5;
  /// Pa: of matter, on average over the wall, that it is pushed by at most.
  static constexpr double most_pressure = 1e4;
  /// Cells that a wall may be off the place that it was dragged to, and that it goes behind its own
  /// place to be taken out.
  static constexpr double near_enough = 0.01, behind = 0.05;
  /// m: what the ends of the range of a wall are not exact to.
  static constexpr double rounding = 1e-9;
  /// Cells that a wall moves between two looks at where it is.
  static constexpr double slack = 0.1;
  /// Over the volume of a liquid that keeps it: the room that closed walls leave it.
  static constexpr double least_space = 1.1;
  /// Cells that a rigid body may be in a wall that pushes it on.
  static constexpr double most_inside = 0.1;

  /// A wall begins to move to that place [m]. Throws InputError.
  void drag_to(PlayModel& model, std::size_t side, double to) {
    Simulation& simulation = *model.simulation;
    const WallAxis w = axis_of(side);
    const model::Space& space = space_of(simulation);
    const std::string name(side_names.at(side));
    if (space.periodic[static_cast<std::size_t>(w.axis)])
      throw InputError(fmt::format("wall: {} has no wall, for the scene is periodic there", name));
    const double own = w.own(space), other = wall_at(simulation, side ^ 1u);
    const double least = other + w.sign() * least_room * (space.end()[w.axis] - space.min[w.axis]);
    const double low = std::min(own, least), high = std::max(own, least);
    if (!(to >= low - rounding && to <= high + rounding))
      throw InputError(fmt::format("wall: {} is {} m: must be between {:.4g} and {:.4g}", name, to, low, high));
    if (!has_slab(simulation, side) && to == own) return;
    const std::uint64_t edits = model.history.edits();
    model.before_edit("wall " + name);
    if (!has_slab(simulation, side)) try {
        simulation.add(slab_behind(space, side), model::Look::dielectric(1.5, {1, 0.5, 0.2}));
        simulation.set_surface_tolerance(collider_name(side), slack);
      } catch (const InputError&) {
        if (model.history.edits() != edits) model.history.forget_edit();
        throw;
      }
    targets_[side] = to;
  }

  /// It is as thick as it may have to go, so that it reaches behind the wall wherever it is.
  static model::Collider slab_behind(const model::Space& space, std::size_t side) {
    const WallAxis w = axis_of(side);
    const Vec3d size = space.end() - space.min;
    const double wide = std::max({size.x, size.y, size.z});
    Box3d slab{space.min - Vec3d{wide, wide, wide}, space.end() + Vec3d{wide, wide, wide}};
    (w.is_high ? slab.min : slab.max)[w.axis] = w.own(space);
    model::Collider collider{collider_name(side), Shape::box(slab.min, slab.max)};
    const Wall& wall = space.walls[side];
    if (wall.type != WallType::open) collider.type = wall.type, collider.friction = wall.friction;
    return collider;
  }

  /// Whether walls may not come further inward, for liquid fills what is between them.
  static bool is_full(const PlayModel& model) {
    const Simulation& simulation = *model.simulation;
    const model::Scene& scene = simulation.scene().model();
    if (!is_projection(scene)) return false;  // there matter presses back
    for (std::size_t side = 0; side < 6; ++side)
      if (scene.space.walls[side].type == WallType::open && !has_slab(simulation, side)) return false;
    // A layer of cells stays empty above: where no surface is left no pressure can be found.
    const Vec3d& gravity = model.gravity;
    const int up = std::abs(gravity.x) > std::abs(gravity.y) ? 0 : std::abs(gravity.z) > std::abs(gravity.y) ? 2 : 1;
    Vec3d size = room_of(simulation).size();
    size[up] -= scene.space.dx();
    const double spacing = scene.space.spacing;
    return size.x * size.y * size.z <
           least_space * static_cast<double>(simulation.particle_count()) * spacing * spacing * spacing;
  }

  void move(PlayModel& model, std::size_t side) {
    Simulation& simulation = *model.simulation;
    const WallAxis w = axis_of(side);
    const model::Space& space = space_of(simulation);
    const std::string name = collider_name(side);
    const double dx = space.dx(), own = w.own(space), at = wall_at(simulation, side);
    const bool goes_back = *targets_[side] == own;
    const double to = goes_back ? own + w.sign() * 2 * behind * dx : *targets_[side];
    if (goes_back && (at - own) * w.sign() >= behind * dx) {
      simulation.remove_collider(name);
      targets_[side].reset();
      return;
    }
    const ColliderState state = simulation.collider(name);
    double speed = 0;  // inward
    if (std::abs(to - at) <= near_enough * dx) {
      targets_[side].reset();
    } else {
      const Vec3d size = space.end() - space.min;
      const double cells = is_projection(simulation.scene().model()) ? most_cells_projected : most_cells;
      const double most = std::min(most_lengths * size[w.axis], cells * dx / simulation.dt());
      speed = std::clamp((at - to) * w.sign() * rate, -most, most);
      if (speed > 0) {
        const double area = size.x * size.y * size.z / size[w.axis];
        const double pressure = std::max(0.0, state.force[w.axis] * w.sign()) / area;
        speed *= std::max(0.0, 1 - pressure / most_pressure);
        const std::vector<ColliderShape> shapes = simulation.collider_shapes();
        const bool is_held = std::any_of(shapes.begin(), shapes.end(), [&](const ColliderShape& body) {
          return body.is_rigid() && reaches(body, w.axis, at + w.sign() * most_inside * dx);
        });
        if (is_held || is_full(model)) speed = 0;
      }
    }
    Vec3d velocity{};
    velocity[w.axis] = -w.sign() * speed;
    if (!(state.twist.velocity == velocity)) simulation.set_motion(name, {velocity, {}, {}});
  }

  std::optional<Side> under_;                     ///< the cursor, or dragged; in the window
  std::array<std::optional<double>, 6> targets_;  ///< m: where walls go that are under way; in a playground
};

}  // namespace

std::unique_ptr<Tool> make_walls() { return std::make_unique<Walls>(); }

}  // namespace dreampm::play
