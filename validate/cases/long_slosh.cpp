// Twenty periods of a standing wave: its period, its depth and how long it lives.
#include "validate/measure/fit.h"
#include "validate/measure/motion.h"
#include "validate/tank.h"

namespace dreampm::validate::cases {
namespace long_slosh_case {
namespace {

struct Slosh {
  double period = 0, depth = 0, kept = 0;
  double sway = 0;  ///< m, exact amplitude of the center of mass
  Swing swing;
};

/// A meter in `cells`, half as deep. `packed`: how much water there is on its points, over what
/// there should be, for controls.
Slosh slosh(Trial& t, int cells, int periods, const std::vector<std::string>& overrides = {}, double packed = 1) {
  const double dx = 1.0 / cells, length = cells * dx, k = std::numbers::pi / length, crest = 1.5 * dx;
  // Cells above the crest: of 64, the liquid itself is 64 x 32 x 4.
  Tank tank(t, {cells, cells * 11 / 16, 4}, cells / 2, overrides, dx);
  tank.run.world.sets[0].mass *= packed, tank.run.world.sets[0].rest_volume *= packed;
  const double omega = std::sqrt(Tank::g * k * std::tanh(k * tank.height)), period = 2 * std::numbers::pi / omega;
  // Potential flow under a standing wave (Lamb, Hydrodynamics, section 228).
  const Field mode = [&](const Vec3d& p) {
    return Vec3d{-std::sin(k * p.x) * std::cosh(k * p.y), std::cos(k * p.x) * std::sinh(k * p.y), 0} /
           std::sinh(k * tank.height);
  };
  for (ParticleSeed& n : tank.run.seeds[0])
    set_motion(n, [&](const Vec3d& p) { return mode(p) * (crest * omega); }, 1e-4 * dx);
  const auto seeds = tank.run.all_seeds();
  tank.begin();
  Slosh s;
  s.swing.add(0, 0);
  // The mean of the displacement -a sin(k x) cosh(k y)/sinh(k H) over the tank.
  s.sway = 2 * crest / (std::numbers::pi * k * tank.height);
  double depth = 0;
  int n = 0;
  // The elevation's first Fourier part, by the sideways motion of the center: particles mix, so
  // that displacements from birth would lose the mode.
  const double middle = mean_position(tank.run.world).x;
  tank.run.until((periods + 0.3) * period, [&](const StepSums& r) {
    if (tank.run.world.step % 8 == 0 || r.frame_done)
      s.swing.add(tank.run.world.time / period, mean_position(tank.run.world).x - middle);
    if (r.frame_done && tank.run.world.time > (periods - 1) * period) depth += tank.depth(), ++n;
  });
  s.period = s.swing.period();
  s.depth = depth / n;
  const std::size_t last = s.swing.zeros() - 2;
  s.kept = s.swing.extreme(last) / s.swing.extreme(0);
  return s;
}

void run(Trial& t) {
  t.note_choice("A crest of 1.5 cells, k a = 0.07, as LIQUID asks; sound is 10 sqrt(2 g H).");
  const Slosh s = slosh(t, 64, 20);
  t.at_most("error of the period", std::abs(s.period - 1), 0.01, "%");
  const char* const depth = "depth over the last period, change";
  t.at_most(depth, std::abs(s.depth), 0.005, "%");
  t.at_least("amplitude after 20 periods over the first", s.kept, 0.25);
  t.control("gravity 9.4 for 9.81, 32 cells, 12 periods", "error of the period",
            std::abs(slosh(t, 32, 12, {"gravity=[0,-9.4,0]"}).period - 1));
  // So gentle a wave keeps its depth without volume relaxation too, and with ten times as much: the
  // water itself is wrong.
  t.control("2 % too much water on its points, 32 cells, 3 periods", depth, std::abs(slosh(t, 32, 3, {}, 1.02).depth));
  t.control("honey for water, 32 cells, 12 periods", "amplitude after 20 periods over the first",
            slosh(t, 32, 12, {"materials.water.viscosity=10"}).kept);
  Curve exact{"linear theory, without viscosity", {}, {}, true};
  for (double p = 0; p < 20; p += 0.05)
    exact.x.push_back(p), exact.y.push_back(-s.sway * std::sin(2 * std::numbers::pi * p));
  t.plot({"long-slosh",
          "Twenty periods of a standing wave",
          "time / exact period",
          "center of mass, x  [m]",
          {{"ours", s.swing.times, s.swing.values}, std::move(exact)}});
}

}  // namespace
}  // namespace long_slosh_case

extern const Case long_slosh;
const Case long_slosh{"long-slosh",
                      "a standing wave of 1.5 cells in a tank of 64 x 32 cells, for twenty periods",
                      "linear wave theory; the project's own experiments for the decay",
                      false,
                      long_slosh_case::run,
                      480,
                      480};

}  // namespace dreampm::validate::cases
