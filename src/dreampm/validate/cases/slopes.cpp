// An inclined plane: a block slips by 1/2 g sin(a) t^2, and by 1/2 g (sin a - mu cos a) t^2 under Coulomb friction.
#include "dreampm/validate/measure/motion.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

constexpr double g = 9.81, time = 0.5;

double exact(double degrees, double mu) {
  const double a = degrees * std::numbers::pi / 180;
  return 0.5 * g * (std::sin(a) - mu * std::cos(a)) * time * time;
}

double distance(Trial& t, const std::string& wall, double degrees) {
  Run<float> run(t, "slope", {"space.walls.floor=" + wall});
  run.begin();
  return slide(run.world, degrees, time, [&] { run.step(); });
}

void run(Trial& t) {
  t.chose(
      "Each run has a floor of its own, named in its row. Put down for 0.5 s under a damping of 40/s, then let go.");
  const auto error = [&](const std::string& wall, double degrees, double mu) {
    return std::abs(distance(t, wall, degrees) / exact(degrees, mu) - 1);
  };
  t.at_most("slip floor, 20 degrees: error of the distance", error("{type: slip}", 20, 0), 0.01, "%");
  t.at_most("separate floor, 20 degrees", error("{type: separate, friction: 0}", 20, 0), 0.01, "%");
  t.at_most("Coulomb 0.1, 30 degrees", error("{type: separate, friction: 0.1}", 30, 0.1), 0.03, "%");
  t.at_most("Coulomb 0.3, 30 degrees", error("{type: separate, friction: 0.3}", 30, 0.3), 0.03, "%");
  // tan 20 = 0.364
  t.at_most("Coulomb 0.45, 20 degrees: distance, which is 0",
            std::abs(distance(t, "{type: separate, friction: 0.45}", 20)), 0.001, "m");
  t.at_most("stick, 30 degrees: distance, which is 0", std::abs(distance(t, "{type: stick}", 30)), 0.002, "m");
  t.control("friction 0.25 for 0.3", "Coulomb 0.3, 30 degrees", error("{type: separate, friction: 0.25}", 30, 0.3));
}

}  // namespace

extern const Case slopes;
const Case slopes{
    "slopes", "a block that slides under leaning gravity: slip, Coulomb's law, rest", "mechanics, exact", true, run, 3};

}  // namespace dreampm::validate::cases
