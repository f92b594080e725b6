// Linear sloshing of a tank: omega^2 = g k tanh(k h), k = n pi/L.
#include <algorithm>
#include <numbers>

#include "validate/measure/fit.h"
#include "validate/measure/hydrostatic.h"
#include "validate/measure/motion.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace sloshing_case {
namespace {

constexpr double g = 9.81;

/// The theory is that of waves without height: with a crest of a the period is longer by the part
/// (k a)^2/8 (Rayleigh 1915, for deep water), 1.1 % in a third mode one cell high. At this k a it
/// is 0.3 %.
constexpr double steepest = 0.15;

/// A wave; defaults are the values that all rows of the reference share.
struct Wave {
  double periods = 2.1;  ///< exact ones
  double crest = 0;      ///< cells; 0: one, or as high as the steepest may be
  int finer = 1;         ///< times the cells
  double gravity = g;    ///< m/s^2
  bool projection = false;
};

/// The mode's amplitude over exact periods, times in periods. The tank has 32 cells of length or
/// more and is 4 thick.
Swing slosh(Trial& t, double length, double depth, double k, double omega, const Wave& wave = {}) {
  const double dx = length / (depth / length < 0.25 ? 64 : 32) / wave.finer;
  const double crest = wave.crest > 0 ? wave.crest * dx : std::min(dx, steepest / k);
  const auto box = [&](double height) { return fmt::format("[{:.17g},{:.17g},{:.17g}]", length, height, 4 * dx); };
  const std::vector<std::string> overrides{fmt::format("space.spacing={:.17g}", dx / 2),
                                           "space.max=" + box(1.5 * depth + 4 * dx),
                                           "bodies.water.shape={box: {min: [0,0,0], max: " + box(depth) + "}}",
                                           fmt::format("materials.water.bulk_modulus={:.17g}", 1e5 * 2 * g * depth),
                                           fmt::format("gravity=[0,{:.17g},0]", -wave.gravity)};
  ValidationRun<float> run(t, "sloshing", wave.projection ? by_projection("water", overrides) : overrides);
  const Hydrostatic rest(run.world.sets[0].values, wave.gravity, depth);
  // Potential flow under a standing wave.
  const Field mode = [&](const Vec3d& p) {
    return Vec3d{-std::sin(k * p.x) * std::cosh(k * p.y), std::cos(k * p.x) * std::sinh(k * p.y), 0} /
           std::sinh(k * depth);
  };
  if (run.compresses()) rest.move(run.seeds[0]);
  for (ParticleSeed& n : run.seeds[0])
    set_motion(n, [&](const Vec3d& p) { return mode(p) * (crest * omega); }, 1e-4 * dx);
  const auto seeds = run.all_seeds();
  run.begin();
  if (run.compresses()) rest.press(run.world);
  const double period = 2 * std::numbers::pi / omega;
  Swing swing;
  swing.add(0, 0);
  run.until(wave.periods * period, [&](const StepSums& r) {
    if (run.world.step % (wave.projection ? 2 : 8) == 0 || r.frame_done)
      swing.add(run.world.time / period, mode_amplitude(run.world, seeds, mode) / crest);
  });
  return swing;
}

std::string name_of(double length, double depth, double n) {
  return fmt::format("{:.4g} x {:.4g} m, mode {:.0f}: error of the period", length, depth, n);
}

Curve exact_sine() {
  Curve sine{"exact", {}, {}, true};
  for (double s = 0; s <= 2.1; s += 0.05) sine.x.push_back(s), sine.y.push_back(std::sin(2 * std::numbers::pi * s));
  return sine;
}

void run_projection(Trial& t) {
  t.note_choice("A crest of one cell; 64 cells of length. The shallow tank is 7 cells deep.");
  const Table exact = reference_table("linear_sloshing_periods.csv");
  Plot plot{"sloshing-projection",
            "Sloshing modes of tanks, by the projection",
            "time / exact period",
            "amplitude of the mode / crest",
            {}};
  for (std::size_t row = 0; row < exact.size(); ++row) {
    const double length = exact.number(row, "L"), depth = exact.number(row, "h"), n = exact.number(row, "n");
    const double k = exact.number(row, "k"), omega = exact.number(row, "omega");
    if (!(length == 1 || (length == 0.9 && n == 1))) continue;
    const auto wave = [&](double periods, double gravity) {
      return slosh(
          t, length, depth, k, omega,
          {.periods = periods, .crest = 1, .finer = length == 1 ? 2 : 1, .gravity = gravity, .projection = true});
    };
    const Swing swing = wave(2.1, g);
    const std::string name = name_of(length, depth, n);
    t.at_most(name, std::abs(swing.period() - 1), length == 1 ? 0.01 : 0.02, "%");
    t.report(fmt::format("{:.4g} x {:.4g} m, mode {:.0f}: period over the exact one", length, depth, n),
             swing.period());
    t.control("gravity 8.8 for 9.81", name, std::abs(wave(1.2, 8.8).period() - 1));
    plot.curves.push_back({fmt::format("{:.4g} x {:.4g} m, n = {:.0f}", length, depth, n), swing.times, swing.values});
  }
  plot.curves.push_back(exact_sine());
  t.plot(std::move(plot));
}

void run(Trial& t) {
  t.note_choice(
      "A crest of one cell, but at most as high as k a = 0.15, as the reference is the theory of waves without height: "
      "the period of a wave one cell high is 1.1 % longer in a third mode (Rayleigh 1915), and so measured it is 3.3 % "
      "off, which would miss its gate (reported below with --full). k a <= 0.15 was chosen with commit c4adf5d.");
  t.note_choice(
      "32 cells of length and more, 64 in the shallow tank; potential flow at the start, on hydrostatic pressure.");
  const Table exact = reference_table("linear_sloshing_periods.csv");
  Plot plot{"sloshing", "Sloshing modes of tanks", "time / exact period", "amplitude of the mode / crest", {}};
  for (std::size_t row = 0; row < exact.size(); ++row) {
    const double length = exact.number(row, "L"), depth = exact.number(row, "h"), n = exact.number(row, "n");
    const double k = exact.number(row, "k"), omega = exact.number(row, "omega");
    // The tank 2 x 1 is the tank 1 x 0.5 in other units; quick takes the first modes of one deep
    // and one shallow tank.
    const bool wanted = t.full() ? true : (length == 1 && n <= 2) || (length == 0.9 && n == 1);
    if (!wanted) continue;
    const Swing swing = slosh(t, length, depth, k, omega);
    const std::string name = name_of(length, depth, n);
    t.at_most(name, std::abs(swing.period() - 1), 0.03, "%");
    t.report(fmt::format("{:.4g} x {:.4g} m, mode {:.0f}: period over the exact one", length, depth, n),
             swing.period());
    plot.curves.push_back({fmt::format("{:.4g} x {:.4g} m, n = {:.0f}", length, depth, n), swing.times, swing.values});
    // Compared with the right one's period. Waves that are short for their tank know nothing of its
    // depth.
    const auto wrong = [&](double deep, double gravity) {
      return std::abs(slosh(t, length, deep, k, omega, {.periods = 1.2, .gravity = gravity}).period() - 1);
    };
    t.control("gravity 8.8 for 9.81", name, wrong(depth, 8.8));
    if (length == 1 && n == 1) t.control("a tank a fifth too shallow", name, wrong(0.8 * depth, g));
    if (t.full() && length == 1 && n == 3) {
      const std::string same = fmt::format("{:.4g} x {:.4g} m, mode {:.0f}, ", length, depth, n);
      for (const auto& [high, crest] : {std::pair{"a quarter of a cell", 0.25}, std::pair{"a cell", 1.0}})
        t.report(same + high + " high: period over the exact one",
                 slosh(t, length, depth, k, omega, {.crest = crest}).period());
      t.report(same + "cells half as large: period over the exact one",
               slosh(t, length, depth, k, omega, {.finer = 2}).period());
    }
  }
  if (plot.curves.size() > 6) plot.curves.resize(6);
  plot.curves.push_back(exact_sine());
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace sloshing_case

extern const Case sloshing;
const Case sloshing{"sloshing",
                    "the periods of standing waves in tanks of water, a cell high or less",
                    "linear wave theory, exact: linear_sloshing_periods.csv",
                    true,
                    sloshing_case::run,
                    35,
                    110};

extern const Case sloshing_projection;
const Case sloshing_projection{"sloshing-projection",
                               "the periods of standing waves in tanks of water by the projection",
                               "linear wave theory, exact: linear_sloshing_periods.csv",
                               true,
                               sloshing_case::run_projection,
                               5};

}  // namespace dreampm::validate::cases
