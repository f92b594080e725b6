// Mass, momenta and energy of a free block that turns, shears and rings for ten thousand steps.
#include "validate/measure/drift.h"
#include "validate/measure/fit.h"
#include "validate/measure/motion.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace conservation_case {
namespace {

/// `damping` [1/s]: below 0 it feeds energy in, for a control.
template <class R>
Drift drift(Trial& t, int steps = 10000, double damping = 0, const std::vector<std::string>& overrides = {}) {
  ValidationRun<R> run(t, "free-block", overrides);
  run.world.settings.damping = damping;
  const Vec3d middle{0.64, 0.64, 0.64};
  for (ParticleSeed& n : run.seeds[0])
    set_motion(
        n,
        [&](const Vec3d& p) {
          const Vec3d r = p - middle;
          return Vec3d{-2 * r.y + 0.5 * r.z, 2 * r.x, 0.3 * r.y} + Vec3d{0.02, 0.01, -0.015};
        },
        1e-5);
  run.begin();
  const Balance start = balance(run.world, initial_velocities(run.world, run.seeds));
  return drift_of(run.world, start, steps, [&](Motion<R>* motion) { return run.step(motion); });
}

/// The mean energy of the last third of the run over that of the second, minus one.
double growth(const Drift& d) {
  const std::size_t third = d.ratio.size() / 3;
  double second = 0, last = 0;
  for (std::size_t i = third; i < 2 * third; ++i) second += d.ratio[i], last += d.ratio[i + third];
  return last / second - 1;
}

/// `growth_gate`: rounding in float lets F wander, as the momenta may.
template <class R>
Drift judge(Trial& t, const std::string& who, double gate, double growth_gate) {
  const std::string mass = who + ": change of mass", momentum = who + ": drift of momentum, relative",
                    angular = who + ": drift of angular momentum, relative",
                    energy = who + ": largest energy over the start's, minus 1",
                    grows = who + ": growth of energy from the second third to the last";
  const Drift d = drift<R>(t);
  t.at_most(mass, d.mass, 0);
  t.at_most(momentum, d.momentum, gate);
  t.at_most(angular, d.angular, gate);
  t.at_most(energy, d.energy - 1, 1e-3);
  t.at_most(grows, growth(d), growth_gate);
  const char *const braked = "damping of 0.001/s, 1000 steps", *const fed = "damping of -0.05/s, 1000 steps";
  const Drift slower = drift<R>(t, 1000, 0.001), faster = drift<R>(t, 1000, -0.05);
  t.control("a fall of 2.5 m out of the open space, 1000 steps", mass, drift<R>(t, 1000, 0, {"gravity=[20,0,0]"}).mass);
  t.control(braked, momentum, slower.momentum);
  t.control(braked, angular, slower.angular);
  t.control(fed, energy, faster.energy - 1);
  t.control(fed, grows, growth(faster));
  return d;
}

void run(Trial& t) {
  const Drift exact = judge<double>(t, "reference (double)", 1e-12, 0),
              fast = judge<float>(t, t.options().in_float(), 1e-4, 1e-4);
  t.plot({"conservation",
          "Energy of a free, turning, shearing block",
          "time  [s]",
          "(kinetic + elastic) / start",
          {{"reference (double)", exact.time, exact.ratio},
           {t.options().in_float(), fast.time, fast.ratio},
           level("gate", 0, exact.time.back(), 1.001),
           level("the start's", 0, exact.time.back(), 1)}});
}

}  // namespace
}  // namespace conservation_case

extern const Case conservation;
const Case conservation{
    "conservation",         "mass, momentum, angular momentum and energy of a free block, 10,000 steps",
    "mechanics, exact",     true,
    conservation_case::run, 4};

}  // namespace dreampm::validate::cases
