// A cube in water: one of half the water's density floats at its draft, a heavier one sinks and
// lies; the water keeps its volume around both.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "validate/measure/fit.h"
#include "validate/measure/particles.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace floating_case {
namespace {

constexpr double side = 0.3, basin = 0.8, water_density = 1000;

/// s: by then the heavy cube lies. While it falls the surface is no plane, and the water's mean
/// height gives no volume.
constexpr double settled = 1;

struct Water {
  double level, volume;  ///< m over the floor; m^3
};

/// Water whose mean height [m] is `center` around a cube in any attitude, whose particles have
/// these heights [m]; each stands for `across` [m] of height.
Water water_around(double center, const std::vector<double>& heights, double across) {
  struct Below {
    double volume, moment;
  };
  const double part = side * side * side / static_cast<double>(heights.size()) / across;
  const auto below = [&](double level) {
    Below b{basin * basin * level, basin * basin * level * level / 2};
    for (const double height : heights) {
      const double low = height - across / 2, wet = std::clamp(level - low, 0.0, across);
      b.volume -= part * wet, b.moment -= part * wet * (low + wet / 2);
    }
    return b;
  };
  double low = 0.01, high = basin;
  for (int i = 0; i < 40; ++i) {
    const double level = (low + high) / 2;
    const Below b = below(level);
    (b.moment < center * b.volume ? low : high) = level;
  }
  return {low, below(low).volume};
}

struct Rest {
  double dx = 0, water = 0;                         ///< m; m^3, of the water at rest
  std::vector<double> time, draft, bottom, volume;  ///< of frames: s; m below the level; m over the floor; change
};

enum class Basin { filled, dry };

/// The cube of that density [kg/m^3] let go for `time` [s]. `packed`: how much water there is on
/// its points, over what there should be, for controls.
Rest rest(Trial& t, double density, double time, Basin kind = Basin::filled, std::vector<std::string> overrides = {},
          double packed = 1) {
  overrides.push_back(fmt::format("materials.cork.density={}", density));
  model::Scene scene = built_in_scene("floating", overrides);
  if (kind == Basin::dry) scene.bodies.erase(scene.bodies.begin());
  ValidationRun<float> run(t, scene);
  run.begin();
  Rest r;
  r.dx = run.world.dx;
  r.water = static_cast<double>(run.world.sets[0].size()) * run.world.sets[0].rest_volume;
  run.world.sets[0].mass *= packed, run.world.sets[0].rest_volume *= packed;
  run.until(time, [&](const StepSums& report) {
    if (!report.frame_done) return;
    std::vector<double> heights[2];
    each_particle(run.world, [&](std::size_t s, std::size_t, const Vec3d& at) { heights[s].push_back(at.y); });
    const double bottom = mean_of(heights[1]).mean - side / 2;
    r.time.push_back(run.world.time), r.bottom.push_back(bottom);
    if (kind == Basin::dry) return;
    const Water water = water_around(mean_of(heights[0]).mean, heights[1], r.dx / 2);
    r.draft.push_back(std::min(side, water.level - bottom));
    r.volume.push_back(water.volume / r.water - 1);
  });
  return r;
}

/// The cube touches the floor at the start, and the water is around it.
std::vector<std::string> on_the_floor() {
  const std::string cube = "box: {size: [0.3, 0.3, 0.3]}, center: [0.4, 0.15, 0.4]";
  return {"bodies.cube.shape={" + cube + "}",
          "bodies.water.shape={difference: [{box: {min: [0, 0, 0], max: [0.8, 0.4, 0.8]}}, {" + cube + "}]}"};
}

/// Mean of the last quarter.
double late(const std::vector<double>& values) {
  const auto from = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 3 / 4);
  return std::accumulate(from, values.end(), 0.0) / static_cast<double>(values.end() - from);
}

/// The farthest from `want` that any frame's value is.
double farthest(const std::vector<double>& values, double want) {
  double worst = 0;
  for (const double v : values) worst = std::max(worst, std::abs(v - want));
  return worst;
}

/// Returns the values of the frames after it has settled.
std::vector<double> at_rest(const Rest& r, const std::vector<double>& values) {
  const auto first = std::lower_bound(r.time.begin(), r.time.end(), settled - 1e-6);
  return {values.begin() + (first - r.time.begin()), values.end()};
}

double change_of_volume(const Rest& r) { return farthest(at_rest(r, r.volume), 0); }

/// m over the floor, at most.
double lies_at(const Rest& r) {
  const auto bottom = at_rest(r, r.bottom);
  return *std::max_element(bottom.begin(), bottom.end());
}

