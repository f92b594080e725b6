// Walls of the box that hands drag. Each is a slab behind the wall, wider than the box, which is
// put in where the wall is first dragged and taken out where it is back at its place.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/error.h"
#include "dreampm/play/model/playground_impl.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/tools/wall_face.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {
namespace {

/// 1/s: how fast a wall comes to the hand. Lengths of the box in a second, and parts of a cell in a
/// step, that it moves at most.
constexpr double wall_rate = 15, most_lengths = 0.8, most_cells = 0.05, most_cells_projected = 0.5;
/// Pa: of matter, on average over the wall, that the hand is as strong as.
constexpr double most_pressure = 1e4;
/// Cells that a wall may be off the place that it was drawn to, and that it goes behind its own
/// place to be taken out.
constexpr double near_enough = 0.01, behind = 0.05;
/// m: what the ends of the range of a wall are not exact to.
constexpr double rounding = 1e-9;
/// Cells that a wall moves between two looks at where it is.
constexpr double slack = 0.1;
/// Over the volume of a liquid that keeps it: the room that closed walls leave it.
constexpr double least_space = 1.1;
/// Cells that a rigid body may be in a wall that pushes it on.
constexpr double most_inside = 0.1;
constexpr const char* look = "{type: dielectric, ior: 1.5, absorption: [1, 0.5, 0.2]}";

struct WallAxis {
  int axis;
  bool is_high;
  double sign() const { return is_high ? 1 : -1; }  ///< outward
};
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

}  // namespace

std::string wall_name(std::size_t side) { return fmt::format("wall-{}", scene::wall_names.at(side)); }

double Playground::Impl::wall_at(std::size_t side) const {
  const auto [axis, is_high] = axis_of(side);
  const scene::Space& space = simulation->scene().description().space;
  if (!has_slab(side)) return is_high ? space.max[axis] : space.min[axis];
  const std::string name = wall_name(side);
  const Box3d box = simulation->collider_shape(name).own_bounds();
  return simulation->collider(name).pose.position[axis] + (is_high ? box.min[axis] : box.max[axis]);
}

bool Playground::Impl::has_slab(std::size_t side) const {
  const auto& colliders = simulation->scene().description().colliders;
  return std::any_of(colliders.begin(), colliders.end(), [&](const auto& c) { return c.name == wall_name(side); });
}

Box3d Playground::Impl::room() const {
  const scene::Space& space = simulation->scene().description().space;
  Box3d box{space.min, space.max};
  for (std::size_t side = 0; side < 6; ++side)
    if (has_slab(side)) {
      const WallAxis w = axis_of(side);
      (w.is_high ? box.max : box.min)[w.axis] = wall_at(side);
    }
  return box;
}

void Playground::Impl::draw_wall(std::size_t side, double to) {
  const WallAxis w = axis_of(side);
  const scene::Space& space = simulation->scene().description().space;
  const std::string name = scene::wall_names.at(side);
  if (space.periodic[static_cast<std::size_t>(w.axis)])
    throw InputError(fmt::format("wall: {} has no wall, for the scene is periodic there", name));
  const double own = w.is_high ? space.max[w.axis] : space.min[w.axis], other = wall_at(side ^ 1u);
  const double least = other + w.sign() * least_room * (space.max[w.axis] - space.min[w.axis]);
  const double low = std::min(own, least), high = std::max(own, least);
  if (!(to >= low - rounding && to <= high + rounding))
    throw InputError(fmt::format("wall: {} is {} m: must be between {:.4g} and {:.4g}", name, to, low, high));
  if (!has_slab(side) && to == own) return;
  const std::uint64_t edits = history.edits();
  before_edit("wall " + name);
  if (!has_slab(side)) {
    // It is as thick as it may have to go, so that it reaches behind the wall wherever it is.
    const Vec3d size = space.max - space.min;
    const double wide = std::max({size.x, size.y, size.z});
    Box3d slab{space.min - Vec3d{wide, wide, wide}, space.max + Vec3d{wide, wide, wide}};
    (w.is_high ? slab.min : slab.max)[w.axis] = own;
    NewCollider collider{wall_name(side), SceneShape::box(slab.min, slab.max)};
    const scene::Wall& wall = space.walls[side];
    if (wall.type == WallType::slip || wall.type == WallType::stick)
      collider.type = wall.type == WallType::slip ? "slip" : "stick";
    if (wall.type != WallType::stick) collider.friction = wall.friction;
    collider.look = look, collider.slack = slack;
    try {
      simulation->add_collider(collider);
    } catch (const InputError&) {
      if (history.edits() != edits) history.forget_edit();
      throw;
    }
  }
  walls[side] = to;
}

