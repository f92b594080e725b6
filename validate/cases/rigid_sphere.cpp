// A ball sinks through a thick liquid in a tube: Stokes' drag with the walls of the tube.
#include <cmath>
#include <numbers>

#include "validate/measure/fit.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace rigid_sphere_case {
namespace {

constexpr double g = 9.81, radius = 0.03, tube = 0.09, liquid = 1400, ball = 19300, viscosity = 100;
constexpr double from = 0.185, to = 0.15;  // m over the floor: where its speed is measured

/// Returns the drag of a sphere on the axis of a tube over Stokes' 6 pi mu a U, where the liquid
/// sticks to the walls (Haberman & Sayre 1958; Happel & Brenner 1965, eq. 7-3.67).
double walls_of_tube(double part) {
  const double l3 = part * part * part, l5 = l3 * part * part;
  return (1 - 0.75857 * l5) / (1 - 2.1050 * part + 2.0865 * l3 - 1.7068 * l5 + 0.72603 * l5 * part);
}
/// The same of 4 pi mu a U where it slips along the sphere: their fluid sphere without viscosity.
double walls_where_it_slips(double part) {
  const double l5 = std::pow(part, 5);
  return (1 + 1.13785 * l5) / (1 - 1.4034 * part + 1.1378 * l5 - 0.72603 * l5 * part);
}
double weight() { return (ball - liquid) * g * 4 / 3 * std::numbers::pi * radius * radius * radius; }
double sticking() { return weight() / (6 * std::numbers::pi * viscosity * radius * walls_of_tube(radius / tube)); }
double slipping() {
  return weight() / (4 * std::numbers::pi * viscosity * radius * walls_where_it_slips(radius / tube));
}

struct Fall {
  std::vector<double> time, height;  ///< s, m
  double speed = 0;                  ///< m/s, over the way that is measured
};

Fall fall(Trial& t, double spacing, std::vector<std::string> overrides = {}) {
  overrides.push_back(fmt::format("space.spacing={:.17g}", spacing));
  ValidationRun<float> run(t, "rigid-sphere", overrides);
  run.begin();
  Fall f;
  const auto height = [&] { return run.world.colliders.at(1).twist.center.y; };
  while (height() > to && run.world.time < 2) {
    f.time.push_back(run.world.time), f.height.push_back(height());
    run.step();
  }
  std::vector<double> time, way;
  for (std::size_t i = 0; i < f.time.size(); ++i)
    if (f.height[i] <= from) time.push_back(f.time[i]), way.push_back(f.height[i]);
  if (time.size() > 1) f.speed = -slope_of(time, way);
  return f;
}

std::string name_of(double spacing) {
  return fmt::format("ball of {:.0f} cells: error of its speed", radius / spacing);
}

Curve sinks(std::string name, double speed) {
  Curve c{std::move(name), {}, {}, true};
  for (int i = 0; i <= 10; ++i) c.x.push_back(0.02 * i), c.y.push_back(0.2 - speed * 0.02 * i);
  return c;
}

void run(Trial& t) {
  t.note_choice(fmt::format(
      "The ball's diameter is a third of the tube's; the speed is that between {} and {} m over the floor, in 0.3 m of "
      "liquid. Re = {:.2g}.",
      from, to, 2 * radius * sticking() * liquid / viscosity));
  Plot plot{"rigid-sphere", "A ball sinks along the axis of a tube", "time  [s]", "height  [m]", {}};
  std::vector<double> sizes{0.005};
  if (t.full()) sizes.push_back(0.00375);
  for (const double spacing : sizes) {
    const Fall f = fall(t, spacing);
    t.at_most(name_of(spacing), std::abs(f.speed / sticking() - 1), 0.05, "%")
        .known(
            "Not explained. A ball along which the liquid slips is a fifth too fast too, so that not all of it lies in "
            "how the ball holds the liquid.",
            0.5);
    t.report(fmt::format("its speed, wanted {:.4f}", sticking()), f.speed, "m/s");
    plot.curves.push_back({fmt::format("{:.0f} cells across", radius / spacing), f.time, f.height});
    if (spacing == sizes.front()) {
      plot.curves.push_back(sinks("where it sticks", sticking()));
      plot.curves.push_back(sinks("where it slips", slipping()));
    }
  }
  if (t.full()) {
    const Fall f = fall(t, sizes.front(), {"rigid.ball.type=separate"});
    t.report(fmt::format("ball of 6 cells along which it slips: its speed over {:.4f} m/s, minus 1", slipping()),
             f.speed / slipping() - 1, "%");
    plot.curves.push_back({"6 cells across, along which it slips", f.time, f.height});
  }
  const Fall thin = fall(t, sizes.front(), {"materials.syrup.viscosity=60"});
  for (const double spacing : sizes)
    t.control("viscosity of 60 Pa s, ball of 6 cells", name_of(spacing), std::abs(thin.speed / sticking() - 1));
  t.plot(std::move(plot));
}

void run_projection(Trial& t) {
  t.note_choice(fmt::format(
      "The ball's diameter is a third of the tube's; the speed is that between {} and {} m over the floor, in 0.3 m of "
      "liquid. Viscosity is implicit: a step a frame.",
      from, to));
  Plot plot{"rigid-sphere-projection",
            "A ball sinks along the axis of a tube, by the projection",
            "time  [s]",
            "height  [m]",
            {}};
  std::vector<double> sizes{0.005};
  if (t.full()) sizes.push_back(0.00375);
  Fall holds;
  for (const double spacing : sizes) {
    const Fall f = fall(t, spacing, by_projection("syrup"));
    if (spacing == sizes.front()) holds = f;
    t.at_most(name_of(spacing), std::abs(f.speed / sticking() - 1), 0.1, "%");
    t.report(fmt::format("its speed, wanted {:.4f}", sticking()), f.speed, "m/s");
    plot.curves.push_back({fmt::format("{:.0f} cells across", radius / spacing), f.time, f.height});
  }
  const std::string free = "ball of 6 cells along which it slips: error of its speed";
  const Fall slips = fall(t, sizes.front(), by_projection("syrup", {"rigid.ball.type=slip"}));
  t.at_most(free, std::abs(slips.speed / slipping() - 1), 0.15, "%");
  t.report(fmt::format("its speed, wanted {:.4f}", slipping()), slips.speed, "m/s");
  if (t.full()) {
    const Fall leaves = fall(t, sizes.front(), by_projection("syrup", {"rigid.ball.type=separate"}));
    t.report("a ball from which it may part: its speed over that, minus 1", leaves.speed / slipping() - 1, "%");
  }
  plot.curves.push_back({"6 cells across, along which it slips", slips.time, slips.height});
  const Fall thin = fall(t, sizes.front(), by_projection("syrup", {"materials.syrup.viscosity=60"}));
  for (const double spacing : sizes)
    t.control("viscosity of 60 Pa s, ball of 6 cells", name_of(spacing), std::abs(thin.speed / sticking() - 1));
  t.control("a ball that holds the syrup", free, std::abs(holds.speed / slipping() - 1));
  plot.curves.push_back(sinks("where it sticks", sticking())),
      plot.curves.push_back(sinks("where it slips", slipping()));
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace rigid_sphere_case

extern const Case rigid_sphere;
const Case rigid_sphere{"rigid-sphere",
                        "a ball sinks through a thick liquid along the axis of a tube",
                        "Stokes' drag with the walls of a tube: Haberman & Sayre 1958, David Taylor Model Basin "
                        "report 1143",
                        false,
                        rigid_sphere_case::run,
                        20,
                        60};

extern const Case rigid_sphere_projection;
const Case rigid_sphere_projection{"rigid-sphere-projection",
                                   "a ball sinks through a thick liquid along the axis of a tube, by the projection",
                                   rigid_sphere.source,
                                   true,
                                   rigid_sphere_case::run_projection,
                                   4,
                                   15};

}  // namespace dreampm::validate::cases
