// Rigid boxes of three densities float: their draft, and whether they come to rest.
#include <algorithm>
#include <cmath>

#include "validate/floater.h"

namespace dreampm::validate::cases {
namespace rigid_draft_case {
namespace {

constexpr double height = 0.12, watch_from = 5, watch_to = 5.5;

struct Afloat {
  double draft = 0;  ///< m, mean while it is watched
  double speed = 0;  ///< m/s, the largest while it is watched
  std::vector<double> time, depth, fastest;
};

double exact_draft(double density) { return density / Floater::water_density * height; }

/// A box of that density [kg/m^3] is let go 1 cm above the draft of one of `taken_for`, in water
/// that is damped until `calm` [s], and watched from `from` to `end` [s].
Afloat afloat(Trial& t, double density, double dx, double taken_for, double calm = 2, double from = watch_from,
              double end = watch_to) {
  FloaterSetUp s;
  s.basin = {0.36, 0.32, 0.36}, s.depth = 0.16;
  s.dx = dx, s.density = density;
  s.below = exact_draft(taken_for) - height / 2 - 0.01;
  Floater f(t, s);
  f.run.world.settings.damping = calm > 0 ? 5 : 0;
  Afloat a;
  int samples = 0;
  f.run.until(end, [&](const StepSums& step) {
    if (f.run.world.time >= calm) f.run.world.settings.damping = 0;
    if (f.run.world.time >= from) a.speed = std::max(a.speed, f.speed());
    if (!step.frame_done) return;
    a.time.push_back(f.run.world.time), a.depth.push_back(f.draft()), a.fastest.push_back(f.speed());
    if (f.run.world.time >= from) a.draft += a.depth.back(), ++samples;
  });
  a.draft /= samples;
  return a;
}

std::string draft_of(double density, double dx) {
  return fmt::format("{:.0f} kg/m^3, {:.0f} cells high: error of the draft, of the height", density, height / dx);
}
std::string speed_of(double density, double dx) {
  return fmt::format("{:.0f} kg/m^3, {:.0f} cells high: fastest point after {:.0f} s", density, height / dx,
                     watch_from);
}

void judge(Trial& t, double density, double dx, Plot& drafts, Plot& speeds) {
  const Afloat a = afloat(t, density, dx, density);
  const double want = exact_draft(density);
  t.at_most(draft_of(density, dx), std::abs(a.draft - want) / height, 0.03, "%");
  t.at_most(speed_of(density, dx), a.speed, 0.002, "m/s");
  t.report("the draft over the exact, minus 1", a.draft / want - 1, "%");
  const std::string name = fmt::format("{:.0f} kg/m^3, {:.0f} cells", density, height / dx);
  drafts.curves.push_back({name, a.time, a.depth});
  drafts.curves.push_back({"", {0, watch_to}, {want, want}, false, true});
  Curve c{name, a.time, a.fastest};
  for (double& y : c.y) y = std::log10(y);
  speeds.curves.push_back(std::move(c));
}

void run(Trial& t) {
  t.note_choice(
      "A box of 20 x 12 x 20 cm in a basin of 36 x 36 cm with 16 cm of water; let go 1 cm above its draft. The water "
      "is "
      "damped by 5/s for 2 s, so that no waves are left; what moves behind is made by the solver. The water's level is "
      "that of a flat surface around the box, from the mean height of its particles.");
  Plot drafts{"rigid-draft", "Draft of rigid boxes (dashed: exact)", "time  [s]", "draft  [m]", {}},
      speeds{"rigid-draft-speed", "Speed of the fastest point of rigid boxes", "time  [s]", "log10 of m/s", {}};
  const double dx = 0.02, fine = 0.04 / 3;
  judge(t, 400, dx, drafts, speeds);
  const Afloat wrong = afloat(t, 520, dx, 400, 0, 0.5, 1);
  const std::string control = "520 for 400 kg/m^3, 6 cells high, not damped, from 0.5 to 1 s";
  const auto refuse = [&](double density, double cells) {
    t.control(control, draft_of(density, cells), std::abs(wrong.draft - exact_draft(400)) / height);
    t.control(control, speed_of(density, cells), wrong.speed);
  };
  refuse(400, dx);
  if (t.full()) {
    judge(t, 100, dx, drafts, speeds), judge(t, 900, dx, drafts, speeds), judge(t, 400, fine, drafts, speeds);
    refuse(100, dx), refuse(900, dx), refuse(400, fine);
  }
  speeds.curves.push_back(level("gate, after 5 s", watch_from, watch_to, std::log10(0.002)));
  t.plot(std::move(drafts)), t.plot(std::move(speeds));
}

}  // namespace
}  // namespace rigid_draft_case

extern const Case rigid_draft;
const Case rigid_draft{"rigid-draft",
                       "rigid boxes of three densities float at their draft and come to rest",
                       "Archimedes, exact",
                       true,
                       rigid_draft_case::run,
                       20,
                       100};

}  // namespace dreampm::validate::cases
