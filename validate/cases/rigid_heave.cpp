// A log lies half in the water and is let go above its draft: its heave against the linear theory
// of water waves, which has its added mass and the waves that it makes.
#include <algorithm>
#include <cmath>

#include "validate/floater.h"
#include "validate/measure/fit.h"
#include "validate/measure/hydrostatic.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace rigid_heave_case {
namespace {

constexpr double g = 9.81, radius = 0.15, depth = 3 * radius, lifted = 0.2 * radius, end = 8;

struct Heave {
  std::vector<double> time, height;  ///< in sqrt(a/g); over the level of the water at the start, of the lift
};

struct HeaveSetUp {
  int cells = 6;  ///< of the radius
  double until = end;
  double weight = g;  ///< m/s^2: gravity, wrong for a control
  bool projection = false;
};

Heave heave(Trial& t, const HeaveSetUp& s) {
  const double dx = radius / s.cells, unit = std::sqrt(radius / g);
  // The log is as long as the period: four cells, or a lot of the projection's.
  const double across = (s.projection ? 8 : 4) * dx;
  const auto triple = [&](double x, double y) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x, y, across); };
  const std::string at = fmt::format("[{:.17g}, {:.17g}, {:.17g}]", 6 * radius, depth + lifted, across / 2),
                    log = fmt::format("cylinder: {{radius: {:.17g}, height: {:.17g}}}", radius, across),
                    along = "rotate: {axis: [1, 0, 0], angle: 90}";
  const std::vector<std::string> overrides{
      fmt::format("space.spacing={:.17g}", dx / 2),
      fmt::format("gravity=[0, {}, 0]", -s.weight),
      "space.max=" + triple(12 * radius, 0.7),
      fmt::format("bodies.water.shape={{difference: [{{box: {{min: [0, 0, 0], max: {}}}}}, {{{}, center: {}, {}}}]}}",
                  triple(12 * radius, depth), log, at, along),
      fmt::format("rigid.log.shape={{{}, {}}}", log, along),
      "rigid.log.position=" + at};
  ValidationRun<float> run(t, "rigid-heave", s.projection ? by_projection("water", overrides) : overrides);
  const Hydrostatic rest(run.world.sets[0].values, s.weight, depth);
  const double level = run.compresses() ? rest.pressed(depth) : depth;
  // With the water around it.
  if (run.compresses()) rest.move(run.seeds[0]), move_body(run.world, 0, {0, level - depth, 0});
  run.begin();
  if (run.compresses()) rest.press(run.world);
  Heave h;
  const auto look = [&] {
    h.time.push_back(run.world.time / unit);
    h.height.push_back((run.world.colliders.at(0).twist.center.y - level) / lifted);
  };
  look();
  run.until(s.until * unit, [&](const StepSums&) { look(); });
  return h;
}

struct Marks {
  double zeros[2] = {0, 0};              ///< when it first comes down through the level, and up
  double trough = 0, crest = 0, at = 0;  ///< the lowest height between them, the highest behind, and when that is
  double period() const { return 2 * (zeros[1] - zeros[0]); }
};
/// Returns the time at the top of the parabola through a sample and those beside it.
double time_of_top(const std::vector<double>& time, const std::vector<double>& height, std::size_t i) {
  if (i + 1 >= time.size()) return time[i];
  const double before = time[i] - time[i - 1], behind = time[i + 1] - time[i],
               up = (height[i] - height[i - 1]) / before, down = (height[i + 1] - height[i]) / behind;
  return up > down ? (time[i - 1] + time[i]) / 2 + up / (up - down) * (before + behind) / 2 : time[i];
}
Marks marks_of(const std::vector<double>& time, const std::vector<double>& height) {
  Marks m;
  int zeros = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double a = height[i - 1], b = height[i];
    if (zeros < 2 && (a > 0) != (b > 0)) m.zeros[zeros++] = time[i - 1] + (time[i] - time[i - 1]) * a / (a - b);
    m.trough = std::min(m.trough, b);
    if (zeros == 2 && b > m.crest) m.crest = b, m.at = time_of_top(time, height, i);
  }
  if (zeros < 2) throw RunError("the log does not swing: it passes the level of the water less than twice");
  return m;
}

double worst_off(const Heave& h, const std::vector<double>& time, const std::vector<double>& height) {
  double worst = 0;
  for (std::size_t i = 0; i < time.size() && time[i] <= end; ++i)
    worst = std::max(worst, std::abs(interpolate(h.time, h.height, time[i]) - height[i]));
  return worst;
}

