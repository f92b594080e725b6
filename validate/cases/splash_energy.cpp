// A cube of water falls into a pool: what energy the splash keeps by the projection, beside
// explicit steps.
#include <algorithm>
#include <cmath>

#include "validate/measure/particles.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace splash_energy_case {
namespace {

constexpr double g = 9.81, side = 0.48, end = 0.8;

struct Splash {
  std::vector<double> time, energy;  ///< s; over that at rest, of that at the start
};

Splash splash(Trial& t, std::vector<std::string> overrides) {
  ValidationRun<float> run(t, "cube-in-pool", overrides);
  run.begin();
  const auto& water = run.world.sets[0];
  const double volume = static_cast<double>(water.size()) * static_cast<double>(water.rest_volume),
               at_rest = volume / (side * side) / 2, start = g * (mean_position(run.world).y - at_rest);
  Splash s{{0}, {1}};
  Motion<float> motion;
  while (run.world.time < end) {
    if (!run.step(&motion).frame_done) continue;
    const Balance b = balance(run.world, motion);
    s.time.push_back(run.world.time);
    s.energy.push_back((b.kinetic / b.mass + g * (mean_position(run.world).y - at_rest)) / start);
  }
  return s;
}

/// The most that `s` has less than `other`, of the energy at the start.
double lost(const Splash& s, const Splash& other) {
  double most = 0;
  for (std::size_t i = 0; i < std::min(s.energy.size(), other.energy.size()); ++i)
    most = std::max(most, other.energy[i] - s.energy[i]);
  return most;
}

void run(Trial& t) {
  t.note_choice(
      "A cube of 16 cm falls by 10 cm into a pool of 48 x 48 x 12 cm. Energy is that of motion and height over water "
      "at rest. The gate is a tenth of the energy at the start, at the worst frame (50 a second) of 0.8 s. Speeds of "
      "the projection lag half a step, which "
      "counts while the cube falls. By the projection particles are jittered.");
  const std::vector<std::string> fine{"space.spacing=0.0075"};
  const auto by = [&](std::vector<std::string> all) {
    if (t.full()) all.insert(all.end(), fine.begin(), fine.end());
    return splash(t, std::move(all));
  };
  const auto projected = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = by_projection("pool", more);
    all.push_back("bodies.cube.sample={pattern: jitter}");
    return by(all);
  };
  const Splash explicit_steps = by({}), two = projected({}), one = projected({"time.cfl=1"}),
               damped = projected({"time.damping=2"});
  Plot plot{"splash-energy-projection",
            "Energy of a cube of water that falls into a pool",
            "time  [s]",
            "energy over that at rest / at the start",
            {}};
  const auto name = [](const char* who) { return fmt::format("{}: energy less than by explicit steps", who); };
  t.at_most(name("cfl 2"), lost(two, explicit_steps), 0.1, "%");
  t.at_most(name("cfl 1"), lost(one, explicit_steps), 0.1, "%");
  t.report("at the end, by explicit steps", explicit_steps.energy.back(), "%");
  t.report("at the end, cfl 2", two.energy.back(), "%");
  t.report("at the end, cfl 1", one.energy.back(), "%");
  for (const char* who : {"cfl 2", "cfl 1"}) t.control("damped by 2/s, cfl 2", name(who), lost(damped, explicit_steps));
  plot.curves.push_back({"cfl 2", two.time, two.energy}), plot.curves.push_back({"cfl 1", one.time, one.energy});
  plot.curves.push_back({"explicit steps", explicit_steps.time, explicit_steps.energy, true});
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace splash_energy_case

extern const Case splash_energy_projection;
const Case splash_energy_projection{"splash-energy-projection",
                                    "the energy of a cube of water that falls into a pool, by the projection",
                                    "the explicit solver in the same cells",
                                    true,
                                    splash_energy_case::run,
                                    3,
                                    10};

}  // namespace dreampm::validate::cases
