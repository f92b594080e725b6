// A cube in water: one of half the water's density floats at its draft, a heavier one sinks and lies; the water keeps
// its volume around both.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "dreampm/validate/measure/particles.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

constexpr double side = 0.3, basin = 0.8, water_density = 1000;

/// The volume [m^3] of water whose mean height [m] is `centre` around a cube whose lower face is at `bottom` [m].
double volume_around(double centre, double bottom) {
  const auto volume = [&](double level) {
    const double wet = std::clamp(level - bottom, 0.0, side);
    return basin * basin * level - side * side * wet;
  };
  const auto mean_height = [&](double level) {
    const double wet = std::clamp(level - bottom, 0.0, side);
    return (basin * basin * level * level / 2 - side * side * wet * (bottom + wet / 2)) / volume(level);
  };
  double low = 0.01, high = basin;
  for (int i = 0; i < 60; ++i) (mean_height((low + high) / 2) < centre ? low : high) = (low + high) / 2;
  return volume(low);
}

struct Rest {
  double dx = 0, water = 0;                         ///< m; m^3, of the water at rest
  std::vector<double> time, draft, bottom, volume;  ///< of frames: s; m below the level; m over the floor; change
};

enum class Basin { filled, dry };

/// The cube of that density [kg/m^3] let go for `time` [s]. `packed`: how much water there is on its points, over what
/// there should be, for controls.
Rest rest(Trial& t, double density, double time, Basin kind = Basin::filled, std::vector<std::string> overrides = {},
          double packed = 1) {
  overrides.push_back(fmt::format("materials.cork.density={}", density));
  SceneDescription scene = built_in_scene("floating", overrides);
  if (kind == Basin::dry) scene.bodies.erase(scene.bodies.begin());
  Run<float> run(t, scene);
  run.begin();
  Rest r;
  r.dx = run.world.dx;
  r.water = static_cast<double>(run.world.sets[0].size()) * run.world.sets[0].rest_volume;
  run.world.sets[0].mass *= packed, run.world.sets[0].rest_volume *= packed;
  run.until(time, [&](const StepReport& report) {
    if (!report.frame_done) return;
    double height[2] = {0, 0};
    each_particle(run.world, [&](std::size_t s, std::size_t, const Vec3d& at) { height[s] += at.y; });
    const double bottom = height[1] / static_cast<double>(run.world.sets[1].size()) - side / 2;
    r.time.push_back(run.world.time), r.bottom.push_back(bottom);
    if (kind == Basin::dry) return;
    const double volume = volume_around(height[0] / static_cast<double>(run.world.sets[0].size()), bottom);
    r.draft.push_back(std::min(side, (volume - basin * basin * bottom) / (basin * basin - side * side)));
    r.volume.push_back(volume / r.water - 1);
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

Curve course_of(const Rest& r, std::string name) {
  Curve c{std::move(name), r.time, r.bottom};
  for (double& y : c.y) y /= r.dx;
  return c;
}

void run(Trial& t) {
  t.chose(
      "The cubes of 500 and 1400 kg/m^3 are let go with half their height under water, the draft of the first. It is "
      "judged by its worst frame (ten a second) from there on, no settling and no average: it bobs by a hundredth of a "
      "cell.");
  t.chose(
      "The gate of the heavy cube is that it lies a cell over the floor at most, as near as matter comes that arrives "
      "through a grid: nodes of the floor press what they reach, up to 1.5 cells away. Two runs beside it tell how "
      "much of that is water: dropped in a dry basin it lies nearly as high, and put down on the floor of a filled one "
      "it stays there. With half the cells it lay 0.976 of those over the floor after 4 s: the gap converges to none. "
      "Its lower face is that of a cube around the mean of its particles; the lowest of them lies within 0.01 cells of "
      "it: the cube lies flat, on water.");
  const double draft = side * 500 / water_density;
  const double time = t.full() ? 60 : 3, sinking = t.full() ? 20 : 4;
  const Rest cork = rest(t, 500, time), stone = rest(t, 1400, sinking);
  const std::string name = fmt::format("draft of a cube of 500 kg/m^3, farthest off within {} s", time);
  t.at_most(name, farthest(cork.draft, draft) / cork.dx, 0.5, "cells");
  t.tell("its mean over the last quarter, off by", (late(cork.draft) - draft) / cork.dx, "cells");
  const char* const around = "volume of the water around it, change";
  t.at_most(around, std::abs(late(cork.volume)), 0.01, "%");
  t.tell("the same, farthest", farthest(cork.volume, 0), "%");
  const std::string lies = fmt::format("a cube of 1400 kg/m^3 lies after {} s, lower face above the floor", sinking);
  t.at_most(lies, late(stone.bottom) / stone.dx, 1, "cells");
  // Damped: an elastic cube bounces on a dry floor for long.
  t.tell("the same, dropped in a dry basin", late(rest(t, 1400, 2, Basin::dry, {"time.damping=5"}).bottom) / stone.dx,
         "cells");
  t.tell("the same, put down on the floor of a filled basin",
         late(rest(t, 1400, 2, Basin::filled, on_the_floor()).bottom) / stone.dx, "cells");
  const std::string around_stone = std::string(around) + ", 1400";
  t.at_most(around_stone, std::abs(late(stone.volume)), 0.01, "%");
  const Rest wood = rest(t, 800, t.full() ? 20 : 2);
  t.control("a cube of 800 kg/m^3 taken for one of 500", name, farthest(wood.draft, draft) / cork.dx);
  t.control("a cube of 800 kg/m^3 taken for one of 1400", lies, late(wood.bottom) / wood.dx);
  // It takes the room that it needs.
  const auto packed = [&](double density) { return late(rest(t, density, 1.5, Basin::filled, {}, 1.03).volume); };
  t.control("3 % too much water on its points, 1.5 s", around, packed(500));
  t.control("3 % too much water on its points, 1.5 s", around_stone, packed(1400));
  Curve archimedes{"500 kg/m^3, at its draft", {}, {}, true}, floor{"1400 kg/m^3, on the floor", {}, {}, true};
  for (int k = 1; k <= 6; ++k) {
    archimedes.x.push_back(time * k / 6), floor.x.push_back(sinking * (0.4 + 0.1 * k)), floor.y.push_back(0);
    archimedes.y.push_back(((cork.water + side * side * draft) / (basin * basin) - draft) / cork.dx);
  }
  t.plot({"floating",
          "Lower face of a cube of 6 cells in water",
          "time  [s]",
          "above the floor  [cells]",
          {course_of(cork, "500 kg/m^3"), course_of(stone, "1400 kg/m^3"), archimedes, floor,
           level("gate of the 1400", 0, std::max(time, sinking), 1)}});
}

}  // namespace

extern const Case floating;
const Case floating{"floating",
                    "an elastic cube floats at its draft or sinks, and the water keeps its volume",
                    "Archimedes, exact",
                    true,
                    run,
                    22,
                    260};

}  // namespace dreampm::validate::cases