Curve course_of(const Rest& r, std::string name) {
  Curve c{std::move(name), r.time, r.bottom};
  for (double& y : c.y) y /= r.dx;
  return c;
}

void run(Trial& t) {
  t.note_choice(
      "The cubes of 500 and 1400 kg/m^3 are let go with half their height under water, the draft of the first. It is "
      "judged by its worst frame (ten a second) from there on, no settling and no average. With a face up a cube of "
      "half the water's density is not stable (its metacenter is 2.5 cm under its center): from 40 s on it rolls, out "
      "of rounding errors, through an edge to a corner up. By symmetry its center is at the water's level in every "
      "attitude, and a draft is what a cube with a face up would have.");
  t.note_choice(
      "The volume of the water follows from its mean height, with a flat surface around the cube as it lies. It is "
      "judged by its worst frame from 1 s on, when the heavy cube lies: that takes it 0.7 s, and while it falls the "
      "surface is not flat.");
  t.note_choice(
      "The gate of the heavy cube is that it lies a quarter of a cell over the floor at most. Two runs beside it show "
      "where it lies without water: dropped in a dry basin, and put down on the floor of a filled one. Its lower face "
      "is that of a cube around the mean of its particles.");
  const double draft = side * 500 / water_density;
  const double time = t.full() ? 60 : 3;
  const Rest cork = rest(t, 500, time), stone = rest(t, 1400, time);
  const std::string name = fmt::format("draft of a cube of 500 kg/m^3, farthest off within {} s", time);
  t.at_most(name, farthest(cork.draft, draft) / cork.dx, 0.5, "cells");
  t.report("its mean over the last quarter, off by", (late(cork.draft) - draft) / cork.dx, "cells");
  const std::string span = fmt::format("from {} to {} s", settled, time);
  const std::string around = "volume of the water around it, farthest off " + span;
  t.at_most(around, change_of_volume(cork), 0.01, "%");
  t.report("its change at the end", cork.volume.back(), "%");
  const std::string lies = "a cube of 1400 kg/m^3, lower face above the floor at most " + span;
  t.at_most(lies, lies_at(stone) / stone.dx, 0.25, "cells");
  // Damped: an elastic cube bounces on a dry floor for long.
  t.report("the same, dropped in a dry basin", late(rest(t, 1400, 2, Basin::dry, {"time.damping=5"}).bottom) / stone.dx,
           "cells");
  t.report("the same, put down on the floor of a filled basin",
           late(rest(t, 1400, 2, Basin::filled, on_the_floor()).bottom) / stone.dx, "cells");
  const std::string around_stone = around + ", 1400";
  t.at_most(around_stone, change_of_volume(stone), 0.01, "%")
      .known(
          "As the cube lands, the water that is left between it and the floor is a layer thinner than a cell, which "
          "the "
          "grid does not press out: 0.7 % of all water lies within the cube's lowest rows then. It finds its way out "
          "through the cube.",
          0.0125);
  t.report("its change at the end, 1400", stone.volume.back(), "%");
  t.report("the same, farthest from the start on, 1400", farthest(stone.volume, 0), "%");
  const Rest wood = rest(t, 800, t.full() ? 20 : 2);
  t.control("a cube of 800 kg/m^3 taken for one of 500", name, farthest(wood.draft, draft) / cork.dx);
  t.control("a cube of 800 kg/m^3 taken for one of 1400", lies, lies_at(wood) / wood.dx);
  // It takes the room that it needs.
  const auto packed = [&](double density) { return change_of_volume(rest(t, density, 1.5, Basin::filled, {}, 1.03)); };
  t.control("3 % too much water on its points, 1.5 s", around, packed(500));
  t.control("3 % too much water on its points, 1.5 s", around_stone, packed(1400));
  const auto change = [](const Rest& r, const char* who) {
    Curve c{who, r.time, r.volume};
    for (double& y : c.y) y *= 100;
    return c;
  };
  t.plot({"floating-volume",
          "Volume of the water around a cube",
          "time  [s]",
          "change  [%]",
          {change(cork, "500 kg/m^3"), change(stone, "1400 kg/m^3"), level("gate, from 1 s on", 0, time, 1),
           level("", 0, time, -1)}});
  Curve archimedes{"500 kg/m^3, at its draft", {}, {}, true}, floor{"1400 kg/m^3, on the floor", {}, {}, true};
  for (int k = 1; k <= 6; ++k) {
    archimedes.x.push_back(time * k / 6), floor.x.push_back(time * (0.4 + 0.1 * k)), floor.y.push_back(0);
    archimedes.y.push_back(((cork.water + side * side * draft) / (basin * basin) - draft) / cork.dx);
  }
  t.plot({"floating",
          "Lower face of a cube of 6 cells in water",
          "time  [s]",
          "above the floor  [cells]",
          {course_of(cork, "500 kg/m^3"), course_of(stone, "1400 kg/m^3"), archimedes, floor,
           level("gate of the 1400", 0, time, 1)}});
}

