// A tank of water at rest for a minute: its depth, its pressure and how much it trembles.
#include <numbers>

#include "dreampm/state/cell_pressure.h"
#include "validate/measure/column.h"
#include "validate/tank.h"

namespace dreampm::validate::cases {
namespace still_tank_case {
namespace {

struct Still {
  double depth = 0, agitation = 0;
  RowErrors rows;
};

Still stand(Trial& t, double time, const std::vector<std::string>& overrides = {}) {
  Tank tank(t, {32, 32, 4}, 25, overrides);
  tank.begin();
  Still s;
  tank.run.until(time - 2);
  double energy = 0, depth = 0;
  int n = 0;
  Motion<float> motion;
  s.rows = column_errors(tank.run.world, tank.rest, tank.height, 0, 2, [&] {
    const StepSums r = tank.run.step(&motion);
    if (!r.frame_done) return r;
    const Balance b = balance(tank.run.world, motion);
    energy += 2 * b.kinetic / b.mass, depth += tank.depth(), ++n;
    return r;
  });
  s.depth = depth / n;
  s.agitation = std::sqrt(energy / n) / std::sqrt(Tank::g * tank.height);
  return s;
}

// By the projection.

constexpr double mm = 1e-3;

struct Calm {
  double depth = 0, speed = 0, worst_row = 0, buoyancy = 0;  ///< the rms speed in m/s; others as shares
  std::vector<double> rows;                                  ///< errors of pressure over rho g H
};

/// Overrides of a tank with a ball that cuts cells, `radius` cells wide, and water around it.
std::vector<std::string> with_ball(const Vec3d& cells, double depth, double radius, double dx,
                                   std::vector<std::string> all = {}) {
  const Vec3d at = Vec3d{0.51 * cells.x + 0.13, 0.47 * depth + 0.37, 0.49 * cells.z + 0.21} * dx;
  const std::string ball =
      fmt::format("{{sphere: {{radius: {}}}, center: [{}, {}, {}]}}", radius * dx, at.x, at.y, at.z);
  all.push_back("colliders.ball={shape: " + ball + "}");
  all.push_back(fmt::format("bodies.water.shape={{difference: [{{box: {{min: [0, 0, 0], max: [{}, {}, {}]}}}}, {}]}}",
                            cells.x * dx, depth * dx, cells.z * dx, ball));
  return all;
}

/// The last 2 s of `time` [s].
Calm calm(Trial& t, const Vec3i& cells, int depth, double time, double ball,
          const std::vector<std::string>& more = {}) {
  constexpr double dx = 0.02;
  std::vector<std::string> overrides = by_projection("water", more);
  if (ball > 0) overrides = with_ball(static_cast<Vec3d>(cells), depth, ball, dx, overrides);
  Tank tank(t, cells, depth, overrides, dx, Tank::Motion::small, ball > 0 ? Tank::Filling::given : Tank::Filling::slab);
  tank.begin();
  tank.run.until(time - 2);
  const World<float>& w = tank.run.world;
  const double height = depth * dx, base = 1000 * Tank::g * height, begun = w.time;
  Calm c;
  c.rows.assign(static_cast<std::size_t>(depth), 0);
  double squares = 0, deep = 0, up = 0;
  int steps = 0, n = 0;
  tank.run.until(time, [&](const StepSums& step) {
    if (ball > 0) up -= step.grid.colliders.at(0).impulse.y;
    if (++steps % 10) return;
    const CellPressure<float> pressure(w);
    for (int row = 0; row < depth; ++row) {
      double all = 0;
      for (int i = 0; i < cells.x; ++i)
        for (int k = 0; k < cells.z; ++k) all += pressure.of_cell(w.low + Vec3i{i, row, k});
      c.rows[static_cast<std::size_t>(row)] += all / (cells.x * cells.z) - 1000 * Tank::g * (height - (row + 0.5) * dx);
    }
    squares += 2 * step.grid.kinetic / step.grid.mass, deep += tank.depth(), ++n;
  });
  for (double& row : c.rows) row /= n * base, c.worst_row = std::max(c.worst_row, std::abs(row));
  c.speed = std::sqrt(squares / n), c.depth = deep / n;
  const double r = ball * dx, volume = 4.0 / 3 * std::numbers::pi * r * r * r;
  if (ball > 0) c.buoyancy = up / (w.time - begun) / (1000 * Tank::g * volume) - 1;
  return c;
}

void run_projection(Trial& t) {
  t.note_choice("Pressure is that of the cells. The last 2 s of 20 are judged.");
  t.note_choice(
      "The ball is 10.6 cells across, off the nodes, and is watched for 5 s; its buoyancy is what the pressure gives "
      "to "
      "the parts of faces that it closes.");
  const char *const speed = "rms speed", *const depth = "depth after 20 s, change",
                    *const rows = "worst row of pressure, of rho g H", *const around = "around a ball: rms speed",
                    *const lift = "around a ball: its buoyancy, off by";
  constexpr Vec3i tank{32, 32, 4}, cube{20, 22, 20};
  constexpr int deep = 16;
  constexpr double radius = 5.3;
  const Calm still = calm(t, tank, 25, 20, 0);
  t.at_most(speed, still.speed, mm, "m/s");
  t.at_most(depth, std::abs(still.depth), 2e-4, "%");
  t.at_most(rows, still.worst_row, 0.005, "%");
  const Calm ball = calm(t, cube, deep, 5, radius);
  t.at_most(around, ball.speed, 2 * mm, "m/s");
  t.at_most(lift, std::abs(ball.buoyancy), 0.02, "%");
  const std::vector<std::string> light{"gravity=[0,-9.2,0]"}, tilted{"gravity=[1.703,-9.661,0]"};
  const Calm sloshes = calm(t, tank, 25, 5, 0, tilted);
  t.control("gravity tilted by 10 degrees, 5 s", speed, sloshes.speed);
  t.control("gravity tilted by 10 degrees, 5 s", depth, std::abs(sloshes.depth));
  t.control("gravity 9.2 for 9.81, 3 s", rows, calm(t, tank, 25, 3, 0, light).worst_row);
  t.control("gravity 9.2 for 9.81, 3 s", lift, std::abs(calm(t, cube, deep, 3, radius, light).buoyancy));
  t.control("gravity tilted by 10 degrees, 3 s", around, calm(t, cube, deep, 3, radius, tilted).speed);
  Curve errors{"row of cells", {}, {}};
  for (std::size_t r = 0; r < still.rows.size(); ++r)
    errors.x.push_back(static_cast<double>(r) + 0.5), errors.y.push_back(100 * still.rows[r]);
  const double top = static_cast<double>(still.rows.size());
  t.plot({"still-tank-projection",
          "Pressure of rows of cells, by the projection",
          "height over the floor  [cells]",
          "error / (rho g H)  [%]",
          {std::move(errors), level("gate", 0, top, 0.5), level("gate, below", 0, top, -0.5)}});
}

void run(Trial& t) {
  t.note_choice("Sound is 10 sqrt(2 g H). Pressed to its hydrostatic state at the start; its last 2 s are judged.");
  const Still s = stand(t, 60);
  const char* const depth = "depth after 60 s, change";
  t.at_most(depth, std::abs(s.depth), 0.003, "%");
  const char* const rows_above = "worst row mean of pressure above the base row, of rho g H";
  t.at_most(rows_above, s.rows.worst_above_the_base(), 0.04, "%");
  t.at_most("the base row", std::abs(s.rows.base()), 0.04, "%");
  t.at_most("agitation v_rms, of sqrt(g H)", s.agitation, 0.02, "%");
  Curve rows{"mean of a row of cells", {}, {}};
  for (std::size_t r = 0; r < s.rows.error.size(); ++r)
    rows.x.push_back(static_cast<double>(r) + 0.5), rows.y.push_back(100 * s.rows.error[r]);
  const double top = static_cast<double>(s.rows.error.size());
  t.plot({"still-tank",
          "Pressure of rows of cells after a minute at rest",
          "height over the floor  [cells]",
          "error / (rho g H)  [%]",
          {std::move(rows), level("gate", 0, top, 4), level("exact", 0, top, 0), level("gate, below", 0, top, -4)}});
  const Still light = stand(t, 10, {"gravity=[0,-9.2,0]"});
  t.control("gravity 9.2 for 9.81, 10 s", rows_above, light.rows.worst_above_the_base());
  t.control("gravity 9.2 for 9.81, 10 s", "the base row", std::abs(light.rows.base()));
  // A surface at rest that leans by a has its center higher by the part (L tan a)^2/(12 H^2): 0.4
  // %.
  const Still tilted = stand(t, 10, {"gravity=[1.703,-9.661,0]"});
  t.control("gravity tilted by 10 degrees, 10 s", "agitation v_rms, of sqrt(g H)", tilted.agitation);
  t.control("gravity tilted by 10 degrees, 10 s", depth, std::abs(tilted.depth));
}

}  // namespace
}  // namespace still_tank_case

extern const Case still_tank;
const Case still_tank{"still-tank",
                      "water at rest for a minute: depth, pressure and agitation",
                      "hydrostatics, exact; the project's own experiments for the agitation",
                      false,
                      still_tank_case::run,
                      340,
                      340};

extern const Case still_tank_projection;
const Case still_tank_projection{"still-tank-projection",
                                 "water at rest by the projection, in a tank and around a ball: speed, depth, pressure",
                                 "hydrostatics, exact",
                                 true,
                                 still_tank_case::run_projection,
                                 8};

}  // namespace dreampm::validate::cases
