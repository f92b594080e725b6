// A log lies half in the water and is let go above its draft: its heave against the linear theory
// of water waves, which has its added mass and the waves that it makes.
#include <algorithm>
#include <cmath>

#include "dreampm/validate/floater.h"
#include "dreampm/validate/measure/fit.h"
#include "dreampm/validate/measure/hydrostatic.h"
#include "dreampm/validate/validation_run.h"

namespace dreampm::validate::cases {
namespace rigid_heave_case {
namespace {

constexpr double g = 9.81, radius = 0.15, depth = 3 * radius, lifted = 0.2 * radius, end = 8;

struct Heave {
  std::vector<double> time, height;  ///< in sqrt(a/g); over the level of the water at the start, of the lift
};

/// `weight` [m/s^2]: gravity, wrong for a control.
Heave heave(Trial& t, int cells, double until = end, double weight = g) {
  const double dx = radius / cells, unit = std::sqrt(radius / g);
  // Four cells across: the log is as long as the period.
  const auto triple = [&](double x, double y) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x, y, 4 * dx); };
  const std::string at = fmt::format("[{:.17g}, {:.17g}, {:.17g}]", 6 * radius, depth + lifted, 2 * dx),
                    log = fmt::format("cylinder: {{radius: {:.17g}, height: {:.17g}}}", radius, 4 * dx),
                    along = "rotate: {axis: [1, 0, 0], angle: 90}";
  ValidationRun<float> run(
      t, "rigid-heave",
      {fmt::format("space.spacing={:.17g}", dx / 2), fmt::format("gravity=[0, {}, 0]", -weight),
       "space.max=" + triple(12 * radius, 0.7),
       fmt::format("bodies.water.shape={{difference: [{{box: {{min: [0, 0, 0], max: {}}}}}, {{{}, center: {}, {}}}]}}",
                   triple(12 * radius, depth), log, at, along),
       fmt::format("rigid.log.shape={{{}, {}}}", log, along), "rigid.log.position=" + at});
  const Hydrostatic rest(run.world.sets[0].values, weight, depth);
  rest.move(run.seeds[0]);
  const double level = rest.pressed(depth);
  // With the water around it.
  move_body(run.world, 0, {0, level - depth, 0});
  run.begin();
  rest.press(run.world);
  Heave h;
  const auto look = [&] {
    h.time.push_back(run.world.time / unit);
    h.height.push_back((run.world.colliders.at(0).twist.center.y - level) / lifted);
  };
  look();
  run.until(until * unit, [&](const StepSums&) { look(); });
  return h;
}

struct Marks {
  double zeros[2] = {0, 0};              ///< when it first comes down through the level, and up
  double trough = 0, crest = 0, at = 0;  ///< the lowest height between them, the highest behind, and when that is
  double period() const { return 2 * (zeros[1] - zeros[0]); }
};
Marks marks_of(const std::vector<double>& time, const std::vector<double>& height) {
  Marks m;
  int zeros = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double a = height[i - 1], b = height[i];
    if (zeros < 2 && (a > 0) != (b > 0)) m.zeros[zeros++] = time[i - 1] + (time[i] - time[i - 1]) * a / (a - b);
    m.trough = std::min(m.trough, b);
    if (zeros == 2 && b > m.crest) m.crest = b, m.at = time[i];
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

void run(Trial& t) {
  t.chose(
      "Let go at rest a tenth of its diameter above its draft. The period is twice the time between its first two "
      "passages of the water's level at the start. The tank is periodic across, four cells wide. The theory is that in "
      "this tank: waves come back from its ends before "
      "the first crest.");
  const Table theory = reference_table("heave_half_immersed_cylinder.csv");
  const auto time = theory.numbers("t"), tank = theory.numbers("tank");
  const Marks want = marks_of(time, tank);
  Plot plot{"rigid-heave", "Heave of a log of half the water's density", "time  [sqrt(a/g)]", "height / lift", {}};
  std::vector<int> sizes{6};
  if (t.full()) sizes.push_back(9);
  for (const int cells : sizes) {
    const Heave h = heave(t, cells);
    const Marks m = marks_of(h.time, h.height);
    const std::string who = fmt::format("radius of {} cells: ", cells);
    t.at_most(period_at(cells), std::abs(m.period() / want.period() - 1), 0.05, "%");
    t.at_most(fall_at(cells), std::abs(m.zeros[1] / want.zeros[1] - 1), 0.05, "%");
    t.report(who + fmt::format("trough, wanted {:.3f}", want.trough), m.trough, "of the lift");
    t.report(who + fmt::format("crest, wanted {:.3f}", want.crest), m.crest, "of the lift");
    t.report(who + "farthest from the theory", worst_off(h, time, tank), "of the lift");
    plot.curves.push_back({fmt::format("a/{}", cells), h.time, h.height});
  }
  const Heave slow = heave(t, 6, 6.5, 8.5);
  const Marks m = marks_of(slow.time, slow.height);
  for (const int cells : sizes) {
    t.control("gravity of 8.5 m/s^2, a/6", period_at(cells), std::abs(m.period() / want.period() - 1));
    t.control("gravity of 8.5 m/s^2, a/6", fall_at(cells), std::abs(m.zeros[1] / want.zeros[1] - 1));
  }
  plot.curves.push_back({"linear theory in this tank", time, tank, true});
  plot.curves.push_back({"linear theory, deep and without ends", time, theory.numbers("deep"), true});
  t.plot(std::move(plot));
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

}  // namespace dreampm::validate::cases
