// A light ball let go in a deep still pool rises with half the mass of the water that it displaces.
#include <algorithm>
#include <cmath>

#include "validate/measure/hydrostatic.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace rigid_rise_case {
namespace {

constexpr double g = 9.81, water = 1000, ball = 300, across = 0.16, depth = 0.42, watched = 0.15;

/// m: how high it is after `t` [s], without drag: a sphere takes half of its displacement along
/// (Lamb 1932, art. 92).
double exact_way(double t) { return (water - ball) / (ball + water / 2) * g * t * t / 2; }

struct Rise {
  double part = 0;             ///< of the exact way when it was watched
  double dt = 0;               ///< s, mean
  std::vector<double> t, way;  ///< s, m
};

/// `dt` [s]: the longest step; 0: steps of its own.
Rise rise(Trial& trial, double cells, double dt, std::vector<std::string> overrides = {}) {
  overrides.push_back(fmt::format("space.spacing={:.17g}", across / cells / 2));
  if (dt > 0) overrides.push_back(fmt::format("time.dt_max={:.17g}", dt));
  ValidationRun<float> run(trial, "rigid-rise", overrides);
  const Hydrostatic rest(run.world.sets[0].values, g, depth);
  if (run.compresses()) rest.move(run.seeds[0]);
  run.begin();
  if (run.compresses()) rest.press(run.world);
  const double start = run.world.colliders.at(0).twist.center.y;
  Rise r;
  run.until(watched, [&](const StepSums& step) {
    if (run.compresses() && !step.frame_done) return;
    r.t.push_back(run.world.time);
    r.way.push_back(run.world.colliders.at(0).twist.center.y - start);
  });
  r.part = r.way.back() / exact_way(r.t.back());
  r.dt = run.world.time / static_cast<double>(run.world.step);
  return r;
}

Curve without_drag() {
  Curve exact{"without drag", {}, {}, true};
  for (int i = 0; i <= 15; ++i) exact.x.push_back(watched * i / 15), exact.y.push_back(exact_way(exact.x.back()));
  return exact;
}

std::string part_of(double cells) {
  return fmt::format("{:.0f} cells across: way after {} s over that without drag", cells, watched);
}

void run(Trial& t) {
  t.note_choice(fmt::format(
      "A ball of {} kg/m^3 and {} m across in 0.4 x 0.4 m of still water; 0.1 m below it and 0.18 m above. Its way is "
      "that of its own mass and half of the water's, without drag and without walls, which is an upper bound: 0.85 to "
      "1.1 is right. The water keeps own velocities by asflip, with its memory.",
      ball, across));
  t.note_choice(
      "Shorter steps are asked for by dt_max; the longest, where they are judged too, are those of water in which "
      "sound "
      "is a third as fast.");
  Plot plot{"rigid-rise", "A ball of 300 kg/m^3 rises in still water", "time  [s]", "way  [m]", {}};
  const auto keep = [&](const std::string& name, const Rise& r) { plot.curves.push_back({name, r.t, r.way}); };
  const std::string apic = "materials.water.transfer=apic";

  const double coarse = 8;
  std::vector<Rise> any{rise(t, coarse, 0), rise(t, coarse, 1e-4)};
  if (t.full())
    any.push_back(rise(t, coarse, 5e-5)), any.push_back(rise(t, coarse, 1e-3, {"materials.water.bulk_modulus=1e5"}));
  const auto spread = [](const std::vector<Rise>& all) {
    const auto [low, high] =
        std::minmax_element(all.begin(), all.end(), [](const Rise& a, const Rise& b) { return a.part < b.part; });
    return high->part - low->part;
  };
  const std::string same = fmt::format("{:.0f} cells across: what the way depends on the length of steps", coarse);
  t.at_least(part_of(coarse), any.front().part, 0.65);
  t.at_most(same, spread(any), 0.05);
  for (const Rise& r : any) {
    t.report(fmt::format("{:.0f} cells across, steps of {:.2g} ms: way over that without drag", coarse, r.dt * 1e3),
             r.part);
    keep(fmt::format("{:.0f} cells, steps of {:.2g} ms", coarse, r.dt * 1e3), r);
  }
  const std::vector<Rise> wrong{rise(t, coarse, 0, {apic}), rise(t, coarse, 1e-4, {apic})};
  t.control("apic, which takes a share of every step", part_of(coarse), wrong[0].part);
  t.control("apic, which takes a share of every step", same, spread(wrong));
  keep("8 cells by apic", wrong[0]), keep("and with steps of 0.1 ms", wrong[1]);
  if (t.full())
    for (const auto& [cells, least] : {std::pair{12.0, 0.75}, std::pair{16.0, 0.85}}) {
      const Rise r = rise(t, cells, 0);
      t.at_least(part_of(cells), r.part, least);
      t.control("apic, 8 cells", part_of(cells), wrong[0].part);
      keep(fmt::format("{:.0f} cells", cells), r);
    }
  plot.curves.push_back(without_drag());
  t.plot(std::move(plot));
}

void run_projection(Trial& t) {
  t.note_choice(fmt::format(
      "A ball of {} kg/m^3 and {} m across in 0.4 x 0.4 m of still water; 0.1 m below it and 0.18 m above; 8 cells "
      "across. Its way is that of its own mass and half of the water's, without drag and without walls. Frames bound "
      "the steps.",
      ball, across));
  Plot plot{"rigid-rise-projection",
            "A ball of 300 kg/m^3 rises in still water, by the projection",
            "time  [s]",
            "way  [m]",
            {}};
  const auto rise_of = [&](double fps, double cfl, double density) {
    return rise(
        t, 8, 0,
        by_projection("water", {"materials.water.transfer=apic", fmt::format("time.fps={}", fps),
                                fmt::format("time.cfl={}", cfl), fmt::format("rigid.ball.density={}", density)}));
  };
  double least = 10, most = 0;
  for (const auto& [fps, cfl] :
       {std::pair{24.0, 2.0}, std::pair{48.0, 2.0}, std::pair{100.0, 2.0}, std::pair{100.0, 0.5}}) {
    const Rise r = rise_of(fps, cfl, ball);
    least = std::min(least, r.part), most = std::max(most, r.part);
    const std::string who = fmt::format("{} fps, cfl {}", fps, cfl);
    t.report(fmt::format("{}, steps of {:.2g} ms: way over that without drag", who, r.dt * 1e3), r.part);
    plot.curves.push_back({who, r.t, r.way});
  }
  const char *const low = "way after 0.15 s over that without drag, the least of them",
                    *const high = "the same, the most of them";
  t.at_least(low, least, 0.85);
  t.at_most(high, most, 1.1);
  t.control("a ball of 500 kg/m^3 taken for one of 300", low, rise_of(100, 2, 500).part);
  t.control("a ball of 150 kg/m^3 taken for one of 300", high, rise_of(100, 2, 150).part);
  plot.curves.push_back(without_drag());
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace rigid_rise_case

extern const Case rigid_rise;
const Case rigid_rise{"rigid-rise",
                      "a light ball rises in still water, and the same for every length of step",
                      "Added mass of a sphere: Lamb 1932, Hydrodynamics, art. 92",
                      false,
                      rigid_rise_case::run,
                      20,
                      200};

extern const Case rigid_rise_projection;
const Case rigid_rise_projection{"rigid-rise-projection",
                                 "a light ball rises in still water by the projection, whatever its steps are",
                                 rigid_rise.source,
                                 true,
                                 rigid_rise_case::run_projection,
                                 5};

}  // namespace dreampm::validate::cases
