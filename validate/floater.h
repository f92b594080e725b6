// A rigid box on the water of a basin, which the cases of floating bodies share.
#pragma once
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "validate/measure/hydrostatic.h"
#include "validate/validation_run.h"

namespace dreampm::validate {

/// Moves a rigid body before a run begins, by `way` [m].
template <class R>
void move_body(World<R>& world, std::size_t collider, const Vec3d& way) {
  Collider& c = world.colliders.at(collider);
  c.pose.position += way, c.twist.center += way;
  c.surface_pose = c.pose;
}

/// A box on water that lies where it is let go: the water is cut out around it. Lengths in meters.
struct FloaterSetUp {
  Vec3d basin{0.4, 0.36, 0.4};
  double depth = 0.2;  ///< of the water beside the box when that is let go
  Vec3d box{0.2, 0.12, 0.2};
  double density = 500;  ///< of the box [kg/m^3]; water has 1000
  double below = 0.06;   ///< how far the center of the box lies over the floor, less `depth`, downwards
  double tilt = 0;       ///< of the box about the z axis [degrees]
  double dx = 0.02;      ///< of a cell
  bool projection = false;
  std::string extra{};  ///< more keys of the box, each after a comma
  std::vector<std::string> overrides{};
};

class Floater {
 public:
  static constexpr double g = 9.81, water_density = 1000;

  Floater(Trial& trial, const FloaterSetUp& s)
      : set_up(s),
        run(trial, "rigid-float", s.projection ? by_projection("water", with_sizes(s)) : with_sizes(s)),
        water_volume(static_cast<double>(run.world.sets[0].rest_volume) * static_cast<double>(run.seeds[0].size())) {
    const Hydrostatic rest(run.world.sets[0].values, g, s.depth);
    if (run.compresses()) {
      rest.move(run.seeds[0]);
      move_body(run.world, 0, {0, rest.pressed(s.depth) - s.depth, 0});
    }
    run.begin();
    if (run.compresses()) rest.press(run.world);
  }

  const Collider& body() { return run.world.colliders.at(0); }
  /// m, of its center.
  Vec3d center() { return body().twist.center; }
  /// The speed of its fastest corner, bounded from above [m/s].
  double speed() { return length(body().twist.velocity) + length(body().twist.spin) * 0.5 * length(set_up.box); }
  /// Returns the angle between its axis (0, 1, 2) and the vertical, up or down [degrees].
  double off_vertical(int axis) {
    Vec3d along{};
    along[axis] = 1;
    const double turn = set_up.tilt * std::numbers::pi / 180, c = std::cos(turn), s = std::sin(turn);
    const Vec3d at_start{c * along.x - s * along.y, s * along.x + c * along.y, along.z};
    const double up = std::abs(body().pose.rotation(at_start).y);
    return std::acos(std::min(1.0, up)) * 180 / std::numbers::pi;
  }
  /// The height of the surface over the floor [m], flat around the box with a face down: that at
  /// which the water has the mean height of its particles.
  double level() {
    const double mean = mean_position(run.world).y, area = set_up.basin.x * set_up.basin.z,
                 face = set_up.box.x * set_up.box.z, bottom = center().y - set_up.box.y / 2;
    double low = bottom, high = set_up.basin.y;
    for (int i = 0; i < 50; ++i) {
      const double h = (low + high) / 2, volume = area * h - face * (h - bottom),
                   moment = (area * h * h - face * (h * h - bottom * bottom)) / 2;
      (moment < mean * volume ? low : high) = h;
    }
    return low;
  }
  double draft() { return level() - (center().y - set_up.box.y / 2); }

  FloaterSetUp set_up;
  ValidationRun<float> run;
  double water_volume;  ///< m^3, at rest

 private:
  static std::vector<std::string> with_sizes(const FloaterSetUp& s) {
    const auto triple = [](const Vec3d& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); };
    const Vec3d center{s.basin.x / 2, s.depth - s.below, s.basin.z / 2};
    const std::string shape = fmt::format("box: {{size: {}}}", triple(s.box)),
                      turned = fmt::format("rotate: {{axis: [0, 0, 1], angle: {:.17g}}}", s.tilt);
    std::vector<std::string> all{
        fmt::format("space.max={}", triple(s.basin)), fmt::format("space.spacing={:.17g}", s.dx / 2),
        fmt::format("bodies.water.shape={{difference: [{{box: {{min: [0, 0, 0], max: {}}}}}, {{{}, center: {}, {}}}]}}",
                    triple({s.basin.x, s.depth, s.basin.z}), shape, triple(center), turned),
        fmt::format("rigid.box={{shape: {{{}, {}}}, density: {:.17g}, position: {}{}}}", shape, turned, s.density,
                    triple(center), s.extra)};
    all.insert(all.end(), s.overrides.begin(), s.overrides.end());
    return all;
  }
};

}  // namespace dreampm::validate
