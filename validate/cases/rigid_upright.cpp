// Stability of a floating box: the sign of its metacentric height, and the angle at which it heels
// where that is negative.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "validate/floater.h"

namespace dreampm::validate::cases {
namespace rigid_upright_case {
namespace {

/// Metacentric height over the height of a box of that width over height and density over the
/// water's: half of the draft, and the second moment of the water plane over the volume displaced,
/// less half of the height.
double metacentric_height(double width, double density) { return density / 2 + width * width / (12 * density) - 0.5; }
/// The angle [degrees] at which a box of negative metacentric height heels, while its surface line
/// cuts both sides: tan^2 = -2 GM/BM.
double heel(double width, double density) {
  const double metacenter = width * width / (12 * density);
  return std::atan(std::sqrt(std::max(0.0, -2 * metacentric_height(width, density) / metacenter))) * 180 /
         std::numbers::pi;
}

struct Attitude {
  double off = 0;  ///< degrees that the watched axis is off the vertical, mean over the last second
  std::vector<double> time, angle;
};

/// `axis` of the box that is watched.
Attitude settle(Trial& t, const FloaterSetUp& s, int axis, double end) {
  Floater f(t, s);
  Attitude a;
  int samples = 0;
  f.run.until(end, [&](const StepSums& step) {
    if (!step.frame_done) return;
    a.time.push_back(f.run.world.time), a.angle.push_back(f.off_vertical(axis));
    if (f.run.world.time > end - 1) a.off += a.angle.back(), ++samples;
  });
  a.off /= samples;
  return a;
}

/// A box of that width over its height of 12 cm and half of the water's density, half immersed.
FloaterSetUp beam_of(double width, double tilt) {
  FloaterSetUp s;
  s.basin = {0.4, 0.32, 0.24}, s.depth = 0.16, s.box = {width * 0.12, 0.12, 0.16}, s.below = 0, s.tilt = tilt;
  return s;
}

void run(Trial& t) {
  t.note_choice(
      "Metacentric height: GM = KB + BM - KG, BM the second moment of the water plane over the volume displaced. A box "
      "of width b, height h and s times the water's density has GM/h = s/2 + (b/h)^2/(12 s) - 1/2. Where that is "
      "negative and its surface line cuts both sides, it heels to tan^2 = -2 GM/BM. Angles are means over the last "
      "second.");
  Plot plot{"rigid-upright", "Boxes let go in water (dashed: exact)", "time  [s]", "off the vertical  [degrees]", {}};
  const double end = t.full() ? 5 : 2.5;
  FloaterSetUp tall;
  tall.basin = {0.4, 0.36, 0.28}, tall.depth = 0.16, tall.box = {0.08, 0.16, 0.2}, tall.below = 0, tall.tilt = 5;
  const std::string tips = "a box twice as high as wide let go at 5 degrees: its width off the vertical";
  const Attitude fell = settle(t, tall, 0, end);
  t.at_most(tips, fell.off, 3, "degrees");
  t.report("its metacentric height upright, of its height", metacentric_height(0.5, 0.5));
  FloaterSetUp wide = tall;
  wide.box = {0.16, 0.08, 0.2};
  t.control("twice as wide as high, 1 s", tips, settle(t, wide, 0, 1).off);
  plot.curves.push_back({"tall box: its width", fell.time, fell.angle});

  if (t.full()) {
    FloaterSetUp plank;
    plank.basin = {0.4, 0.32, 0.24}, plank.depth = 0.12, plank.box = {0.24, 0.06, 0.16};
    plank.density = 600, plank.below = 0, plank.tilt = 30;
    const std::string flat = "a plank let go at 30 degrees: its thickness off the vertical";
    const Attitude lies = settle(t, plank, 1, end);
    t.at_most(flat, lies.off, 3, "degrees");
    FloaterSetUp held = plank;
    held.extra = ", lock: [rx, ry, rz]";
    t.control("a plank that cannot turn, 0.5 s", flat, settle(t, held, 1, 0.5).off);
    plot.curves.push_back({"plank: its thickness", lies.time, lies.angle});

    const auto name = [](double width) {
      return fmt::format("a box {} times as wide as high let go at 10 degrees: off its {:.1f} degrees", width,
                         heel(width, 0.5));
    };
    const auto off = [](const Attitude& a, double width) { return std::abs(a.off - heel(width, 0.5)); };
    const Attitude heels = settle(t, beam_of(1.1, 10), 1, end), rights = settle(t, beam_of(1.35, 10), 1, end);
    t.at_most(name(1.1), off(heels, 1.1), 3, "degrees")
        .known("It is on its way there, and slower than its moment and inertia ask for.", 9);
    t.at_most(name(1.35), off(rights, 1.35), 3, "degrees")
        .known(
            "Its metacentric height is a twentieth of its height, a third of a cell; it is on its way upright, and "
            "slower "
            "than its moment and inertia ask for.",
            6);
    for (const double width : {1.1, 1.35})
      t.report(fmt::format("metacentric height of {} times as wide as high, of its height", width),
               metacentric_height(width, 0.5));
    t.control("1.35 times as wide as high", name(1.1), off(rights, 1.1));
    t.control("0.8 times as wide as high", name(1.35), off(settle(t, beam_of(0.8, 10), 1, 2), 1.35));
    plot.curves.push_back({"1.1 times as wide as high", heels.time, heels.angle});
    plot.curves.push_back({"1.35 times as wide as high", rights.time, rights.angle});
    plot.curves.push_back(level("", 0, end, heel(1.1, 0.5)));
  }
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace rigid_upright_case

extern const Case rigid_upright;
const Case rigid_upright{"rigid-upright",
                         "a plank lies flat, a tall box tips over, and a box of small width heels by its angle",
                         "the metacentric height, exact (Bouguer 1746; Newman 1977, Marine Hydrodynamics, 6.1)",
                         false,
                         rigid_upright_case::run,
                         25,
                         90};

}  // namespace dreampm::validate::cases