bool Playground::Impl::is_full() const {
  const scene::SceneDescription& scene = simulation->scene().description();
  if (!is_projection(scene)) return false;  // there matter presses back
  for (std::size_t side = 0; side < 6; ++side)
    if (scene.space.walls[side].type == WallType::open && !has_slab(side)) return false;
  // A layer of cells stays empty above: where no surface is left no pressure can be found.
  const int up = std::abs(gravity.x) > std::abs(gravity.y) ? 0 : std::abs(gravity.z) > std::abs(gravity.y) ? 2 : 1;
  Vec3d size = room().size();
  size[up] -= scene.space.dx();
  const double spacing = scene.space.spacing;
  return size.x * size.y * size.z <
         least_space * static_cast<double>(simulation->particle_count()) * spacing * spacing * spacing;
}

void Playground::Impl::move_walls() {
  for (std::size_t side = 0; side < 6; ++side) {
    if (!walls[side]) continue;
    const WallAxis w = axis_of(side);
    const scene::Space& space = simulation->scene().description().space;
    const std::string name = wall_name(side);
    const double dx = space.dx(), own = w.is_high ? space.max[w.axis] : space.min[w.axis], at = wall_at(side);
    const bool goes_back = *walls[side] == own;
    const double to = goes_back ? own + w.sign() * 2 * behind * dx : *walls[side];
    if (goes_back && (at - own) * w.sign() >= behind * dx) {
      simulation->remove_collider(name);
      walls[side].reset();
      continue;
    }
    const ColliderState state = simulation->collider(name);
    double speed = 0;  // inward
    if (std::abs(to - at) <= near_enough * dx) {
      walls[side].reset();
    } else {
      const Vec3d size = space.max - space.min;
      const double cells = is_projection(simulation->scene().description()) ? most_cells_projected : most_cells;
      const double most = std::min(most_lengths * size[w.axis], cells * dx / simulation->dt());
      speed = std::clamp((at - to) * w.sign() * wall_rate, -most, most);
      if (speed > 0) {
        const double area = size.x * size.y * size.z / size[w.axis];
        const double pressure = std::max(0.0, state.force[w.axis] * w.sign()) / area;
        speed *= std::max(0.0, 1 - pressure / most_pressure);
        const std::vector<ColliderShape> shapes = simulation->collider_shapes();
        const bool is_held = std::any_of(shapes.begin(), shapes.end(), [&](const ColliderShape& body) {
          return body.is_rigid() && reaches(body, w.axis, at + w.sign() * most_inside * dx);
        });
        if (is_held || is_full()) speed = 0;
      }
    }
    Vec3d velocity{};
    velocity[w.axis] = -w.sign() * speed;
    if (!(state.twist.velocity == velocity)) simulation->set_motion(name, {velocity, {}, {}});
  }
}

void Playground::Impl::stop_walls() {
  walls = {};
  for (std::size_t side = 0; side < 6; ++side)
    if (has_slab(side) && !simulation->collider(wall_name(side)).twist.at_rest())
      simulation->set_motion(wall_name(side), {});
}

std::optional<BodyFrame> Playground::Impl::wall_plane(std::size_t side) const {
  if (!has_slab(side)) return std::nullopt;
  const WallAxis w = axis_of(side);
  const int u = (w.axis + 1) % 3, v = (w.axis + 2) % 3;
  Box3d face = room();
  (w.is_high ? face.min : face.max)[w.axis] = wall_at(side);
  TriMesh quad;
  for (int n = 0; n < 4; ++n) {
    Vec3d corner = face.min;
    if (n == 1 || n == 2) corner[u] = face.max[u];
    if (n >= 2) corner[v] = face.max[v];
    quad.vertices.push_back(static_cast<Vec3f>(corner));
  }
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  return BodyFrame{wall_name(side),       false, std::make_shared<const TriMesh>(std::move(quad)), {},
                   {0.45f, 0.62f, 0.85f}, 0.3f};
}

}  // namespace dreampm::play
