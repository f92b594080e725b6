// A tank of water at rest for a minute: its depth, its pressure and how much it trembles.
#include "dreampm/validate/measure/column.h"
#include "dreampm/validate/tank.h"

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

void run(Trial& t) {
  t.chose("Sound is 10 sqrt(2 g H). Pressed to its hydrostatic state at the start; its last 2 s are judged.");
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

}  // namespace dreampm::validate::cases
