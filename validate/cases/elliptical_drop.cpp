// Monaghan's elliptical drop: a disk of an incompressible liquid under u = (-100 x, 100 y) stays an
// ellipse.
#include <cmath>
#include <numbers>

#include "validate/measure/fit.h"
#include "validate/measure/motion.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace elliptical_drop_case {
namespace {

struct Axes {
  std::vector<double> time, a, b;
};

/// The semi-axes by second moments: <x^2> = a^2/4 in a full ellipse. The disk of particles itself
/// is the measure at the start, so that its stair-stepped edge does not count.
Axes axes(Trial& t, double end, const std::vector<std::string>& overrides = {}) {
  ValidationRun<float> run(t, "elliptical-drop", overrides);
  for (ParticleSeed& n : run.seeds[0])
    set_motion(n, [](const Vec3d& p) { return Vec3d{-100 * p.x, 100 * p.y, 0}; }, 1e-4);
  run.begin();
  Axes r;
  double xx0 = 0;
  const auto sample = [&] {
    double xx = 0, yy = 0;
    for (const Vec3d& p : positions_by_id(run.world)) xx += p.x * p.x, yy += p.y * p.y;
    if (xx0 == 0) xx0 = xx;
    r.time.push_back(run.world.time), r.a.push_back(std::sqrt(xx / xx0)), r.b.push_back(std::sqrt(yy / xx0));
  };
  sample();
  run.until(end, [&](const StepSums& s) {
    if (s.frame_done) sample();
  });
  return r;
}

struct Errors {
  double axis = 0, area = 0;
};

Errors against(const Table& exact, const Axes& ours) {
  Errors e;
  for (std::size_t row = 0; row < exact.size(); ++row) {
    const double time = exact.number(row, "t");
    const double a = interpolate(ours.time, ours.a, time), b = interpolate(ours.time, ours.b, time);
    e.axis = std::max({e.axis, std::abs(a / exact.number(row, "a_x") - 1), std::abs(b / exact.number(row, "b_y") - 1)});
    e.area = std::max(e.area, std::abs(a * b - 1));
  }
  return e;
}

void run(Trial& t) {
  const Table exact = reference_table("elliptical_drop_monaghan1994.csv");
  const double end = exact.numbers("t").back();
  t.note_choice("Semi-axes by second moments, against those of the disk of particles at the start.");
  const Axes ours = axes(t, end);
  const Errors e = against(exact, ours);
  t.at_most("worst error of a semi-axis", e.axis, 0.02, "%");
  t.at_most("worst error of the area", e.area, 0.01, "%");
  // Honey thick enough to brake the stretching: Re = 1.
  t.control("viscosity of Re = 1", "worst error of a semi-axis",
            against(exact, axes(t, end, {"materials.liquid.viscosity=100"})).axis);
  // The flow is as fast as its own sound, 140 m/s: the pressure that keeps it an ellipse squeezes
  // it.
  t.control("a hundredth of the bulk modulus", "worst error of the area",
            against(exact, axes(t, end, {"materials.liquid.bulk_modulus=1.96e4"})).area);
  t.plot({"elliptical-drop",
          "Semi-axes of a drop of radius 1",
          "time  [s]",
          "semi-axis  [m]",
          {{"ours, x", ours.time, ours.a},
           {"ours, y", ours.time, ours.b},
           {"exact, x", exact.numbers("t"), exact.numbers("a_x"), true},
           {"exact, y", exact.numbers("t"), exact.numbers("b_y"), true}}});
}

}  // namespace
}  // namespace elliptical_drop_case

extern const Case elliptical_drop;
const Case elliptical_drop{"elliptical-drop",
                           "the semi-axes and the area of a stretching drop, 20 cells of radius",
                           "Monaghan 1994, J. Comput. Phys. 110:399, incompressible solution",
                           true,
                           elliptical_drop_case::run,
                           6};

}  // namespace dreampm::validate::cases