std::string period_at(int cells) { return fmt::format("radius of {} cells: error of the period between zeros", cells); }
std::string fall_at(int cells) {
  return fmt::format("radius of {} cells: error of the time to the second zero", cells);
}

std::string crest_at(int cells) {
  return fmt::format("radius of {} cells: error of the time from the start to the first crest", cells);
}

/// Logs of those radii [cells].
void judge(Trial& t, const std::vector<int>& sizes, bool projection, Plot plot) {
  const Table theory = reference_table("heave_half_immersed_cylinder.csv");
  const auto time = theory.numbers("t"), tank = theory.numbers("tank");
  const Marks want = marks_of(time, tank);
  for (const int cells : sizes) {
    const Heave h = heave(t, {.cells = cells, .projection = projection});
    const Marks m = marks_of(h.time, h.height);
    const std::string who = fmt::format("radius of {} cells: ", cells);
    if (projection) t.at_most(crest_at(cells), std::abs(m.at / want.at - 1), 0.03, "%");
    t.at_most(period_at(cells), std::abs(m.period() / want.period() - 1), 0.05, "%");
    t.at_most(fall_at(cells), std::abs(m.zeros[1] / want.zeros[1] - 1), 0.05, "%");
    t.report(who + fmt::format("trough, wanted {:.3f}", want.trough), m.trough, "of the lift");
    t.report(who + fmt::format("crest, wanted {:.3f}", want.crest), m.crest, "of the lift");
    t.report(who + "farthest from the theory", worst_off(h, time, tank), "of the lift");
    plot.curves.push_back({fmt::format("a/{}", cells), h.time, h.height});
  }
  const Heave slow = heave(t, {.until = projection ? 8.5 : 6.5, .weight = 8.5, .projection = projection});
  const Marks m = marks_of(slow.time, slow.height);
  for (const int cells : sizes) {
    const char* const what = "gravity of 8.5 m/s^2, a/6";
    if (projection) t.control(what, crest_at(cells), std::abs(m.at / want.at - 1));
    t.control(what, period_at(cells), std::abs(m.period() / want.period() - 1));
    t.control(what, fall_at(cells), std::abs(m.zeros[1] / want.zeros[1] - 1));
  }
  plot.curves.push_back({"linear theory in this tank", time, tank, true});
  plot.curves.push_back({"linear theory, deep and without ends", time, theory.numbers("deep"), true});
  t.plot(std::move(plot));
}

constexpr const char* detach =
    "Let go at rest a tenth of its diameter above its draft. The period is twice the time between its first two "
    "passages of the water's level at the start. The tank is periodic across, {} cells wide. The theory is that in "
    "this tank: waves come back from its ends before the first crest.";

void run(Trial& t) {
  t.note_choice(fmt::format(detach, "four"));
  judge(t, t.full() ? std::vector{6, 9} : std::vector{6}, false,
        {"rigid-heave", "Heave of a log of half the water's density", "time  [sqrt(a/g)]", "height / lift", {}});
}

void run_projection(Trial& t) {
  t.note_choice(fmt::format(detach, "eight"));
  t.note_choice(
      "The time to the first crest is a period too, which does not ask where the level is: half a millimeter more or "
      "less of that, 2 % of the lift, changes the time between passages by 3 %.");
  judge(t, t.full() ? std::vector{6, 9, 12} : std::vector{6, 9}, true,
        {"rigid-heave-projection",
         "Heave of a log of half the water's density, by the projection",
         "time  [sqrt(a/g)]",
         "height / lift",
         {}});
}

}  // namespace
}  // namespace rigid_heave_case

extern const Case rigid_heave;
const Case rigid_heave{"rigid-heave",
                       "a log of half the water's density heaves: the period, with its added mass",
                       "linear theory: Ursell 1949, Q. J. Mech. Appl. Math. 2:218; Maskell & Ursell 1970, J. Fluid "
                       "Mech. 44:303; Yeung 1982, J. Eng. Math. 16:97",
                       true,
                       rigid_heave_case::run,
                       22,
                       75};

extern const Case rigid_heave_projection;
const Case rigid_heave_projection{"rigid-heave-projection",
                                  "a log of half the water's density heaves by the projection: the period",
                                  rigid_heave.source,
                                  true,
                                  rigid_heave_case::run_projection,
                                  10,
                                  20};

}  // namespace dreampm::validate::cases
