// Mass, momenta and energy of a free block that turns, shears and rings for ten thousand steps.
#include "dreampm/validate/measure/drift.h"
#include "dreampm/validate/measure/fit.h"
#include "dreampm/validate/measure/motion.h"
#include "dreampm/validate/run.h"

namespace dreampm::validate::cases {
namespace {

template <class R>
Drift drift(Trial& t, const std::vector<std::string>& overrides = {}) {
  Run<R> run(t, "free-block", overrides);
  const Vec3d middle{0.64, 0.64, 0.64};
  for (Newborn& n : run.newborns[0])
    set_motion(
        n,
        [&](const Vec3d& p) {
          const Vec3d r = p - middle;
          return Vec3d{-2 * r.y + 0.5 * r.z, 2 * r.x, 0.3 * r.y} + Vec3d{0.02, 0.01, -0.015};
        },
        1e-5);
  run.begin();
  const Balance start = balance(run.world, motion_at_birth(run.world, run.newborns));
  return drift_of(run.world, start, 10000, 0.1, [&](Motion<R>* motion) { return run.step(motion); });
}

/// The mean energy of the last third of the run over that of the second, minus one.
double growth(const Drift& d) {
  const std::size_t third = d.ratio.size() / 3;
  double second = 0, last = 0;
  for (std::size_t i = third; i < 2 * third; ++i) second += d.ratio[i], last += d.ratio[i + third];
  return last / second - 1;
}

/// `growth_gate`: rounding in float lets F wander, as the momenta may.
void judge(Trial& t, const std::string& who, const Drift& d, double gate, double growth_gate) {
  t.at_most(who + ": change of mass", d.mass, 0);
  t.at_most(who + ": drift of momentum, of the mass at 0.1 m/s", d.momentum, gate);
  t.at_most(who + ": drift of angular momentum, relative", d.angular, gate);
  t.at_most(who + ": largest energy over the start's, minus 1", d.energy - 1, 1e-3);
  t.at_most(who + ": growth of energy from the second third to the last", growth(d), growth_gate);
}

void run(Trial& t) {
  const Drift exact = drift<double>(t), fast = drift<float>(t);
  judge(t, "reference (double)", exact, 1e-12, 0);
  judge(t, "cpu (float)", fast, 1e-4, 1e-4);
  t.control("damping of 0.001/s", "cpu (float): drift of angular momentum, relative",
            drift<float>(t, {"time.damping=0.001"}).angular);
  t.plot({"conservation",
          "Energy of a free, turning, shearing block",
          "time  [s]",
          "(kinetic + elastic) / start",
          {{"reference (double)", exact.time, exact.ratio},
           {"cpu (float)", fast.time, fast.ratio},
           level("gate", 0, exact.time.back(), 1.001),
           level("the start's", 0, exact.time.back(), 1)}});
}

}  // namespace

extern const Case conservation;
const Case conservation{"conservation",
                        "mass, momentum, angular momentum and energy of a free block, 10,000 steps",
                        "mechanics, exact",
                        true,
                        run,
                        4};

}  // namespace dreampm::validate::cases