/// The cube lies at its draft at the start, and the water is around it.
std::vector<std::string> at_its_draft(double density) {
  const std::string cube = fmt::format("box: {{size: [0.3, 0.3, 0.3]}}, center: [0.4, {}, 0.4]",
                                       0.4 + side * (0.5 - density / water_density));
  return {"bodies.cube.shape={" + cube + "}",
          "bodies.water.shape={difference: [{box: {min: [0, 0, 0], max: [0.8, 0.4, 0.8]}}, {" + cube + "}]}"};
}

void run_projection(Trial& t) {
  t.note_choice(
      "The cube of 900 kg/m^3 is let go at its draft, that of 1200 with half its height under water. The first is "
      "judged by its worst frame (ten a second), the second by its worst from 1.5 s on, when it lies. The volume of "
      "the "
      "water follows from its mean height, with a flat surface around the cube as it lies.");
  const double time = t.full() ? 20 : 4, light = 900, heavy = 1200, lies = 1.5;
  const auto floating_at = [&](double density, double end, double packed = 1) {
    return rest(t, density, end, Basin::filled, by_projection("water", at_its_draft(density)), packed);
  };
  const Rest jelly = floating_at(light, time), wood = floating_at(800, 2),
             stone = rest(t, heavy, time, Basin::filled, by_projection("water"));
  const double draft = side * light / water_density;
  const std::string floats = fmt::format("draft of a cube of {} kg/m^3, farthest off within {} s", light, time),
                    volume = fmt::format("volume of the water around it, farthest off from {} to {} s", settled, time),
                    lower = fmt::format("a cube of {} kg/m^3, lower face above the floor at most from {} to {} s",
                                        heavy, lies, time);
  t.at_most(floats, farthest(jelly.draft, draft) / jelly.dx, 0.5, "cells");
  t.report("its mean over the last quarter, off by", (late(jelly.draft) - draft) / jelly.dx, "cells");
  t.at_most(volume, change_of_volume(jelly), 0.01, "%");
  const auto down = std::lower_bound(stone.time.begin(), stone.time.end(), lies - 1e-6) - stone.time.begin();
  t.at_most(lower, *std::max_element(stone.bottom.begin() + down, stone.bottom.end()) / stone.dx, 0.25, "cells");
  t.report("volume of the water around it, farthest off in that time",
           farthest({stone.volume.begin() + down, stone.volume.end()}, 0), "%");
  t.control("a cube of 800 kg/m^3 taken for one of 900, 2 s", floats, farthest(wood.draft, draft) / wood.dx);
  t.control("a cube of 800 kg/m^3 taken for one of 1200, 2 s", lower, lies_at(wood) / wood.dx);
  t.control("3 % too much water on its points, 1.5 s", volume, change_of_volume(floating_at(light, 1.5, 1.03)));
  const auto rest_of = [&](double density) {
    return level(fmt::format("{} kg/m^3, at its draft", density), 0, time,
                 (0.4 - side * density / water_density) / jelly.dx);
  };
  t.plot({"floating-projection",
          "Lower face of an elastic cube of 6 cells in water, by the projection",
          "time  [s]",
          "above the floor  [cells]",
          {course_of(jelly, "900 kg/m^3"), course_of(stone, "1200 kg/m^3"), course_of(wood, "800 kg/m^3"),
           rest_of(light), rest_of(800)}});
}

}  // namespace
}  // namespace floating_case

extern const Case floating;
const Case floating{"floating",
                    "an elastic cube floats at its draft or sinks, and the water keeps its volume",
                    "Archimedes, exact",
                    true,
                    floating_case::run,
                    22,
                    260};

extern const Case floating_projection;
const Case floating_projection{
    "floating-projection",
    "an elastic cube of 900 kg/m^3 floats at its draft in projected water, one of 1200 sinks",
    "Archimedes, exact",
    true,
    floating_case::run_projection,
    3,
    8};

}  // namespace dreampm::validate::cases
