// An inclined plane: a block slips by 1/2 g sin(a) t^2, and by 1/2 g (sin a - mu cos a) t^2 under
// Coulomb friction.
#include "validate/measure/motion.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace slopes_case {
namespace {

constexpr double g = 9.81, time = 0.5;

double exact(double degrees, double mu) {
  const double a = degrees * std::numbers::pi / 180;
  return 0.5 * g * (std::sin(a) - mu * std::cos(a)) * time * time;
}

struct Slide {
  double distance = 0;
  Curve course;
};

Slide slid(Trial& t, const std::string& wall, double degrees) {
  ValidationRun<float> run(t, "slope", {"space.walls.floor=" + wall});
  run.begin();
  Slide s;
  int n = 0;
  s.distance = slide(run.world, degrees, time, [&] {
    run.step();
    if (run.world.time < time || n++ % 10) return;  // the first: let go just now
    s.course.x.push_back(run.world.time - time);
    s.course.y.push_back(mean_position(run.world).x);
  });
  for (std::size_t i = s.course.y.size(); i-- > 0;) s.course.y[i] -= s.course.y[0];
  return s;
}

/// Returns the values of `exact` between 0 and its time.
Curve parabola(std::string name, double distance) {
  Curve c{std::move(name), {}, {}, true};
  for (int k = 1; k <= 10; ++k) c.x.push_back(time * k / 10), c.y.push_back(distance * k * k / 100);
  return c;
}

void run(Trial& t) {
  t.note_choice(
      "Each run has a floor of its own, named in its row. Put down for 0.5 s under a damping of 40/s, then let go.");
  Plot plot{"slopes", "A block that slides under leaning gravity", "time  [s]", "distance  [m]", {}};
  const auto distance = [&](std::string name, const std::string& wall, double degrees, double want) {
    Slide s = slid(t, wall, degrees);
    s.course.name = std::move(name);
    // One name for all points: they wear the colors of their lines.
    plot.curves.push_back(parabola(plot.curves.empty() ? "1/2 a t^2, exact" : "", want));
    plot.curves.push_back(std::move(s.course));
    return s.distance;
  };
  const auto error = [&](const std::string& name, const std::string& wall, double degrees, double mu) {
    const double want = exact(degrees, mu);
    return std::abs(distance(name, wall, degrees, want) / want - 1);
  };
  t.at_most("slip floor, 20 degrees: error of the distance",
            error("slip, 20 degrees (under the next)", "{type: slip}", 20, 0), 0.01, "%");
  t.at_most("separate floor, 20 degrees", error("separate, 20 degrees", "{type: separate, friction: 0}", 20, 0), 0.01,
            "%");
  t.at_most("Coulomb 0.1, 30 degrees", error("Coulomb 0.1, 30 degrees", "{type: separate, friction: 0.1}", 30, 0.1),
            0.03, "%");
  t.at_most("Coulomb 0.3, 30 degrees", error("Coulomb 0.3, 30 degrees", "{type: separate, friction: 0.3}", 30, 0.3),
            0.03, "%");
  // tan 20 = 0.364
  t.at_most("Coulomb 0.45, 20 degrees: distance, which is 0",
            std::abs(distance("Coulomb 0.45, 20 degrees (under the next)", "{type: separate, friction: 0.45}", 20, 0)),
            0.001, "m");
  t.at_most("stick, 30 degrees: distance, which is 0", std::abs(distance("stick, 30 degrees", "{type: stick}", 30, 0)),
            0.002, "m");
  t.plot(std::move(plot));
  const auto rubs = [&](const char* friction, double degrees) {
    return slid(t, std::string("{type: separate, friction: ") + friction + "}", degrees).distance;
  };
  const double rough = std::abs(rubs("0.02", 20) / exact(20, 0) - 1);
  t.control("friction 0.02 for none", "slip floor, 20 degrees: error of the distance", rough);
  t.control("friction 0.02 for none", "separate floor, 20 degrees", rough);
  t.control("friction 0.12 for 0.1", "Coulomb 0.1, 30 degrees", std::abs(rubs("0.12", 30) / exact(30, 0.1) - 1));
  t.control("friction 0.25 for 0.3", "Coulomb 0.3, 30 degrees", std::abs(rubs("0.25", 30) / exact(30, 0.3) - 1));
  t.control("friction 0.35 for 0.45", "Coulomb 0.45, 20 degrees: distance, which is 0", rubs("0.35", 20));
  t.control("friction 0.55 for stick", "stick, 30 degrees: distance, which is 0", rubs("0.55", 30));
}

}  // namespace
}  // namespace slopes_case

extern const Case slopes;
const Case slopes{"slopes",           "a block that slides under leaning gravity: slip, Coulomb's law, rest",
                  "mechanics, exact", true,
                  slopes_case::run,   3};

}  // namespace dreampm::validate::cases
