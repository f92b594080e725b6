// Vessels hold what is in them: cup, bowl, tank of boxes, funnel.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/level_set/level_set.h"
#include "validate/measure/particles.h"
#include "validate/revolve.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace vessels_case {
namespace {

constexpr double cell = 0.02;                     // m
constexpr double axis_x = 0.163, axis_z = 0.157;  // m, of what is round: on no node and no face of a cell

struct Vessel {
  std::string name;
  std::vector<std::string> overrides;  ///< of the scene: what it holds, and its colliders
  std::optional<TriMesh> mesh;         ///< or its wall, where no shape of scenes is like it
  std::function<bool(const Vec3d&)> outside;
};

double from_axis(const Vec3d& p) { return std::hypot(p.x - axis_x, p.z - axis_z); }

std::string box_text(const Vec3d& low, const Vec3d& high) {
  return fmt::format("{{box: {{min: [{:.17g}, {:.17g}, {:.17g}], max: [{:.17g}, {:.17g}, {:.17g}]}}}}", low.x, low.y,
                     low.z, high.x, high.y, high.z);
}
std::string cylinder_text(double radius, double bottom, double top) {
  return fmt::format("{{cylinder: {{radius: {:.17g}, height: {:.17g}}}, center: [{}, {:.17g}, {}]}}", radius,
                     top - bottom, axis_x, (top + bottom) / 2, axis_z);
}
std::string difference_text(const std::vector<std::string>& parts) {
  return fmt::format("{{difference: [{}]}}", fmt::join(parts, ", "));
}

// Each with a wall of that thickness and, for controls, holes of that width [m] in the bottom and,
// of cup and tank, in the side beside it; 0: none. Holes lie on cells: one of a cell holds a node.

/// Cylinder minus cylinder.
Vessel cup(double wall, double hole) {
  constexpr double radius = 0.06, bottom = 0.1, top = 0.26;
  std::vector<std::string> parts{cylinder_text(radius + wall, bottom - wall, top),
                                 cylinder_text(radius, bottom, top + cell)};
  if (hole > 0) {
    const double half = hole / 2;
    parts.push_back(box_text({0.17 - half, bottom - 2 * wall, 0.15 - half}, {0.17 + half, bottom + 0.1, 0.15 + half}));
    parts.push_back(box_text({axis_x, bottom, axis_z - half}, {axis_x + 0.15, bottom + hole, axis_z + half}));
  }
  return {"cup",
          {"colliders.wall.shape=" + difference_text(parts),
           "bodies.matter.shape=" + cylinder_text(radius, bottom, bottom + 0.1)},
          {},
          [=](const Vec3d& p) { return from_axis(p) > radius + wall || p.y < bottom - wall; }};
}

/// Half of a hollow ball, as a mesh.
Vessel bowl(double wall, double hole) {
  constexpr double radius = 0.08, rim = 0.22;
  constexpr int arc = 24;
  std::vector<ProfilePoint> profile;
  const auto point = [&](double r, int i) {
    const double least = std::asin(hole / 2 / r);
    const double a = least + (std::numbers::pi / 2 - least) * i / arc;
    return ProfilePoint{i == 0 && least == 0 ? 0 : r * std::sin(a), -r * std::cos(a)};
  };
  for (int i = 0; i <= arc; ++i) profile.push_back(point(radius + wall, i));
  for (int i = arc; i >= 0; --i) profile.push_back(point(radius, i));
  const Vec3d center{axis_x, rim, axis_z};
  const std::string ball = fmt::format("{{sphere: {{radius: {}}}, center: [{}, {}, {}]}}", radius, axis_x, rim, axis_z);
  return {
      "bowl",
      {"bodies.matter.shape={intersection: [" + ball + ", " + cylinder_text(radius, rim - radius, rim - cell) + "]}"},
      revolved(profile, center, 64),
      [=](const Vec3d& p) { return p.y < rim ? length(p - center) > radius + wall : from_axis(p) > radius + wall; }};
}

/// A shelf and three upright boxes, which end on each other, on three sides of the scene's box and
/// at its ceiling.
Vessel tank(double wall, double hole) {
  const Vec3d low{0.09, 0.1, 0}, high{0.23, 0.36, 0.14};  // of what it encloses
  std::string shelf = box_text({0, low.y - wall, 0}, {0.32, low.y, 0.32}),
              front = box_text({low.x, low.y, high.z}, {high.x, high.y, high.z + wall});
  if (hole > 0) {
    const double left = low.x + 0.06, back = 0.03;  // halves of a cell
    shelf =
        difference_text({shelf, box_text({left, low.y - 2 * wall, back}, {left + hole, low.y + wall, back + hole})});
    front = difference_text({front, box_text({left, low.y, 0.1}, {left + hole, low.y + hole, 0.2})});
  }
  return {
      "tank",
      {"colliders.wall.shape=" + shelf,
       "colliders.left={shape: " + box_text({low.x - wall, low.y, 0}, {low.x, high.y, 0.32}) + "}",
       "colliders.right={shape: " + box_text({high.x, low.y, 0}, {high.x + wall, high.y, 0.32}) + "}",
       "colliders.front={shape: " + front + "}", "bodies.matter.shape=" + box_text(low, {high.x, low.y + 0.1, high.z})},
      {},
      [=](const Vec3d& p) {
        return p.x < low.x - wall || p.x > high.x + wall || p.z > high.z + wall || p.y < low.y - wall;
      }};
}

/// A cone with a rim and a spout, as a mesh, whose spout stands on the floor of the scene's box:
/// what is in the cone at the start falls through the spout and fills it. With a hole it ends above
/// the floor.
Vessel funnel(double wall, double hole) {
  constexpr double spout = 0.03, mouth = 0.11, neck = 0.1, rim = 0.2, top = 0.26;
  constexpr double slope = (mouth - spout) / (rim - neck);
  const double across = wall * std::sqrt(1 + slope * slope);  // m of radius, through the cone's wall
  const double drop = (across - wall) / slope;                // m by which the outer bends lie lower than the inner
  const std::vector<ProfilePoint> profile{{spout, hole},
                                          {spout + wall, hole},
                                          {spout + wall, neck - drop},
                                          {mouth + wall, rim - drop},
                                          {mouth + wall, top},
                                          {mouth, top},
                                          {mouth, rim},
                                          {spout, neck}};
  return {"funnel",
          {"bodies.matter.shape={union: [" + cylinder_text(0.045, 0.13, 0.16) + ", " + cylinder_text(0.07, 0.16, 0.2) +
           "]}"},
          revolved(profile, {axis_x, 0, axis_z}, 64),
          [=](const Vec3d& p) {
            return from_axis(p) > std::clamp(spout + slope * (p.y - neck) + across, spout + wall, mouth + wall);
          }};
}

struct Left {
  double lost = 0, inside = 0;       ///< cm^3; cells that the deepest particle lies inside of the wall
  std::vector<double> time, course;  ///< s; cm^3 lost
};

/// Leaves the matter in the vessel alone for `time` [s]. Lost is matter beyond the wall, or more
/// than half a cell within it.
Left leave(Trial& t, const Vessel& v, double time, std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), v.overrides.begin(), v.overrides.end());
  model::Scene scene = built_in_scene("vessels", overrides);
  if (v.mesh) scene.colliders.clear();
  ValidationRun<float> run(t, scene);
  if (v.mesh) {
    // The mesh as scenes sample colliders that are meshes.
    const Model wall = model_of(*v.mesh);
    const double spacing = scene.space.spacing, voxel = voxel_of_wall(thickness_of(wall), spacing);
    run.world.colliders.push_back({"wall", mesh_region(wall, 1, voxel, v.name, 3 * spacing), WallType::separate});
  }
  run.begin();
  Left left;
  run.watch_until(time, [&] {
    double lost = 0;
    left.inside = 0;
    each_particle(run.world, [&](std::size_t s, std::size_t, const Vec3d& at) {
      double inside = 0;
      for (const Collider& c : run.world.colliders) inside = std::max(inside, -c.distance(at) / run.world.dx);
      left.inside = std::max(left.inside, inside);
      if (v.outside(at) || inside > 0.5) lost += 1e6 * run.world.sets[s].rest_volume;
    });
    left.time.push_back(run.world.time), left.course.push_back(lost);
    left.lost = lost;
  });
  return left;
}

