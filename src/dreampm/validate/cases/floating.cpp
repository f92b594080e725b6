// A cube in water: one of half the water's density floats at its draft, a heavier one sinks and lies; the water keeps
// its volume around both.
#include <cmath>

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
  double draft = 0;   ///< m, of the cube's lower face below the level, mean over the last quarter
  double bottom = 0;  ///< m, height of the lower face above the floor, the same mean
  double volume = 0;  ///< of the water, change
  double water = 0;   ///< m^3, of it at rest
  double dx = 0;
  Curve course;
};

Rest rest(Trial& t, double density, double time) {
  Run<float> run(t, "floating", {fmt::format("materials.cork.density={}", density)});
  run.begin();
  Rest r;
  r.dx = run.world.dx;
  r.course.name = fmt::format("{} kg/m^3", density);
  const double water = static_cast<double>(run.world.sets[0].size()) * run.world.sets[0].rest_volume;
  r.water = water;
  int n = 0;
  run.until(time, [&](const StepReport& report) {
    if (!report.frame_done) return;
    double height[2] = {0, 0};
    each_particle(run.world, [&](std::size_t s, std::size_t, const Vec3d& at) { height[s] += at.y; });
    for (std::size_t s = 0; s < 2; ++s) height[s] /= static_cast<double>(run.world.sets[s].size());
    const double bottom = height[1] - side / 2, volume = volume_around(height[0], bottom);
    const double wet = std::min(side, (volume - basin * basin * bottom) / (basin * basin - side * side));
    r.course.x.push_back(run.world.time);
    r.course.y.push_back(bottom / r.dx);
    if (run.world.time < 0.75 * time) return;
    r.draft += wet, r.bottom += bottom, r.volume += volume / water - 1;
    ++n;
  });
  r.draft /= n, r.bottom /= n, r.volume /= n;
  return r;
}

void run(Trial& t) {
  const double draft = side * 500 / water_density;
  const double time = t.full() ? 60 : 3, sinking = t.full() ? 20 : 4;
  const Rest cork = rest(t, 500, time), stone = rest(t, 1400, sinking);
  const std::string name = fmt::format("draft of a cube of 500 kg/m^3 after {} s, off by", time);
  t.at_most(name, std::abs(cork.draft - draft) / cork.dx, 0.5, "cells");
  t.at_most("volume of the water around it, change", std::abs(cork.volume), 0.01, "%");
  // Liquid of one cell stays under it: a layer that the grid does not resolve cannot be squeezed out.
  t.at_most(fmt::format("a cube of 1400 kg/m^3 lies after {} s, lower face above the floor", sinking),
            stone.bottom / stone.dx, 1, "cells");
  t.at_most("volume of the water around it, change, 1400", std::abs(stone.volume), 0.01, "%");
  t.control("a cube of 800 kg/m^3 taken for one of 500", name,
            std::abs(rest(t, 800, t.full() ? 20 : 2).draft - draft) / cork.dx);
  Curve archimedes{"500 kg/m^3, at its draft", {}, {}, true}, floor{"1400 kg/m^3, on the floor", {}, {}, true};
  for (int k = 1; k <= 6; ++k) {
    archimedes.x.push_back(time * k / 6), floor.x.push_back(sinking * (0.4 + 0.1 * k)), floor.y.push_back(0);
    archimedes.y.push_back(((cork.water + side * side * draft) / (basin * basin) - draft) / cork.dx);
  }
  t.plot({"floating",
          "Lower face of a cube of 6 cells in water",
          "time [s]",
          "above the floor [cells]",
          {cork.course, stone.course, archimedes, floor}});
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