void run(Trial& t) {
  t.note_choice(
      "Everyone draws boxes that end at walls and on each other: there is no edge where they meet, and nothing may "
      "pass. "
      "The tank is a shelf and three upright boxes between the sides of the scene's box. The cup is a cylinder minus a "
      "cylinder; bowl and funnel are meshes that are turned on a lathe, of 64 steps.");
  t.note_choice(
      "Lost is what lies beyond the outer face of a wall, and what has gone into it by more than half a cell. The gate "
      "is 0: a vessel that loses a drop a minute is empty in an hour.");
  t.note_choice(
      "What is round stands where no axis and no face lies on a node or the face of a cell. The holes of a control are "
      "a cell wide; for sand, which bridges that, three.");
  struct Matter {
    std::string name;
    std::vector<std::string> overrides;
    double hole;  // m
    std::string hole_text;
  };
  const Matter matters[] = {
      {"water", {}, cell, "holes of one cell, 1 s"},
      {"sand",
       {"materials.matter={type: sand, density: 1600, youngs_modulus: 1.0e5, poissons_ratio: 0.3}"},
       3 * cell,
       "holes of three cells, 1 s"}};
  const double time = t.full() ? 20 : 2;
  std::vector<std::pair<std::string, double>> walls{{"one cell", cell}};
  if (t.full()) walls = {{"two cells", 2 * cell}, {"one cell", cell}, {"half a cell", cell / 2}};
  Plot plot{"vessels", "What vessels without a hole lose", "time  [s]", "lost  [cm^3]", {}};
  double deepest = 0;
  for (Vessel (*make)(double, double) : {cup, bowl, tank, funnel})
    for (const Matter& m : matters) {
      const double through = leave(t, make(cell, m.hole), 1, m.overrides).lost;
      for (const auto& [thick, wall] : walls) {
        const Vessel v = make(wall, 0);
        const Left left = leave(t, v, time, m.overrides);
        const std::string what = fmt::format("{} of {}, {}", v.name, thick, m.name);
        const std::string metric = fmt::format("{}: lost after {} s", what, time);
        Metric& lost = t.at_most(metric, left.lost, 0, "cm^3");
        if (make == funnel && wall < cell)
          lost.known(
              "The funnel is a mesh whose spout stands on the floor of the box. With a wall of half a cell water "
              "creeps "
              "out under its foot, where the sampled mesh is rounded; sand does not.",
              300);
        t.control(m.hole_text, metric, through);
        deepest = std::max(deepest, left.inside);
        if (left.lost > 0) plot.curves.push_back({what, left.time, left.course});
      }
    }
  t.report("the deepest particle inside a wall, at the end", deepest, "cells");
  plot.curves.push_back(level("the gate", 0, time, 0));
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace vessels_case

extern const Case vessels;
const Case vessels{"vessels",
                   "cup, bowl, tank of boxes and funnel hold water and sand",
                   "a vessel without a hole loses nothing",
                   true,
                   vessels_case::run,
                   13,
                   230};

}  // namespace dreampm::validate::cases
